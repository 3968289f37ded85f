#pragma once
#include "core/gl/program.h"
#include "voxel/voxel_grid_gl.h"

namespace volgi {

/// Spreads bits from cell to cell through faces that do not stop everything: whole columns at once, along each axis in
/// turn. What lies behind more than 3 rounds turns may not be reached. Part of the pass that asks for it.
class CellSpreadGl {
 public:
  CellSpreadGl();
  /// @param marks  uint a cell, read and written; visible to shaders that follow.
  void run(const VoxelGridGl& voxels, const gl::Buffer& marks, int rounds) const;

 private:
  gl::Program program_;
};

}  // namespace volgi
