// A glTF file, binary or text: core/gltf. What it refers to beside it is not there.
#include "tests/fuzz/gltf_scene.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace volgi;
  static const fuzz::Folder folder;
  fuzz::read_scene(folder.write("scene.glb", fuzz::text_of(data, size)));
  return 0;
}
