// KHR_draco_mesh_compression: a mesh in draco's format as the one primitive of a scene.
#include "tests/fuzz/gltf_scene.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace volgi;
  static const fuzz::Folder folder;
  const nlohmann::json root = {
      {"asset", {{"version", "2.0"}}},
      {"scene", 0},
      {"scenes", {{{"nodes", {0}}}}},
      {"nodes", {{{"mesh", 0}}}},
      {"extensionsUsed", {"KHR_draco_mesh_compression"}},
      {"extensionsRequired", {"KHR_draco_mesh_compression"}},
      {"meshes",
       {{{"primitives",
          {{{"attributes", {{"POSITION", 0}, {"NORMAL", 1}, {"TEXCOORD_0", 2}}},
            {"extensions",
             {{"KHR_draco_mesh_compression",
               {{"bufferView", 0}, {"attributes", {{"POSITION", 0}, {"NORMAL", 1}, {"TEXCOORD_0", 2}}}}}}}}}}}}},
      {"accessors",
       {{{"componentType", 5126}, {"count", 3}, {"type", "VEC3"}},
        {{"componentType", 5126}, {"count", 3}, {"type", "VEC3"}},
        {{"componentType", 5126}, {"count", 3}, {"type", "VEC2"}}}},
      {"bufferViews", {{{"buffer", 0}, {"byteLength", size}}}},
      {"buffers", {{{"byteLength", size}}}}};
  fuzz::read_scene(folder.write("scene.glb", fuzz::glb(root, std::string(fuzz::text_of(data, size)))));
  return 0;
}
