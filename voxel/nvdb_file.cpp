#include "voxel/nvdb_file.h"

#include <fmt/format.h>
#include <nanovdb/util/IO.h>
#include <nanovdb/util/OpenToNanoVDB.h>

#include <exception>
#include <fstream>
#include <new>
#include <vector>

#include "core/atomic_file.h"
#include "core/error.h"

namespace volgi {

void write_nvdb(const std::filesystem::path& path, const openvdb::GridCPtrVec& grids) {
  std::vector<nanovdb::GridHandle<nanovdb::HostBuffer>> handles;
  handles.reserve(grids.size());
  for (const openvdb::GridBase::ConstPtr& grid : grids)
    handles.push_back(nanovdb::openToNanoVDB(openvdb::ConstPtrCast<openvdb::GridBase>(grid)));
  write_atomically(path, [&](const std::filesystem::path& temporary) {
    try {
      std::ofstream stream;
      stream.exceptions(std::ios::badbit | std::ios::failbit);  // NanoVDB looks at no error but its own
      stream.open(temporary, std::ios::binary);
      nanovdb::io::writeGrids<nanovdb::HostBuffer, std::vector>(stream, handles);
      stream.close();
    } catch (const std::bad_alloc&) {
      throw;
    } catch (const std::exception& e) {
      throw Error(ExitCode::cannot_write, fmt::format("cannot write {}: {}", path.string(), e.what()));
    }
  });
}

}  // namespace volgi
