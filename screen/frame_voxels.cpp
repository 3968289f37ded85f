#include "screen/frame_voxels.h"

#include "voxel/sliced_voxelization.h"
#include "voxel/voxelize_cpu.h"

namespace volgi::screen {

namespace {

class VoxelsOnGpu : public FrameVoxels {
 public:
  explicit VoxelsOnGpu(const Grid& grid) : voxelization_(grid) {}
  void run(const gl::SceneBuffers& buffers, gl::PassTimer& timer) override { voxelization_.run(buffers, timer); }
  const VoxelGridGl& voxels() const override { return voxelization_.voxels(); }
  size_t bytes() const override { return voxelization_.bytes(); }

 private:
  SlicedVoxelization voxelization_;
};

class VoxelsOnCpu : public FrameVoxels {
 public:
  VoxelsOnCpu(const Scene& scene, const Grid& grid) : scene_(scene), grid_(grid) {}

  void run(const gl::SceneBuffers& /*buffers*/, gl::PassTimer& timer) override {
    VoxelGrid voxels;
    {
      const auto scope = timer.scope("voxel/voxelize_cpu");
      voxels = voxelize_cpu(scene_, grid_);
    }
    const auto scope = timer.scope("screen/upload_voxels");
    upload(voxels, voxels_);
  }
  const VoxelGridGl& voxels() const override { return voxels_; }
  size_t bytes() const override { return voxels_.bytes(); }

 private:
  const Scene& scene_;
  Grid grid_;
  VoxelGridGl voxels_;
};

}  // namespace

std::unique_ptr<FrameVoxels> make_frame_voxels(const Scene& scene, const VolumeOptions& options, bool on_gpu) {
  const Grid grid = make_grid(scene, options.grid_cells, options.grid_shift_cells);
  if (on_gpu) return std::make_unique<VoxelsOnGpu>(grid);
  return std::make_unique<VoxelsOnCpu>(scene, grid);
}

}  // namespace volgi::screen
