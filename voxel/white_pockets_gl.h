#pragma once
#include "core/gl/pass_timer.h"
#include "core/gl/program.h"
#include "voxel/cell_spread_gl.h"
#include "voxel/voxel_grid_gl.h"

namespace volgi {

/// Pass "voxel/white_pockets", bound_white_pockets() on the GPU: columns of cells tell on, along each axis in turn,
/// where light leaves. Ways with more than ROUNDS times three turns are taken for closed. Memory: 4 bytes a cell.
class WhitePocketsGl {
 public:
  static constexpr const char* name = "voxel/white_pockets";
  static constexpr int ROUNDS = 16;
  WhitePocketsGl();
  void run(const VoxelGridGl& voxels, gl::PassTimer& timer);
  /// Cells in such places in the last run. Waits for the GPU; after a frame, not in one.
  size_t cells() const;
  size_t bytes() const { return leaving_.bytes(); }
  static size_t bytes_for(const Grid& grid) { return sizeof(GLuint) * cell_count(grid); }

 private:
  gl::Program seed_, bound_;
  CellSpreadGl spread_;
  gl::Buffer leaving_;  // uint a cell: bits of bands in which light leaves it
  Grid grid_{};
};

}  // namespace volgi
