#include "core/surface.h"
#include "propagation/bounces_gl.h"
#include "propagation/pulse_volume_gl.h"
#include "propagation/side_irradiance_gl.h"
#include "propagation/transport_conservative_gl.h"
#include "propagation/transport_ordinates_gl.h"
#include "propagation/volume_cpu.h"
#include "screen/bounces/volume/frame_volume.h"
#include "screen/bounces/volume/inject_reflective_shadow_map.h"
#include "screen/bounces/volume/radiance_gather.h"
#include "screen/bounces/volume/volume_gather.h"
#include "screen/sources/sky/side_sky_gl.h"
#include "voxel/cell_volumes_gl.h"
#include "voxel/emitter_pieces.h"
#include "voxel/sliced_voxelization.h"
#include "voxel/white_pockets.h"
#include "voxel/white_pockets_gl.h"

namespace volgi::screen {

namespace {

std::unique_ptr<TransportGl> make_transport_gl(const Grid& grid, const SchemeOptions& options) {
  if (options.scheme == Scheme::conservative) return std::make_unique<ConservativeTransportGl>(grid, options.sh_order);
  return std::make_unique<OrdinatesTransportGl>(grid, options);
}

/// Voxels and light in, for every scheme.
class LitVoxels {
 public:
  LitVoxels(const Scene& scene, const VolumeOptions& options)
      : scene_(scene),
        options_(options),
        voxelization_(make_grid(scene, options.grid_cells, options.grid_shift_cells, options.grid_box),
                      options.voxelization),
        emitters_(emitter_pieces(scene, voxelization_.voxels().grid)) {
    follow_albedo();
  }

  /// @param emission_apart  SideFluxGl::inject_emitters.
  void run(const gl::SceneBuffers& buffers, const ReflectiveShadowMap& maps, bool emission_apart,
           gl::PassTimer& timer) {
    voxelize(buffers, timer);
    flux_.begin(voxels());
    flux_.inject_emitters(voxels(), emitters_, timer, emission_apart);
    inject_.run(voxels(), maps, scene_, flux_, timer);
  }
  /// The first bounce in, instead of light.
  void run(const gl::SceneBuffers& buffers, const FirstBounce& first_bounce, gl::PassTimer& timer) {
    voxelize(buffers, timer);
    flux_.begin(voxels());
    if (!reflected_flux_) reflected_flux_ = std::make_unique<ReflectedFluxGl>(scene_);
    reflected_flux_->run(voxels(), first_bounce, flux_, timer);
    if (first_bounce.sky == nullptr) return;
    if (!side_sky_) side_sky_ = std::make_unique<SideSkyGl>();
    side_sky_->run(voxels(), *first_bounce.sky, flux_, timer, first_bounce.sample);
  }
  /// @return false where the scene's bounds make another grid.
  bool follow_scene() {
    if (!same_grid(make_grid(scene_, options_.grid_cells, options_.grid_shift_cells, options_.grid_box), voxels().grid))
      return false;
    voxelization_.count_again();
    if (reflected_flux_) reflected_flux_->follow(scene_);
    emitters_ = emitter_pieces(scene_, voxels().grid);
    follow_albedo();
    return true;
  }
  const VoxelGridGl& voxels() const { return voxelization_.voxels(); }
  const SideFluxGl& flux() const { return flux_; }
  bool emits() const { return !emitters_.empty(); }
  size_t bytes() const { return voxelization_.bytes() + flux_.bytes() + (pockets_ ? pockets_->bytes() : 0); }

  VolumeReport report(const BounceReport& bounces) const {
    VolumeReport r;
    r.on_gpu = true;
    r.grid = voxels().grid.cells;
    r.sides = voxels().side_count.download<std::uint32_t>(1)[0];
    r.pocket_cells = pockets_ ? pockets_->cells() : 0;
    r.bounces = bounces;
    r.lost = flux_.lost();
    for (const gl::Buffer* flux : {&flux_.emitted(), &flux_.punctual()}) {
      for (glm::vec4 f : flux->download<glm::vec4>(r.sides)) r.injected += glm::vec3(f);
    }
    return r;
  }

 private:
  void follow_albedo() {
    if (!may_have_white_pockets(largest_albedo(scene_)))
      pockets_.reset();
    else if (!pockets_)
      pockets_ = std::make_unique<WhitePocketsGl>();
  }
  void voxelize(const gl::SceneBuffers& buffers, gl::PassTimer& timer) {
    voxelization_.run(buffers, timer);
    if (pockets_) pockets_->run(voxels(), timer);
  }

  const Scene& scene_;
  VolumeOptions options_;
  SlicedVoxelization voxelization_;
  std::unique_ptr<WhitePocketsGl> pockets_;  // of scenes that can have some
  SideFluxGl flux_;
  InjectReflectiveShadowMap inject_;
  std::vector<FluxSample> emitters_;
  std::unique_ptr<ReflectedFluxGl> reflected_flux_;  // after a first bounce
  std::unique_ptr<SideSkyGl> side_sky_;
};

/// Schemes that carry light from sides to sides.
class SidesOnGpu : public FrameVolume {
 public:
  SidesOnGpu(const Scene& scene, const VolumeOptions& options, glm::ivec2 size)
      : scene_(scene),
        options_(options),
        rules_(bounce_rules(options, scene)),
        lit_(scene, options),
        bounces_(make_transport_gl(lit_.voxels().grid, options.scheme)),
        gather_(size) {}

  void run(const gl::SceneBuffers& buffers, const ReflectiveShadowMap& maps, const GBuffer& gbuffer,
           const Camera& camera, const FirstBounce* first_bounce, gl::PassTimer& timer) override {
    radiance_is_new_ = false;
    if (first_bounce != nullptr) {
      lit_.run(buffers, *first_bounce, timer);
    } else {
      lit_.run(buffers, maps, true, timer);
    }
    const bool sky_apart = first_bounce != nullptr && first_bounce->sky != nullptr;
    first_is_apart_ = first_bounce == nullptr || lit_.emits() || sky_apart;
    bounce_report_ = bounces_.run(lit_.voxels(), lit_.flux(), lit_.emits() || sky_apart, rules_, timer,
                                  streaming_sky(scene_, options_));
    irradiance_.run(lit_.voxels(), lit_.flux(), bounces_, timer);
    gather_.run(gbuffer, camera, {lit_.voxels(), irradiance_.direct(), irradiance_.indirect(), first_is_apart_},
                first_bounce != nullptr ? first_bounce->smooth : nullptr, timer);
  }
  bool follow_scene() override {
    rules_ = bounce_rules(options_, scene_);
    return lit_.follow_scene();
  }
  bool first_is_apart() const override { return first_is_apart_; }
  const gl::Texture& direct() const override { return gather_.direct(); }
  const gl::Texture& indirect() const override { return gather_.indirect(); }
  void list_textures(std::vector<NamedTexture>& list) const override { gather_.list_textures(list); }
  const VoxelGridGl& voxels() const override { return lit_.voxels(); }
  const gl::Buffer* direct_irradiance() const override { return &irradiance_.direct(); }
  const gl::Buffer* indirect_irradiance() const override { return &irradiance_.indirect(); }
  const gl::Buffer* indirect_irradiance_but_last(gl::PassTimer& timer) const override {
    if (!but_last_) but_last_ = std::make_unique<SideIrradianceGl>();
    but_last_->run(lit_.voxels(), lit_.flux(), bounces_.received_direct(), bounces_.received_but_last(), timer);
    return &but_last_->indirect();
  }
  SentFlux light_in() const override { return {&lit_.flux().punctual(), &lit_.flux().emitted()}; }
  const RadianceVolumeGl* radiance(gl::PassTimer& timer) const override {
    if (options_.passes_per_run) return nullptr;
    if (radiance_is_new_) return &radiance_;
    const auto scope = timer.scope("screen/bounces/volume/radiance");
    radiance_ = bounces_.transport().radiance(lit_.voxels(), bounces_.sent(lit_.voxels(), lit_.flux()));
    radiance_is_new_ = true;
    return &radiance_;
  }
  VolumeReport report() const override {
    VolumeReport r = lit_.report(bounce_report_);
    r.memory_bytes = lit_.bytes() + bounces_.bytes() + irradiance_.bytes() + radiance_.bytes() + gather_.bytes() +
                     (but_last_ ? but_last_->bytes() : 0);
    return r;
  }

 private:
  const Scene& scene_;
  VolumeOptions options_;
  BounceRules rules_;
  LitVoxels lit_;
  BouncesGl bounces_;
  SideIrradianceGl irradiance_;
  VolumeGather gather_;
  bool first_is_apart_ = true;
  BounceReport bounce_report_;
  // Of the last run, when it is asked for.
  mutable std::unique_ptr<SideIrradianceGl> but_last_;
  mutable RadianceVolumeGl radiance_;
  mutable bool radiance_is_new_ = false;
};

/// The papers' schemes: a pulse through cells, read from spherical harmonics.
class PulseOnGpu : public FrameVolume {
 public:
  PulseOnGpu(const Scene& scene, const VolumeOptions& options, glm::ivec2 size)
      : options_(options),
        lit_(scene, options),
        cells_(lit_.voxels().grid),
        pulse_(lit_.voxels().grid, options.scheme),
        gather_(size, options.scheme.sh_order) {
    bounce_rules(options, 0.0f);  // says what these schemes cannot do
  }

  void run(const gl::SceneBuffers& buffers, const ReflectiveShadowMap& maps, const GBuffer& gbuffer,
           const Camera& /*camera*/, const FirstBounce* /*first_bounce*/, gl::PassTimer& timer) override {
    // By MAX, emission comes with the cells.
    const bool by_max = options_.scheme.injection == SchemeOptions::Injection::max;
    lit_.run(buffers, maps, by_max, timer);
    cells_.run(buffers, timer);
    bounce_report_ =
        pulse_.run(lit_.voxels(), {cells_.normal_occupancy(), cells_.albedo(), cells_.emission()},
                   lit_.flux().punctual(), options_.iterations.value_or(VolumeOptions::kPulseIterations), timer);
    const bool occupied_only = options_.scheme.scheme == Scheme::gaitatzes2010;
    gather_.run(gbuffer, lit_.voxels(), pulse_.radiance(), occupied_only ? &cells_.normal_occupancy() : nullptr, timer);
  }
  bool follow_scene() override { return lit_.follow_scene(); }
  const gl::Texture& direct() const override { return gather_.direct(); }
  const gl::Texture& indirect() const override { return gather_.indirect(); }
  void list_textures(std::vector<NamedTexture>& list) const override { gather_.list_textures(list); }
  const VoxelGridGl& voxels() const override { return lit_.voxels(); }
  const RadianceVolumeGl* radiance(gl::PassTimer& /*timer*/) const override { return &pulse_.radiance(); }
  VolumeReport report() const override {
    VolumeReport r = lit_.report(bounce_report_);
    r.memory_bytes = lit_.bytes() + cells_.bytes() + pulse_.bytes() + gather_.bytes();
    return r;
  }

 private:
  VolumeOptions options_;
  LitVoxels lit_;
  CellVolumesGl cells_;
  PulseVolumeGl pulse_;
  RadianceGather gather_;
  BounceReport bounce_report_;
};

}  // namespace

size_t volume_bytes_on_gpu(const Scene& scene, const VolumeOptions& options, glm::ivec2 size) {
  const Grid grid = make_grid(scene, options.grid_cells, options.grid_shift_cells, options.grid_box);
  const SchemeOptions& scheme = options.scheme;
  const ExpectedSides expected = expected_sides(scene, grid);
  const std::uint32_t capacity = side_capacity_for(expected.sides);
  const bool lit = options.source == VolumeOptions::Source::lights;
  const size_t bytes = voxelization_bytes(grid, scene, expected) +
                       SideFluxGl::bytes_for(capacity, lit ? emitter_pieces(scene, grid).size() : 0) +
                       (may_have_white_pockets(largest_albedo(scene)) ? WhitePocketsGl::bytes_for(grid) : 0);
  if (!carries_sides(scheme.scheme)) {
    return bytes + CellVolumesGl::bytes_for(grid) + PulseVolumeGl::bytes_for(grid, scheme.sh_order) +
           RadianceGather::bytes_for(size);
  }
  const bool linear = scheme.scheme == Scheme::ordinates;
  const size_t transport = linear
                               ? OrdinatesTransportGl::bytes_for(grid, choose_ordinates(grid.cells, scheme), capacity)
                               : ConservativeTransportGl::bytes_for(grid, scheme.sh_order);
  const BounceRules rules = bounce_rules(options, scene);
  return bytes + transport + BouncesGl::bytes_for(capacity, rules, linear) + SideIrradianceGl::bytes_for(capacity) +
         VolumeGather::bytes_for(size);
}

size_t volume_bytes_expected(const Scene& scene, const VolumeOptions& options, bool on_gpu, glm::ivec2 size) {
  return on_gpu ? volume_bytes_on_gpu(scene, options, size) : volume_bytes_on_cpu(scene, options, size);
}

std::unique_ptr<FrameVolume> make_volume_on_gpu(const Scene& scene, const VolumeOptions& options, glm::ivec2 size) {
  refuse_on_gpu(options);
  if (options.memory_limit) refuse_above_limit(options, volume_bytes_on_gpu(scene, options, size), "GPU");
  if (carries_sides(options.scheme.scheme)) return std::make_unique<SidesOnGpu>(scene, options, size);
  return std::make_unique<PulseOnGpu>(scene, options, size);
}

}  // namespace volgi::screen
