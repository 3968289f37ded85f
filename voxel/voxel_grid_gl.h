#pragma once
#include <cstdint>

#include "core/gl/objects.h"
#include "shaders/shared/side.shared.h"
#include "voxel/grid.h"

namespace volgi {

/// Blocked faces and sides of a grid on the GPU. Sides are a compact list, those of one cell beside each other in the
/// order of faces; a cell finds its own through `cell_sides` (side.shared.h). Memory: 8 bytes a cell; 64 bytes a side.
struct VoxelGridGl {
  Grid grid{};
  gl::Buffer grid_block;  // uniform block 0: Grid
  gl::Buffer cell_sides;  // uvec2 per cell
  gl::Buffer sides;       // shared::Side; capacity of at least side_count()
  gl::Buffer side_count;  // one uint, for shaders
  std::uint32_t side_capacity = 0;

  size_t bytes() const { return grid_block.bytes() + cell_sides.bytes() + sides.bytes() + side_count.bytes(); }
  /// Binds what every volume shader reads: uniform block 0; storage 3 cell_sides, 4 sides, 5 side_count.
  void bind() const;
  /// Sides on the CPU, for tests, statistics and export. Waits for the GPU.
  std::vector<shared::Side> download_sides() const;
};

}  // namespace volgi
