#include "screen/frame.h"

#include "core/gl/context.h"
#include "core/log.h"

namespace volgi::screen {

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
  const bool direct_only = options.light == LightPart::direct || options.volume.bounces == 0;
  // The papers' volumes do not know which of their light is direct.
  if (direct_only && !carries_sides(options.volume.scheme.scheme)) return false;
  return direct_only ? has_emission(scene) : has_emission(scene) || !scene.lights.empty();
}

}  // namespace

bool runs_on_gpu(Backend backend) {
  return backend == Backend::gpu || (backend == Backend::automatic && !gl::current_is_software());
}

Frame::Frame(const Scene& scene, const FrameOptions& options)
    : scene_(scene),
      options_(options),
      budget_(bounce_budget(options.gi)),
      buffers_(scene),
      shadow_maps_(options.shadow_resolution),
      gbuffer_(options.size),
      direct_(options.size),
      compose_(options.size) {
  if (options.light == LightPart::direct && carries_sides(options.volume.scheme.scheme)) options_.volume.bounces = 0;
  if (needs_volume(scene, options_)) {
    volume_ = runs_on_gpu(options_.backend) ? make_volume_on_gpu(scene, options_.volume, options_.size)
                                            : make_volume_on_cpu(scene, options_.volume, options_.size);
  } else if (budget_.emission_arrival == BounceBudget::Carrier::nobody && has_emission(scene)) {
    warn_once(scene.name + ": emissive surfaces are seen but light nothing with --gi none");
  }
}

Frame::~Frame() = default;

void Frame::render(const Camera& camera, gl::PassTimer& timer) {
  shadow_maps_.run(buffers_, scene_, timer);
  gbuffer_.run(buffers_, camera, timer);
  if (volume_) volume_->run(buffers_, shadow_maps_, gbuffer_, camera, timer);
  direct_.run(gbuffer_, shadow_maps_, timer);
  RadianceLayers layers;
  layers.direct = {&direct_.radiance(), &gbuffer_.emission()};
  if (volume_) {
    layers.direct.push_back(&volume_->direct());
    layers.indirect.push_back(&volume_->indirect());
  }
  compose_.run(gbuffer_, layers, options_.light, timer);
}

const gl::Texture& Frame::radiance() const { return compose_.radiance(); }

FrameReport Frame::report() const {
  FrameReport r;
  // Per pixel: depth, position, normals, albedo, emission and id of the G-buffer; direct; compose.
  r.memory_bytes = buffers_.bytes() + shadow_maps_.bytes() +
                   size_t(options_.size.x) * size_t(options_.size.y) * (4 + 16 + 8 + 8 + 16 + 4 + 16 + 16);
  if (!volume_) return r;
  r.volume = volume_->report();
  r.memory_bytes += r.volume.memory_bytes;
  return r;
}

}  // namespace volgi::screen
