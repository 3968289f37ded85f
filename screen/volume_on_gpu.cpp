#include <fmt/format.h>

#include "core/error.h"
#include "core/surface.h"
#include "propagation/bounces_gl.h"
#include "propagation/pulse_volume_gl.h"
#include "propagation/side_irradiance_gl.h"
#include "propagation/transport_conservative_gl.h"
#include "propagation/transport_ordinates_gl.h"
#include "propagation/volume_cpu.h"
#include "screen/frame_volume.h"
#include "screen/inject_reflective_shadow_map.h"
#include "screen/radiance_gather.h"
#include "screen/volume_gather.h"
#include "voxel/cell_volumes_gl.h"
#include "voxel/emitter_pieces.h"
#include "voxel/sliced_voxelization.h"

namespace volgi::screen {

namespace {

std::unique_ptr<TransportGl> make_transport_gl(const Grid& grid, const SchemeOptions& options) {
  if (options.scheme == Scheme::conservative) return std::make_unique<ConservativeTransportGl>(grid, options.sh_order);
  return std::make_unique<OrdinatesTransportGl>(grid, options);
}

/// Schemes that carry light from sides to sides.
class SidesOnGpu : public FrameVolume {
 public:
  SidesOnGpu(const Scene& scene, const VolumeOptions& options, glm::ivec2 size)
      : scene_(scene),
        rules_(bounce_rules(options, largest_albedo(scene))),
        voxelization_(make_grid(scene, options.grid_cells, options.grid_shift_cells)),
        bounces_(make_transport_gl(voxelization_.voxels().grid, options.scheme)),
        gather_(size),
        emitters_(emitter_pieces(scene, voxelization_.voxels().grid)) {}

  void run(const gl::SceneBuffers& buffers, const ReflectiveShadowMap& maps, const GBuffer& gbuffer,
           const Camera& camera, gl::PassTimer& timer) override {
    const VoxelGridGl& voxels = voxelization_.voxels();
    voxelization_.run(buffers, timer);
    flux_.begin(voxels);
    flux_.inject_emitters(voxels, emitters_, timer);
    inject_.run(voxels, maps, scene_, flux_, timer);
    bounce_report_ = bounces_.run(voxels, flux_, !emitters_.empty(), rules_, timer);
    irradiance_.run(voxels, flux_, bounces_, timer);
    gather_.run(gbuffer, camera, voxels, irradiance_.direct(), irradiance_.indirect(), timer);
  }
  const gl::Texture& direct() const override { return gather_.direct(); }
  const gl::Texture& indirect() const override { return gather_.indirect(); }

  VolumeReport report() const override {
    VolumeReport r;
    r.on_gpu = true;
    r.grid = voxelization_.voxels().grid.cells;
    r.sides = voxelization_.voxels().side_count.download<std::uint32_t>(1)[0];
    r.bounces = bounce_report_;
    r.lost = flux_.lost();
    for (const gl::Buffer* flux : {&flux_.emitted(), &flux_.punctual()}) {
      for (glm::vec4 f : flux->download<glm::vec4>(r.sides)) r.injected += glm::vec3(f);
    }
    r.memory_bytes = voxelization_.bytes() + flux_.bytes() + bounces_.bytes() + irradiance_.bytes() + gather_.bytes();
    return r;
  }

 private:
  const Scene& scene_;
  BounceRules rules_;
  SlicedVoxelization voxelization_;
  SideFluxGl flux_;
  InjectReflectiveShadowMap inject_;
  BouncesGl bounces_;
  SideIrradianceGl irradiance_;
  VolumeGather gather_;
  std::vector<FluxSample> emitters_;
  BounceReport bounce_report_;
};

/// The papers' schemes: a pulse through cells, read from spherical harmonics.
class PulseOnGpu : public FrameVolume {
 public:
  PulseOnGpu(const Scene& scene, const VolumeOptions& options, glm::ivec2 size)
      : scene_(scene),
        options_(options),
        voxelization_(make_grid(scene, options.grid_cells, options.grid_shift_cells)),
        cells_(voxelization_.voxels().grid),
        pulse_(voxelization_.voxels().grid, options.scheme),
        gather_(size, options.scheme.sh_order),
        emitters_(emitter_pieces(scene, voxelization_.voxels().grid)) {
    bounce_rules(options, 0.0f);  // says what these schemes cannot do
  }

  void run(const gl::SceneBuffers& buffers, const ReflectiveShadowMap& maps, const GBuffer& gbuffer,
           const Camera& /*camera*/, gl::PassTimer& timer) override {
    const VoxelGridGl& voxels = voxelization_.voxels();
    voxelization_.run(buffers, timer);
    cells_.run(buffers, timer);
    flux_.begin(voxels);
    flux_.inject_emitters(voxels, emitters_, timer, false);
    inject_.run(voxels, maps, scene_, flux_, timer);
    bounce_report_ = pulse_.run(voxels, cells_.normal_occupancy(), cells_.albedo(), flux_.punctual(),
                                options_.iterations.value_or(VolumeOptions::kPulseIterations), timer);
    const bool occupied_only = options_.scheme.scheme == Scheme::gaitatzes2010;
    gather_.run(gbuffer, voxels, pulse_.radiance(), occupied_only ? &cells_.normal_occupancy() : nullptr, timer);
  }
  const gl::Texture& direct() const override { return gather_.direct(); }
  const gl::Texture& indirect() const override { return gather_.indirect(); }

  VolumeReport report() const override {
    VolumeReport r;
    r.on_gpu = true;
    r.grid = voxelization_.voxels().grid.cells;
    r.sides = voxelization_.voxels().side_count.download<std::uint32_t>(1)[0];
    r.bounces = bounce_report_;
    r.lost = flux_.lost();
    r.injected = bounce_report_.sent;
    r.memory_bytes = voxelization_.bytes() + cells_.bytes() + flux_.bytes() + pulse_.bytes() + gather_.bytes();
    return r;
  }

 private:
  const Scene& scene_;
  VolumeOptions options_;
  SlicedVoxelization voxelization_;
  CellVolumesGl cells_;
  SideFluxGl flux_;
  InjectReflectiveShadowMap inject_;
  PulseVolumeGl pulse_;
  RadianceGather gather_;
  std::vector<FluxSample> emitters_;
  BounceReport bounce_report_;
};

/// @throws Error(over_limit) naming both figures. What sides take is estimated from the scene's area.
void refuse_above_limit(const Scene& scene, const VolumeOptions& options) {
  if (!options.memory_limit) return;
  const Grid grid = make_grid(scene, options.grid_cells, options.grid_shift_cells);
  const size_t expected = voxelization_bytes(grid, scene) + bytes_expected_cpu(scene, grid, options.scheme);
  if (expected <= *options.memory_limit) return;
  throw Error(
      ExitCode::over_limit,
      fmt::format("--grid {}: the volume needs about {:.0f} MiB on the GPU, --memory-limit allows {:.0f}; use a "
                  "smaller --grid",
                  options.grid_cells, double(expected) / 1048576.0, double(*options.memory_limit) / 1048576.0));
}

}  // namespace

std::unique_ptr<FrameVolume> make_volume_on_gpu(const Scene& scene, const VolumeOptions& options, glm::ivec2 size) {
  refuse_above_limit(scene, options);
  if (carries_sides(options.scheme.scheme)) return std::make_unique<SidesOnGpu>(scene, options, size);
  return std::make_unique<PulseOnGpu>(scene, options, size);
}

}  // namespace volgi::screen
