// An OpenVDB file, and what volgi inspect tells of it.
#include "tests/fuzz/input.h"
#include "voxel/vdb_file.h"
#include "voxel/vdb_summary.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace volgi;
  static const fuzz::Folder folder;
  const std::filesystem::path file = folder.write("volume.vdb", fuzz::text_of(data, size));
  fuzz::read_or_refuse([&] {
    const VdbFile read = read_vdb(file);
    for (const auto& grid : read.grids) summarise(*grid);
  });
  return 0;
}
