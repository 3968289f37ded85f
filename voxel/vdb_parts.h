#pragma once
#include <filesystem>
#include <span>

#include "voxel/vdb_file.h"

namespace volgi {

/// The file of one rank beside that of all: OUT.3.vdb of OUT.vdb.
std::filesystem::path part_path(const std::filesystem::path& path, int rank);

/// Marks a file as the part of a rank of so many.
void mark_as_part(openvdb::MetaMap& file_metadata, int rank, int ranks);

/// What ranks have written, one file each, as one: the same bytes, written, as a file that one rank alone has made.
/// Leaves go over from part to part; memory is that of the whole. @param parts  in any order.
/// @throws Error(bad_input) naming the file that is no part, of another export, missing or there twice; as read_vdb.
VdbFile merge_parts(std::span<const std::filesystem::path> parts);

}  // namespace volgi
