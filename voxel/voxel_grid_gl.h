#pragma once
#include <cstdint>

#include "core/gl/objects.h"
#include "shaders/shared/side.shared.h"
#include "voxel/voxel_grid.h"

namespace volgi {

/// Blocked faces and sides of a grid on the GPU. Sides are a compact list, those of one cell beside each other in the
/// order of faces; a cell finds its own through `cell_sides` (side.shared.h), never beyond the list. Memory: 8 bytes a
/// cell; 64 bytes a side.
struct VoxelGridGl {
  Grid grid{};
  gl::Buffer grid_block;  // Grid
  gl::Buffer cell_sides;  // uvec2 per cell
  gl::Buffer sides;       // shared::Side; capacity of at least side_count()
  gl::Buffer side_count;  // one uint, for shaders
  std::uint32_t side_capacity = 0;

  size_t bytes() const { return grid_block.bytes() + cell_sides.bytes() + sides.bytes() + side_count.bytes(); }
  /// Binds all four, as every shader of the volume reads them (shaders/voxel/slots.shared.h).
  void bind() const;
  /// Sides on the CPU, for tests, statistics and export. Waits for the GPU.
  std::vector<shared::Side> download_sides() const;
};

/// Blocked faces and sides of the CPU's grid on the GPU, and back; sides keep their order. Downloading waits for the
/// GPU.
VoxelGridGl upload(const VoxelGrid& voxels);
VoxelGrid download(const VoxelGridGl& voxels);

/// The same into an earlier upload: nothing is allocated where the grid is the same and the sides fit. What does not
/// fit gets a fifth more room than it needs, as scenes that move grow again.
void upload(const VoxelGrid& voxels, VoxelGridGl& into);

}  // namespace volgi
