// The list of scenes of `volgi report`, data/scenes.json, and its table of techniques.
#include "apps/report/report_scene.h"
#include "apps/report/sweep.h"
#include "tests/fuzz/input.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace volgi;
  static const fuzz::Folder folder;
  const std::filesystem::path file = folder.write("scenes.json", fuzz::text_of(data, size));
  fuzz::read_or_refuse([&] { app::open_report_scene("cornell", folder.path(), {8, 8}); });
  fuzz::read_or_refuse([&] { app::parse_sweep(fuzz::text_of(data, size), "sweep.json"); });
  return 0;
}
