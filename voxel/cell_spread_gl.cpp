#include "voxel/cell_spread_gl.h"

#include "shaders/shared/group_sizes.shared.h"
#include "shaders/voxel/slots.shared.h"

namespace volgi {

CellSpreadGl::CellSpreadGl() : program_(gl::Program::compute("voxel/cell_spread.comp.glsl")) {}

void CellSpreadGl::run(const VoxelGridGl& voxels, const gl::Buffer& marks, int rounds) const {
  const glm::ivec3 cells = voxels.grid.cells;
  voxels.bind();
  marks.bind_storage(CELL_MARKS_SLOT);
  program_.use();
  for (int round = 0; round < rounds; ++round) {
    for (int axis = 0; axis < 3; ++axis) {
      program_.set("axis", axis);
      gl::dispatch_linear(cell_count(voxels.grid) / size_t(cells[axis]), LINEAR_GROUP);
      glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    }
  }
}

}  // namespace volgi
