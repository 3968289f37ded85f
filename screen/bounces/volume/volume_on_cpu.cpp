#include <openvdb/openvdb.h>

#include "propagation/radiance_volume_gl.h"
#include "propagation/volume_cpu.h"
#include "screen/bounces/volume/frame_volume.h"
#include "screen/bounces/volume/radiance_gather.h"
#include "screen/bounces/volume/volume_gather.h"
#include "voxel/voxel_grid_gl.h"

namespace volgi::screen {

namespace {

/// The stages that come before pixels, each under a timer.
void run_stages(VolumeCpu& volume, gl::PassTimer& timer) {
  const auto stage = [&](const char* name, void (VolumeCpu::*run)()) {
    auto scope = timer.scope(name);
    (volume.*run)();
  };
  stage("voxel/voxelize_cpu", &VolumeCpu::voxelize);
  stage("propagation/light_in_cpu", &VolumeCpu::light_in);
  stage("propagation/propagate_cpu", &VolumeCpu::propagate);
  stage("propagation/side_irradiance_cpu", &VolumeCpu::irradiate);
}

size_t with_headroom(size_t bytes) { return bytes + bytes / 5; }

/// FrameVolume::follow_scene.
bool follow(const Scene& scene, const VolumeOptions& options, VolumeCpu& volume) {
  if (!same_grid(make_grid(scene, options.grid_cells, options.grid_shift_cells), volume.grid())) return false;
  volume.scene_moved();
  return true;
}

VolumeReport report_of(const VolumeCpu& volume) {
  VolumeReport r;
  r.grid = volume.grid().cells;
  r.sides = volume.voxels().side_count();
  r.coarse_start = volume.has_coarse_part();
  r.bounces = volume.report();
  r.lost = volume.flux().lost;
  for (const auto* flux : {&volume.flux().emitted, &volume.flux().punctual}) {
    for (const glm::vec4& f : *flux) r.injected += glm::vec3(f);
  }
  return r;
}

/// The CPU twin computes, the GPU shows: sides and their irradiance are uploaded, nothing is read back.
class SidesOnCpu : public FrameVolume {
 public:
  SidesOnCpu(const Scene& scene, const VolumeOptions& options, glm::ivec2 size)
      : scene_(scene), options_(options), volume_(scene, options), gather_(size) {}

  void run(const gl::SceneBuffers& /*buffers*/, const ReflectiveShadowMap& /*maps*/, const GBuffer& gbuffer,
           const Camera& camera, const FirstBounce* /*first_bounce*/, gl::PassTimer& timer) override {
    run_stages(volume_, timer);
    {
      auto scope = timer.scope("screen/bounces/volume/upload_volume");
      upload(volume_.voxels(), voxels_);
      upload_irradiance(volume_.irradiance().direct, direct_);
      upload_irradiance(volume_.irradiance().indirect, indirect_);
    }
    gather_.run(gbuffer, camera, voxels_, direct_, indirect_, timer);
  }
  bool follow_scene() override { return follow(scene_, options_, volume_); }
  const gl::Texture& direct() const override { return gather_.direct(); }
  const gl::Texture& indirect() const override { return gather_.indirect(); }

  VolumeReport report() const override {
    VolumeReport r = report_of(volume_);
    r.memory_bytes = volume_.bytes() + voxels_.bytes() + direct_.bytes() + indirect_.bytes() + gather_.bytes();
    return r;
  }

 private:
  static void upload_irradiance(const std::vector<glm::vec4>& values, gl::Buffer& buffer) {
    const size_t bytes = values.size() * sizeof(glm::vec4);
    if (buffer.bytes() < bytes || buffer.id() == 0) buffer = gl::Buffer(with_headroom(bytes));
    if (bytes > 0) buffer.upload(values.data(), bytes);
  }

  const Scene& scene_;
  VolumeOptions options_;
  VolumeCpu volume_;
  VoxelGridGl voxels_;
  gl::Buffer direct_, indirect_;
  VolumeGather gather_;
};

constexpr size_t kNormalBytes = sizeof(glm::vec4);  // of a cell, on the GPU

/// A volume of values by cell as a texture of `layers` volumes stacked in z.
void upload_cells(const openvdb::Vec3SGrid& from, const openvdb::FloatGrid* fourth, const Grid& grid, int layer,
                  const gl::Texture& into) {
  std::vector<glm::vec4> texels(cell_count(grid), glm::vec4(0.0f));
  for (auto value = from.cbeginValueOn(); value; ++value) {
    const openvdb::Coord c = value.getCoord();
    const glm::ivec3 cell(c.x(), c.y(), c.z());
    if (!shared::cell_inside(grid, cell)) continue;
    const openvdb::Vec3s v = *value;
    const float w = fourth != nullptr ? fourth->tree().getValue(c) : 0.0f;
    texels[size_t(shared::cell_index(grid, cell))] = {v.x(), v.y(), v.z(), w};
  }
  glTextureSubImage3D(into.id(), 0, 0, 0, layer * grid.cells.z, grid.cells.x, grid.cells.y, grid.cells.z, GL_RGBA,
                      GL_FLOAT, texels.data());
}

/// The papers' schemes: spherical harmonics are uploaded.
class PulseOnCpu : public FrameVolume {
 public:
  PulseOnCpu(const Scene& scene, const VolumeOptions& options, glm::ivec2 size)
      : scene_(scene),
        options_(options),
        volume_(scene, options),
        radiance_(volume_.grid(), options.scheme.sh_order == 2 ? 9 : 4),
        normal_occupancy_(gl::Texture::make_3d(GL_RGBA32F, volume_.grid().cells)),
        gather_(size, options.scheme.sh_order) {}

  void run(const gl::SceneBuffers& /*buffers*/, const ReflectiveShadowMap& /*maps*/, const GBuffer& gbuffer,
           const Camera& /*camera*/, const FirstBounce* /*first_bounce*/, gl::PassTimer& timer) override {
    run_stages(volume_, timer);
    {
      auto scope = timer.scope("screen/bounces/volume/upload_volume");
      const RadianceVolume radiance = volume_.radiance();
      for (size_t k = 0; k < radiance.sh.size(); ++k)
        upload_cells(*radiance.sh[k], nullptr, volume_.grid(), int(k), radiance_.sh);
      upload_cells(*volume_.cells().normal, volume_.cells().occupancy.get(), volume_.grid(), 0, normal_occupancy_);
      upload(volume_.voxels(), voxels_);
    }
    const bool occupied_only = options_.scheme.scheme == Scheme::gaitatzes2010;
    gather_.run(gbuffer, voxels_, radiance_, occupied_only ? &normal_occupancy_ : nullptr, timer);
  }
  bool follow_scene() override { return follow(scene_, options_, volume_); }
  const gl::Texture& direct() const override { return gather_.direct(); }
  const gl::Texture& indirect() const override { return gather_.indirect(); }

  VolumeReport report() const override {
    VolumeReport r = report_of(volume_);
    r.memory_bytes = volume_.bytes() + voxels_.bytes() + radiance_.bytes() + kNormalBytes * cell_count(volume_.grid()) +
                     gather_.bytes();
    return r;
  }

 private:
  const Scene& scene_;
  VolumeOptions options_;
  VolumeCpu volume_;
  RadianceVolumeGl radiance_;
  gl::Texture normal_occupancy_;
  VoxelGridGl voxels_;
  RadianceGather gather_;
};

}  // namespace

size_t volume_bytes_on_cpu(const Scene& scene, const VolumeOptions& options, glm::ivec2 size) {
  const Grid grid = make_grid(scene, options.grid_cells, options.grid_shift_cells);
  const ExpectedSides expected = expected_sides(scene, grid);
  const size_t uploaded = sizeof(Grid) + 8 * cell_count(grid) + sizeof(shared::Side) * expected.sides;
  const size_t bytes = bytes_expected_cpu(scene, grid, options, expected) + uploaded;
  if (carries_sides(options.scheme.scheme))
    return bytes + 2 * with_headroom(sizeof(glm::vec4) * expected.sides) + VolumeGather::bytes_for(size);
  const int coefficients = options.scheme.sh_order == 2 ? 9 : 4;
  return bytes + RadianceVolumeGl::bytes_for(grid, coefficients) + kNormalBytes * cell_count(grid) +
         RadianceGather::bytes_for(size);
}

std::unique_ptr<FrameVolume> make_volume_on_cpu(const Scene& scene, const VolumeOptions& options, glm::ivec2 size) {
  if (options.memory_limit) refuse_above_limit(options, volume_bytes_on_cpu(scene, options, size), "CPU");
  if (carries_sides(options.scheme.scheme)) return std::make_unique<SidesOnCpu>(scene, options, size);
  return std::make_unique<PulseOnCpu>(scene, options, size);
}

}  // namespace volgi::screen
