#pragma once
#include <openvdb/openvdb.h>

#include <filesystem>

namespace volgi {

/// Writes grids as NanoVDB, which GPUs and small programs read as it lies in the file: names, transforms and values,
/// but no further metadata, atomically. Uncompressed; the same grids give the same bytes.
/// @param grids  of floats or of vectors of three floats.
/// @throws Error(cannot_write) naming the path.
void write_nvdb(const std::filesystem::path& path, const openvdb::GridCPtrVec& grids);

}  // namespace volgi
