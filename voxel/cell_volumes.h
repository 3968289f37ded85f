#pragma once
#include "voxel/grid.h"
#include "voxel/openvdb_fwd.h"

namespace volgi {

/// What cells hold of the surfaces in them, for looking at, for export and for the papers' schemes. Index space is cell
/// coordinates; the transform puts index (i,j,k) at the cell's centre, in metres, in the file's world frame. Only cells
/// with a surface are active.
struct CellVolumes {
  vdb::FloatGridPtr occupancy;  // largest share of light that a surface in the cell stops (MAX), 0 ... 1
  vdb::Vec3SGridPtr albedo;     // mean over the surface in the cell
  vdb::Vec3SGridPtr normal;     // mean of the fronts, unit; zero where they cancel
  vdb::Vec3SGridPtr emission;   // largest radiosity pi * L_e in the cell (MAX) [W m^-2]
};

/// Four grids without active cells.
CellVolumes empty_cell_volumes(const Grid& grid, glm::dvec3 world_origin);

/// Transform of every grid that volgi makes: index (i,j,k) is the centre of cell (i,j,k).
vdb::TransformPtr world_from_index(const Grid& grid, glm::dvec3 world_origin);

}  // namespace volgi
