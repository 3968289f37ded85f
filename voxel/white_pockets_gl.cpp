#include "voxel/white_pockets_gl.h"

#include <algorithm>

#include "shaders/shared/group_sizes.shared.h"
#include "shaders/voxel/slots.shared.h"
#include "shaders/voxel/white_pockets.shared.h"

namespace volgi {

WhitePocketsGl::WhitePocketsGl()
    : seed_(gl::Program::compute("voxel/white_pockets_seed.comp.glsl")),
      bound_(gl::Program::compute("voxel/white_pockets_bound.comp.glsl")) {}

void WhitePocketsGl::run(const VoxelGridGl& voxels, gl::PassTimer& timer) {
  const auto scope = timer.scope(name);
  grid_ = voxels.grid;
  gl::reserve(leaving_, bytes_for(grid_));
  voxels.bind();
  leaving_.bind_storage(CELL_MARKS_SLOT);
  seed_.use();
  gl::dispatch_linear(cell_count(grid_), LINEAR_GROUP);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
  spread_.run(voxels, leaving_, ROUNDS);
  bound_.use();
  gl::dispatch_linear(voxels.side_capacity, LINEAR_GROUP);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
}

size_t WhitePocketsGl::cells() const {
  if (leaving_.id() == 0) return 0;
  const auto leaving = leaving_.download<GLuint>(cell_count(grid_));
  return size_t(std::count_if(leaving.begin(), leaving.end(), [](GLuint bands) { return bands != ALL_BANDS; }));
}

}  // namespace volgi
