#include "screen/base/frame_voxels.h"

#include <optional>

#include "voxel/sliced_voxelization.h"
#include "voxel/voxelize_cpu.h"

namespace volgi::screen {

namespace {

Grid grid_of(const Scene& scene, const VolumeOptions& options) {
  return make_grid(scene, options.grid_cells, options.grid_shift_cells, options.grid_box);
}

class VoxelsOnGpu : public FrameVoxels {
 public:
  VoxelsOnGpu(const Scene& scene, const VolumeOptions& options)
      : scene_(scene), options_(options), voxelization_(std::in_place, grid_of(scene, options), options.voxelization) {}

  void run(const gl::SceneBuffers& buffers, gl::PassTimer& timer) override { voxelization_->run(buffers, timer); }
  void follow_scene() override {
    const Grid grid = grid_of(scene_, options_);
    if (same_grid(grid, voxels().grid)) {
      voxelization_->count_again();
    } else {
      voxelization_.emplace(grid, options_.voxelization);
    }
  }
  const VoxelGridGl& voxels() const override { return voxelization_->voxels(); }
  size_t bytes() const override { return voxelization_->bytes(); }

 private:
  const Scene& scene_;
  VolumeOptions options_;
  std::optional<SlicedVoxelization> voxelization_;
};

class VoxelsOnCpu : public FrameVoxels {
 public:
  VoxelsOnCpu(const Scene& scene, const VolumeOptions& options)
      : scene_(scene), options_(options), grid_(grid_of(scene, options)) {}

  void run(const gl::SceneBuffers& /*buffers*/, gl::PassTimer& timer) override {
    VoxelGrid voxels;
    {
      const auto scope = timer.scope("voxel/voxelize_cpu");
      voxels = voxelize_cpu(scene_, grid_);
    }
    const auto scope = timer.scope("screen/base/upload_voxels");
    upload(voxels, voxels_);
  }
  void follow_scene() override { grid_ = grid_of(scene_, options_); }
  const VoxelGridGl& voxels() const override { return voxels_; }
  size_t bytes() const override { return voxels_.bytes(); }

 private:
  const Scene& scene_;
  VolumeOptions options_;
  Grid grid_;
  VoxelGridGl voxels_;
};

}  // namespace

std::unique_ptr<FrameVoxels> make_frame_voxels(const Scene& scene, const VolumeOptions& options, bool on_gpu) {
  if (on_gpu) {
    refuse_on_gpu(options);
    return std::make_unique<VoxelsOnGpu>(scene, options);
  }
  return std::make_unique<VoxelsOnCpu>(scene, options);
}

}  // namespace volgi::screen
