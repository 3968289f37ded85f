// Files of lights: those that were moved in volgi-demo, and virtual lights.
#include "core/light_file.h"
#include "core/virtual_light_list.h"
#include "tests/fuzz/input.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace volgi;
  static const fuzz::Folder folder;
  const std::filesystem::path file = folder.write("lights.json", fuzz::text_of(data, size));
  fuzz::read_or_refuse([&] {
    const LightFile light = read_light_file(file, glm::dvec3(1.0, 2.0, 3.0));
    Scene scene;
    scene.materials.resize(4);
    apply_light_file(light, file, scene);
  });
  fuzz::read_or_refuse([&] { read_virtual_lights(file); });
  return 0;
}
