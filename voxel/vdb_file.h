#pragma once
#include <openvdb/openvdb.h>

#include <filesystem>
#include <string>

namespace volgi {

/// An OpenVDB file in memory.
struct VdbFile {
  openvdb::GridPtrVec grids;
  openvdb::MetaMap metadata;  // of the file
};

/// What a grid says of itself in a file.
struct GridLabel {
  std::string name;
  std::string unit;  // SI, such as "W m^-2"; "1" for plain numbers
  std::string description;
  openvdb::GridClass grid_class = openvdb::GRID_UNKNOWN;
  openvdb::VecType vector_type = openvdb::VEC_INVARIANT;  // colours stay as they are when the grid is turned
};

/// Metadata keys of volgi's own; the others are OpenVDB's.
inline constexpr const char* kUnitKey = "unit";
inline constexpr const char* kDescriptionKey = "description";

/// Sets the name and the metadata, and that values are stored as floats, not halves.
void label_grid(openvdb::GridBase& grid, const GridLabel& label);

/// Writes grids, with the transforms and metadata that they have, atomically. The same grids give the same bytes: the
/// UUID that OpenVDB draws at random is replaced by a hash of what follows it.
/// Zip and active-mask compression: Blender, Houdini and every build of OpenVDB read it, its blocks carry a checksum,
/// and its decoder stays within its buffers on damaged data (Blosc's does not); Blosc is faster.
/// @throws Error(cannot_write) naming the path, also when the disk is full.
void write_vdb(const std::filesystem::path& path, const openvdb::GridCPtrVec& grids,
               const openvdb::MetaMap& file_metadata);

/// Reads all grids into memory.
/// @throws Error(bad_input) naming the path when it is missing, no OpenVDB file, cut short or damaged;
///   Error(over_limit) when memory runs out.
VdbFile read_vdb(const std::filesystem::path& path);

}  // namespace volgi
