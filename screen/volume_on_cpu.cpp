#include "propagation/volume_cpu.h"
#include "screen/frame_volume.h"
#include "screen/volume_gather.h"
#include "voxel/voxel_grid_gl.h"

namespace volgi::screen {

namespace {

/// The CPU twin computes, the GPU shows: sides and their irradiance are uploaded, nothing is read back.
class SidesOnCpu : public FrameVolume {
 public:
  SidesOnCpu(const Scene& scene, const VolumeOptions& options, glm::ivec2 size)
      : volume_(scene, options), gather_(size) {}

  void run(const gl::SceneBuffers& /*buffers*/, const ReflectiveShadowMap& /*maps*/, const GBuffer& gbuffer,
           const Camera& camera, gl::PassTimer& timer) override {
    {
      auto scope = timer.scope("voxel/voxelize_cpu");
      volume_.voxelize();
    }
    {
      auto scope = timer.scope("propagation/light_in_cpu");
      volume_.light_in();
    }
    {
      auto scope = timer.scope("propagation/propagate_cpu");
      volume_.propagate();
    }
    {
      auto scope = timer.scope("propagation/side_irradiance_cpu");
      volume_.irradiate();
    }
    {
      auto scope = timer.scope("screen/upload_volume");
      upload(volume_.voxels(), voxels_);
      upload_irradiance(volume_.irradiance().direct, direct_);
      upload_irradiance(volume_.irradiance().indirect, indirect_);
    }
    gather_.run(gbuffer, camera, voxels_, direct_, indirect_, timer);
  }
  const gl::Texture& direct() const override { return gather_.direct(); }
  const gl::Texture& indirect() const override { return gather_.indirect(); }

  VolumeReport report() const override {
    VolumeReport r;
    r.grid = volume_.grid().cells;
    r.sides = volume_.voxels().side_count();
    r.bounces = volume_.report();
    r.lost = volume_.flux().lost;
    for (const auto* flux : {&volume_.flux().emitted, &volume_.flux().punctual}) {
      for (const glm::vec4& f : *flux) r.injected += glm::vec3(f);
    }
    r.memory_bytes = volume_.bytes() + voxels_.bytes() + direct_.bytes() + indirect_.bytes() + gather_.bytes();
    return r;
  }

 private:
  static void upload_irradiance(const std::vector<glm::vec4>& values, gl::Buffer& buffer) {
    const size_t bytes = values.size() * sizeof(glm::vec4);
    if (buffer.bytes() < bytes || buffer.id() == 0) buffer = gl::Buffer(bytes + bytes / 5);
    if (bytes > 0) buffer.upload(values.data(), bytes);
  }

  VolumeCpu volume_;
  VoxelGridGl voxels_;
  gl::Buffer direct_, indirect_;
  VolumeGather gather_;
};

}  // namespace

std::unique_ptr<FrameVolume> make_volume_on_cpu(const Scene& scene, const VolumeOptions& options, glm::ivec2 size) {
  return std::make_unique<SidesOnCpu>(scene, options, size);
}

}  // namespace volgi::screen
