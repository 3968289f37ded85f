#pragma once
#include "core/mipmaps.h"
#include "core/scene.h"
#include "voxel/cell_volumes.h"
#include "voxel/side_halo.h"
#include "voxel/voxel_grid.h"

namespace volgi {

/// 3-way sliced voxelization on the CPU, twin of SlicedVoxelization: same surface (slice_vertex), same exact decisions,
/// own code (docs/theory.md#voxelization). Triangles are binned by leaf block and the blocks voxelized in parallel; the
/// result does not depend on the number of threads. Cost: one visit of each fragment on the lattice three times finer
/// than the cells.
/// @param mipmaps  voxelization_mipmaps of the scene; without, they are made each time.
VoxelGrid voxelize_cpu(const Scene& scene, const Grid& grid, const Mipmaps& mipmaps);
VoxelGrid voxelize_cpu(const Scene& scene, const Grid& grid);

/// All ranks: each voxelizes what meets its part and seven cells around it, whose sides it knows but does not own, and
/// has the same sides there as one rank alone, to the last bit. Triangles are read by all and kept by whom they meet.
VoxelGrid voxelize_cpu(const Scene& scene, const Grid& grid, const Mipmaps& mipmaps, const RanksOfVolume& ranks);

/// Occupancy, albedo, normal and emission per cell, from the same fragments. @param part  the blocks wanted.
CellVolumes cell_volumes_cpu(const Scene& scene, const Grid& grid, const Mipmaps& mipmaps, const BlockBox& part);
CellVolumes cell_volumes_cpu(const Scene& scene, const Grid& grid, const Mipmaps& mipmaps);
CellVolumes cell_volumes_cpu(const Scene& scene, const Grid& grid);

/// Levels of all textures that voxelization samples. They depend on the scene's materials and images alone: who
/// voxelizes a scene that moves makes them once. The scene must outlive them.
Mipmaps voxelization_mipmaps(const Scene& scene);

struct Voxelized {
  VoxelGrid voxels;
  CellVolumes cells;
};

/// Both, with the triangles placed and binned once.
Voxelized voxelize_all_cpu(const Scene& scene, const Grid& grid, const Mipmaps& mipmaps);
Voxelized voxelize_all_cpu(const Scene& scene, const Grid& grid);

}  // namespace volgi
