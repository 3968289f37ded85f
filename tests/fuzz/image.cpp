// An encoded picture: as a texture of a scene (PNG, JPEG, WebP), and as a PNG of its own.
#include "core/image.h"
#include "tests/fuzz/gltf_scene.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace volgi;
  static const fuzz::Folder folder;
  const std::string picture(fuzz::text_of(data, size));
  // A triangle whose positions and texture coordinates are zeros, and the picture behind them.
  const std::string binary = std::string(36 + 24, '\0') + picture;
  const nlohmann::json root = {
      {"asset", {{"version", "2.0"}}},
      {"scene", 0},
      {"scenes", {{{"nodes", {0}}}}},
      {"nodes", {{{"mesh", 0}}}},
      {"extensionsUsed", {"EXT_texture_webp"}},
      {"images", {{{"bufferView", 2}, {"mimeType", "image/png"}}}},
      {"textures", {{{"source", 0}}}},
      {"materials", {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}}},
      {"meshes", {{{"primitives", {{{"attributes", {{"POSITION", 0}, {"TEXCOORD_0", 1}}}, {"material", 0}}}}}}},
      {"accessors",
       {{{"bufferView", 0}, {"componentType", 5126}, {"count", 3}, {"type", "VEC3"}},
        {{"bufferView", 1}, {"componentType", 5126}, {"count", 3}, {"type", "VEC2"}}}},
      {"bufferViews",
       {{{"buffer", 0}, {"byteLength", 36}},
        {{"buffer", 0}, {"byteOffset", 36}, {"byteLength", 24}},
        {{"buffer", 0}, {"byteOffset", 60}, {"byteLength", size}}}},
      {"buffers", {{{"byteLength", binary.size()}}}}};
  fuzz::read_scene(folder.write("scene.glb", fuzz::glb(root, binary)));
  const std::filesystem::path png = folder.write("picture.png", picture);
  fuzz::read_or_refuse([&] { read_png(png); });
  return 0;
}
