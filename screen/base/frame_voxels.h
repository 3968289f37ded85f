#pragma once
#include <memory>

#include "core/gl/pass_timer.h"
#include "core/gl/scene_buffers.h"
#include "propagation/volume_options.h"
#include "voxel/voxel_grid_gl.h"

namespace volgi::screen {

/// Blocked faces and sides of the scene for passes on the GPU, wherever they are made.
class FrameVoxels {
 public:
  virtual ~FrameVoxels() = default;
  virtual void run(const gl::SceneBuffers& buffers, gl::PassTimer& timer) = 0;
  /// The scene has changed in place: the next run finds its sides, on another grid where the bounds ask for one.
  virtual void follow_scene() = 0;
  virtual const VoxelGridGl& voxels() const = 0;
  virtual size_t bytes() const = 0;
};

/// @param scene  must outlive it. @throws Error as make_grid, on the GPU as refuse_on_gpu.
std::unique_ptr<FrameVoxels> make_frame_voxels(const Scene& scene, const VolumeOptions& options, bool on_gpu);

}  // namespace volgi::screen
