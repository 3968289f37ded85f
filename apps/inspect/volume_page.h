#pragma once
#include <filesystem>
#include <string>

#include "voxel/vdb_file.h"

namespace volgi::app {

/// A volume as one HTML file that opens from disk and asks for nothing else: three slices, a histogram and the occupied
/// cells in space, with channel, range, colour map and, where a file has spherical harmonics, radiance by direction.
/// Cells of the active boxes are in the page as 16-bit floats, scaled by a power of two: to 0.05 % of each value, and
/// to nothing 2^-38 below the largest of a grid.
/// @param title  of the page. @param grids  those to show; what has no numbers or no active cells is left out.
/// @throws Error(bad_input) where nothing is left; Error(over_limit) above 96 MiB of values, saying what would be less.
std::string volume_page(const std::string& title, const openvdb::GridPtrVec& grids);

/// A text that was built into the program: page.html, page.css or page.js.
std::string_view inspect_text(std::string_view name);

}  // namespace volgi::app
