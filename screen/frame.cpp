#include "screen/frame.h"

#include "core/log.h"
#include "core/surface.h"
#include "propagation/bounces_gl.h"
#include "propagation/side_irradiance_gl.h"
#include "propagation/transport_conservative_gl.h"
#include "propagation/transport_ordinates_gl.h"
#include "screen/inject_reflective_shadow_map.h"
#include "screen/volume_gather.h"
#include "voxel/emitter_pieces.h"
#include "voxel/sliced_voxelization.h"

namespace volgi::screen {

namespace {

std::unique_ptr<TransportGl> make_transport(const Grid& grid, const FrameOptions& options) {
  if (options.scheme == Scheme::conservative) return std::make_unique<ConservativeTransportGl>(grid);
  return std::make_unique<OrdinatesTransportGl>(grid, options.directions.value_or(directions_for_grid(grid.cells)));
}

}  // namespace

/// The volume subsystem's part of a frame.
struct Frame::Volume {
  Volume(const Scene& scene, const Grid& grid, const FrameOptions& options)
      : voxelization(grid),
        bounces(make_transport(grid, options)),
        gather(options.size),
        emitters(emitter_pieces(scene, grid)),
        largest_albedo(volgi::largest_albedo(scene)) {}

  SlicedVoxelization voxelization;
  SideFluxGl flux;
  InjectReflectiveShadowMap inject;
  BouncesGl bounces;
  SideIrradianceGl irradiance;
  VolumeGather gather;
  std::vector<FluxSample> emitters;
  float largest_albedo;
  BounceReport report;
};

namespace {

bool has_emission(const Scene& scene) {
  for (const Mesh& mesh : scene.meshes) {
    if (scene.materials[size_t(mesh.material)].is_emissive() && !mesh.triangles.empty()) return true;
  }
  return false;
}

/// Only what the picture shows is computed: direct light alone needs no volume, unless emitters light the scene by it.
bool needs_volume(const Scene& scene, const FrameOptions& options) {
  if (options.gi != GiMode::volume || scene.triangle_count() == 0) return false;
  const bool direct_only = options.light == LightPart::direct || options.bounces == 0;
  return direct_only ? has_emission(scene) : has_emission(scene) || !scene.lights.empty();
}

}  // namespace

Frame::Frame(const Scene& scene, const FrameOptions& options)
    : scene_(scene),
      options_(options),
      budget_(bounce_budget(options.gi)),
      buffers_(scene),
      shadow_maps_(options.shadow_resolution),
      gbuffer_(options.size),
      direct_(options.size),
      compose_(options.size) {
  if (options.light == LightPart::direct) options_.bounces = 0;
  if (needs_volume(scene, options_)) {
    Grid grid = make_grid(scene, options_.grid_cells, options_.grid_shift_cells);
    volume_ = std::make_unique<Volume>(scene, grid, options_);
  } else if (budget_.emission_arrival == BounceBudget::Carrier::nobody && has_emission(scene)) {
    warn_once(scene.name + ": emissive surfaces are seen but light nothing with --gi none");
  }
}

Frame::~Frame() = default;

void Frame::render(const Camera& camera, gl::PassTimer& timer) {
  shadow_maps_.run(buffers_, scene_, timer);
  if (volume_) run_volume(timer);
  gbuffer_.run(buffers_, camera, timer);
  direct_.run(gbuffer_, shadow_maps_, timer);
  RadianceLayers layers;
  layers.direct = {&direct_.radiance(), &gbuffer_.emission()};
  if (volume_) {
    volume_->gather.run(gbuffer_, camera, volume_->voxelization.voxels(), volume_->irradiance, timer);
    layers.direct.push_back(&volume_->gather.direct());
    layers.indirect.push_back(&volume_->gather.indirect());
  }
  compose_.run(gbuffer_, layers, options_.light, timer);
}

void Frame::run_volume(gl::PassTimer& timer) {
  Volume& v = *volume_;
  const VoxelGridGl& voxels = v.voxelization.voxels();
  v.voxelization.run(buffers_, timer);
  v.flux.begin(voxels);
  v.flux.inject_emitters(voxels, v.emitters, timer);
  v.inject.run(voxels, shadow_maps_, scene_, v.flux, timer);
  BounceRules rules{options_.bounces, options_.iterations, v.largest_albedo};
  v.report = v.bounces.run(voxels, v.flux, !v.emitters.empty(), rules, timer);
  v.irradiance.run(voxels, v.flux, v.bounces, timer);
}

const gl::Texture& Frame::radiance() const { return compose_.radiance(); }

FrameReport Frame::report() const {
  FrameReport r;
  // Per pixel: depth, position, normals, albedo, emission and id of the G-buffer; direct; compose.
  r.memory_bytes = buffers_.bytes() + shadow_maps_.bytes() +
                   size_t(options_.size.x) * size_t(options_.size.y) * (4 + 16 + 8 + 8 + 16 + 4 + 16 + 16);
  if (!volume_) return r;
  const Volume& v = *volume_;
  r.grid = v.voxelization.voxels().grid.cells;
  r.sides = v.voxelization.voxels().side_count.download<std::uint32_t>(1)[0];
  r.bounces = v.report;
  r.lost = v.flux.lost();
  for (const gl::Buffer* flux : {&v.flux.emitted(), &v.flux.punctual()}) {
    for (glm::vec4 f : flux->download<glm::vec4>(r.sides)) r.injected += glm::vec3(f);
  }
  r.memory_bytes +=
      v.voxelization.bytes() + v.flux.bytes() + v.bounces.bytes() + v.irradiance.bytes() + v.gather.bytes();
  return r;
}

}  // namespace volgi::screen
