// EXT_meshopt_compression: the input's first bytes say mode, filter, stride and count, the rest is in meshopt's format.
// Attributes are positions, indices those of a triangle list.
#include <array>

#include "tests/fuzz/gltf_scene.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace volgi;
  static const fuzz::Folder folder;
  constexpr size_t head = 4;
  if (size < head) return 0;
  constexpr std::array modes{"ATTRIBUTES", "TRIANGLES", "INDICES"};
  constexpr std::array filters{"NONE", "OCTAHEDRAL", "QUATERNION", "EXPONENTIAL"};
  const bool attributes = data[0] % modes.size() == 0;
  const size_t stride = data[1], count = data[2] + 256 * (data[3] % 4);
  std::string binary(36 * 256, char());  // positions of 768 vertices, where the input has only indices
  binary += fuzz::text_of(data + head, size - head);
  const nlohmann::json compressed = {{"buffer", 0},
                                     {"byteLength", stride * count},
                                     {"byteStride", stride},
                                     {"extensions",
                                      {{"EXT_meshopt_compression",
                                        {{"buffer", 0},
                                         {"byteOffset", 36 * 256},
                                         {"byteLength", size - head},
                                         {"byteStride", stride},
                                         {"count", count},
                                         {"mode", modes[data[0] % modes.size()]},
                                         {"filter", filters[data[0] / 8 % filters.size()]}}}}}};
  nlohmann::json views = {{{"buffer", 0}, {"byteLength", 36 * 256}}, compressed};
  if (!attributes) views[1].erase("byteStride");
  nlohmann::json accessors = {
      {{"bufferView", attributes ? 1 : 0},
       {"componentType", 5126},
       {"count", attributes ? count : 768},
       {"type", "VEC3"}},
      {{"bufferView", 1}, {"componentType", stride == 2 ? 5123 : 5125}, {"count", count}, {"type", "SCALAR"}}};
  nlohmann::json primitive = {{"attributes", {{"POSITION", 0}}}};
  if (attributes) {
    accessors.erase(1);
  } else {
    primitive["indices"] = 1;
  }
  const nlohmann::json root = {{"asset", {{"version", "2.0"}}},
                               {"scene", 0},
                               {"scenes", {{{"nodes", {0}}}}},
                               {"nodes", {{{"mesh", 0}}}},
                               {"extensionsUsed", {"EXT_meshopt_compression"}},
                               {"extensionsRequired", {"EXT_meshopt_compression"}},
                               {"meshes", {{{"primitives", {primitive}}}}},
                               {"accessors", accessors},
                               {"bufferViews", views},
                               {"buffers", {{{"byteLength", binary.size()}}}}};
  fuzz::read_scene(folder.write("scene.glb", fuzz::glb(root, binary)));
  return 0;
}
