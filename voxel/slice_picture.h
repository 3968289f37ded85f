#pragma once
#include <openvdb/openvdb.h>

#include <vector>

#include "core/image.h"
#include "voxel/vdb_summary.h"

namespace volgi {

/// Cells whose index on `axis` (0, 1, 2: x, y, z) is `index`.
struct SlicePlane {
  int axis = 2;
  int index = 0;
};

/// Slices of a grid beside each other, as display values: the cells of the active box, enlarged without a filter, all
/// at one scale, each with its place [m], and a colour bar with the unit underneath.
/// Numbers: viridis from 0 to the largest, to 1 for shares (unit 1, none above); diverging around 0 where one is
/// negative. Colours: as they are when they are shares, else tone mapped; by luminance, diverging, where one is
/// negative; both with one exposure for the whole grid, so that slices compare.
/// Normals: 0.5 + 0.5 n. Cells without a value are grey, those that are not finite magenta.
/// Orientation: y is up and z = const looks along -z; y = const is seen from above, x to the right; x = const has z to
/// the right.
/// @param summary  of the grid, with channels (a grid that has active cells and a type of NumberGrids).
/// @param planes   inside summary.index_box.
/// @throws Error(over_limit) when the box is too large for a picture.
Image slice_picture(const openvdb::GridBase& grid, const GridSummary& summary, const std::vector<SlicePlane>& planes);

/// Colour maps as display values for t in [0,1] and s in [-1,1].
glm::vec3 viridis(float t);
glm::vec3 diverging(float s);

}  // namespace volgi
