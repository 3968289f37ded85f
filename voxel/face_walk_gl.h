#pragma once
#include "core/gl/objects.h"
#include "voxel/voxel_grid_gl.h"

namespace volgi {

/// What shaders with voxel/face_walk.glsl read beside the sides: the cells' own sides as texels, which software
/// rasterizers read faster than storage. Bound next to VoxelGridGl::bind().
class FaceWalkCells {
 public:
  /// Makes a view of the grid's buffer the first time, and when it is another.
  void bind(const VoxelGridGl& voxels);
  /// The grid may be another one in the same place: before it is let go of.
  void forget() { view_ = {}; }

 private:
  gl::Texture view_;
  GLuint viewed_ = 0;
  size_t bytes_ = 0;
};

}  // namespace volgi
