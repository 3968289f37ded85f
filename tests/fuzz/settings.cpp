// Files of volgi-demo: settings, and a camera's path.
#include "apps/demo/settings.h"
#include "apps/demo/camera_path.h"
#include "tests/fuzz/input.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace volgi;
  static const fuzz::Folder folder;
  const std::filesystem::path file = folder.write("settings.json", fuzz::text_of(data, size));
  fuzz::read_or_refuse([&] {
    const demo::ReadSettings read = demo::read_settings(file);
    demo::write_settings(folder.path() / "written.json", read.settings);
    demo::read_settings(folder.path() / "written.json");
  });
  fuzz::read_or_refuse([&] { demo::read_camera_path(file); });
  return 0;
}
