#pragma once
#include <memory>

#include "core/gl/pass_timer.h"
#include "core/gl/program.h"
#include "core/gl/readback.h"
#include "core/gl/scene_buffers.h"
#include "voxel/voxel_grid_gl.h"

namespace volgi {

/// 3-way sliced voxelization (Gaitatzes 2010, Algorithm 1), timers "voxel/slice", "voxel/list_sides" and
/// "voxel/side_area".
///
/// The scene is scan-converted once along each axis, one pixel for every column of cells. A fragment with depth x
/// blocks the face whose two cell centres x lies between; a continuous surface therefore leaves no gap, however thin or
/// sloped. Each blocked face has two sides, with the albedo, normal and emission of the surface nearest to the cell
/// that sees it. We depart from the paper, which keeps one normal and colour per cell by MAX blending: in a wall
/// thinner than a cell these cancel and leak (docs/theory.md#sides). Alpha: MASK cuts, BLEND covers the share alpha of
/// a face. Results do not depend on the order of fragments. Cost: two raster passes per axis and one pass over the
/// cells. Memory while it runs: 12 bytes a face (about 36 a cell), released by nobody: kept for the next frame.
class SlicedVoxelization {
 public:
  explicit SlicedVoxelization(const Grid& grid);

  /// Voxelizes the scene. Only the first run waits for the number of sides. A later one with a fifth more sides than
  /// there is room for leaves some out of that frame; the next one makes room.
  void run(const gl::SceneBuffers& scene, gl::PassTimer& timer);
  const VoxelGridGl& voxels() const { return voxels_; }
  size_t bytes() const;

 private:
  void slice(const gl::SceneBuffers& scene, bool write_sides);
  void list_sides();
  void count_area(const gl::SceneBuffers& scene);
  void make_room(std::uint32_t side_count);

  gl::Program slice_;
  gl::Program count_;
  gl::Program scan_;
  gl::Program offset_;
  gl::Program side_area_;
  gl::Program collect_area_;
  VoxelGridGl voxels_;
  gl::Buffer key_low_[3], key_high_[3], opacity_[3];
  gl::Buffer group_totals_;
  gl::Buffer area_fixed_;
  gl::Framebuffer columns_[3];
  gl::Framebuffer fine_columns_[3];
  std::unique_ptr<gl::Readback> counted_;  // side counts of earlier frames
  int groups_ = 0;
};

}  // namespace volgi
