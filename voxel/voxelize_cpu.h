#pragma once
#include "core/scene.h"
#include "voxel/cell_volumes.h"
#include "voxel/voxel_grid.h"

namespace volgi {

/// 3-way sliced voxelization on the CPU, twin of SlicedVoxelization: same surface (slice_vertex), same exact decisions,
/// own code (docs/theory.md#voxelization). Triangles are binned by leaf block and the blocks voxelized in parallel; the
/// result does not depend on the number of threads. Cost: one visit of each fragment on the lattice three times finer
/// than the cells.
VoxelGrid voxelize_cpu(const Scene& scene, const Grid& grid);

/// Occupancy, albedo, normal and emission per cell, from the same fragments.
CellVolumes cell_volumes_cpu(const Scene& scene, const Grid& grid);

struct Voxelized {
  VoxelGrid voxels;
  CellVolumes cells;
};

/// Both, with the triangles placed and binned once.
Voxelized voxelize_all_cpu(const Scene& scene, const Grid& grid);

}  // namespace volgi
