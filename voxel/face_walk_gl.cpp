#include "voxel/face_walk_gl.h"

#include "shaders/voxel/slots.shared.h"

namespace volgi {

void FaceWalkCells::bind(const VoxelGridGl& voxels) {
  const gl::Buffer& cells = voxels.cell_sides;
  if (view_.id() == 0 || viewed_ != cells.id() || bytes_ != cells.bytes()) {
    view_ = gl::Texture::view_of(cells, GL_RG32UI, 2 * sizeof(GLuint));
    viewed_ = cells.id();
    bytes_ = cells.bytes();
  }
  view_.bind(WALK_CELLS_UNIT);
}

}  // namespace volgi
