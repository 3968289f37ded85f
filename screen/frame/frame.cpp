#include "screen/frame/frame.h"

#include "core/error.h"
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

bool direct_only(const FrameOptions& options) {
  return options.light == LightPart::direct || options.volume.bounces == 0;
}

/// Only what the picture shows is computed: direct light alone needs nobody to carry it, unless emitters light the
/// scene.
bool needs_carrier(const Scene& scene, const FrameOptions& options) {
  if (scene.triangle_count() == 0) return false;
  return has_emission(scene) || (!direct_only(options) && !scene.lights.empty());
}

bool needs_volume(const Scene& scene, const FrameOptions& options) {
  if (options.gi == GiMode::hybrid)  // its first bounce comes from the screen
    return !direct_only(options) && (options.volume.bounces != 1 || has_emission(scene)) &&
           needs_carrier(scene, options);
  if (options.gi != GiMode::volume) return false;
  // The papers' volumes do not know which of their light is direct.
  if (direct_only(options) && !carries_sides(options.volume.scheme.scheme)) return false;
  return needs_carrier(scene, options);
}

bool lights_have_parts(const FrameOptions& options) {
  return options.near_zone > 0.0f && options.choose_one_of > 1 &&
         (options.gi == GiMode::val || options.gi == GiMode::hybrid);
}

VirtualLightOptions candidate_options(const FrameOptions& options) {
  VirtualLightOptions o = options.virtual_lights;
  o.candidates = options.choose_one_of;
  o.along_curve = lights_have_parts(options);
  return o;
}

void warn_of_missing_light(const Scene& scene, const FrameOptions& options, const BounceBudget& budget) {
  if (!has_emission(scene)) return;
  if (budget.emission_arrival == BounceBudget::Carrier::nobody) {
    warn_once(scene.name + ": emissive surfaces are seen but light nothing with --gi none");
  } else if (budget.higher_bounces == BounceBudget::Carrier::nobody && !direct_only(options)) {
    warn_once(scene.name +
              ": light of emissive surfaces is not reflected with --gi vpl, negative and val; take hybrid or volume");
  }
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
  if (options_.gi == GiMode::hybrid) {
    if (!carries_sides(options_.volume.scheme.scheme))
      throw Error(ExitCode::usage, "--gi hybrid needs a scheme that carries orders: ordinates or conservative");
    options_.volume.source = VolumeOptions::Source::first_bounce;
    options_.volume.virtual_lights = options_.virtual_lights.count;
  }
  follow_with_volume();
  follow_with_first_bounce();
  warn_of_missing_light(scene, options_, budget_);
}

Frame::~Frame() = default;

void Frame::follow_scene(gl::PassTimer& timer) {
  const auto scope = timer.scope("screen/frame/follow_scene");
  buffers_.set_geometry(scene_);
  follow_with_volume();
  follow_with_first_bounce();
}

void Frame::follow_with_volume() {
  if (!needs_volume(scene_, options_)) {
    volume_.reset();
  } else if (!volume_ || !volume_->follow_scene()) {
    volume_.reset();  // first, so that there are never two
    volume_ = runs_on_gpu(options_.backend) ? make_volume_on_gpu(scene_, options_.volume, options_.size)
                                            : make_volume_on_cpu(scene_, options_.volume, options_.size);
  }
}

void Frame::follow_with_first_bounce() {
  if (budget_.first_bounce != BounceBudget::Carrier::virtual_lights || !needs_carrier(scene_, options_)) {
    drop_first_bounce();
  } else if (!virtual_lights_) {
    make_first_bounce();
  } else {
    virtual_lights_->scene_moved();
    if (voxels_) voxels_->follow_scene();
  }
}

void Frame::drop_first_bounce() {
  virtual_lights_.reset();
  choose_virtual_lights_.reset();
  light_parts_.reset();
  near_lights_.reset();
  voxels_.reset();
  negative_lights_.reset();
  virtual_light_gather_.reset();
  area_light_gather_.reset();
  area_light_shadow_.reset();
  area_light_maps_.reset();
  area_lights_.reset();
}

void Frame::make_first_bounce() {
  virtual_lights_ = std::make_unique<VirtualLights>(scene_, candidate_options(options_));
  if (options_.choose_one_of > 1)
    choose_virtual_lights_ = std::make_unique<ChooseVirtualLights>(options_.choose_one_of);
  if (options_.gi == GiMode::val || options_.gi == GiMode::hybrid) {
    area_lights_ = std::make_unique<VirtualAreaLights>(options_.area_lights);
    area_light_maps_ = std::make_unique<ParaboloidDepthMaps>(options_.area_light_map, options_.area_lights.count);
    area_light_shadow_ =
        AreaLightShadow::make(options_.area_light_shadow, options_.area_light_map, options_.area_lights.count);
    if (lights_have_parts(options_)) {
      light_parts_ = std::make_unique<VirtualLightParts>();
      near_lights_ = std::make_unique<NearLights>(options_.size, options_.near_zone);
      options_.area_light_gather.near_zone = options_.near_zone;
    }
    area_light_gather_ =
        std::make_unique<AreaLightGather>(options_.size, options_.area_light_gather, *area_light_shadow_);
    return;
  }
  virtual_light_gather_ = std::make_unique<VirtualLightGather>(options_.size, options_.gather);
  if (options_.gi != GiMode::negative || direct_only(options_)) return;
  negative_lights_ = std::make_unique<NegativeLights>(options_.negative_lights);
  if (options_.negative_lights.method == NegativeLightOptions::Method::sides)
    voxels_ = make_frame_voxels(scene_, options_.volume, runs_on_gpu(options_.backend));
}

void Frame::light_by_virtual_lights(const VirtualLightListGl& lights, const Camera& camera, gl::PassTimer& timer) {
  if (voxels_) voxels_->run(buffers_, timer);
  if (negative_lights_) negative_lights_->run(gbuffer_, camera, lights, voxels_ ? &voxels_->voxels() : nullptr, timer);
  const auto part = direct_only(options_) ? VirtualLightGather::Part::emitted : VirtualLightGather::Part::all;
  virtual_light_gather_->run(gbuffer_, lights, negative_lights_.get(), part, scene_diagonal_m(), timer);
}

void Frame::light_by_area_lights(const VirtualLightListGl& lights, gl::PassTimer& timer) {
  area_lights_->run(lights.buffer, lights.count(), scene_diagonal_m(), timer);
  area_light_maps_->run(buffers_, *area_lights_, timer);
  area_light_shadow_->run(*area_light_maps_, timer);
  area_light_gather_->run(gbuffer_, lights, *area_lights_, *area_light_maps_, *area_light_shadow_, scene_diagonal_m(),
                          timer);
}

void Frame::render(const Camera& camera, gl::PassTimer& timer) {
  shadow_maps_.run(buffers_, scene_, timer);
  gbuffer_.run(buffers_, camera, timer);
  if (virtual_lights_) {
    virtual_lights_->run(shadow_maps_, timer);
    if (choose_virtual_lights_) choose_virtual_lights_->run(virtual_lights_->list(), gbuffer_, timer);
    if (light_parts_) light_parts_->run(shadow_maps_, *virtual_lights_, *choose_virtual_lights_, timer);
    if (near_lights_) near_lights_->run(gbuffer_, light_list(), *light_parts_, timer);
    if (area_lights_) {
      light_by_area_lights(light_list(), timer);
    } else {
      light_by_virtual_lights(light_list(), camera, timer);
    }
  }
  if (volume_) {
    if (area_lights_) {
      const FirstBounce first_bounce{light_list(), *area_lights_, *area_light_maps_, *area_light_shadow_};
      volume_->run(buffers_, shadow_maps_, gbuffer_, camera, &first_bounce, timer);
    } else {
      volume_->run(buffers_, shadow_maps_, gbuffer_, camera, nullptr, timer);
    }
  }
  direct_.run(gbuffer_, shadow_maps_, timer);

  RadianceLayers layers;
  layers.direct = {&direct_.radiance(), &gbuffer_.emission()};
  if (volume_) {
    // After a first bounce on the screen, what reaches surfaces from emission has been reflected before.
    (area_lights_ ? layers.indirect : layers.direct).push_back(&volume_->direct());
    layers.indirect.push_back(&volume_->indirect());
  }
  if (virtual_lights_) {
    const bool by_area = area_light_gather_ != nullptr;
    if (light_list().emitted > 0)  // else nobody has written it in this frame
      layers.direct.push_back(by_area ? &area_light_gather_->direct() : &virtual_light_gather_->direct());
    if (!direct_only(options_))
      layers.indirect.push_back(by_area ? &area_light_gather_->indirect() : &virtual_light_gather_->indirect());
  }
  if (near_lights_) {
    if (light_list().emitted > 0) layers.direct.push_back(&near_lights_->direct());
    if (!direct_only(options_)) layers.indirect.push_back(&near_lights_->indirect());
  }
  compose_.run(gbuffer_, layers, options_.light, timer);
}

const gl::Texture& Frame::radiance() const { return compose_.radiance(); }

const VirtualLightListGl& Frame::light_list() const {
  return choose_virtual_lights_ ? choose_virtual_lights_->lights() : virtual_lights_->list();
}

FrameReport Frame::report() const {
  FrameReport r;
  // Per pixel: depth, position, normals, albedo, emission and id of the G-buffer; direct; compose.
  r.memory_bytes = buffers_.bytes() + shadow_maps_.bytes() +
                   size_t(options_.size.x) * size_t(options_.size.y) * (4 + 16 + 8 + 8 + 16 + 4 + 16 + 16);
  if (volume_) {
    r.volume = volume_->report();
    r.memory_bytes += r.volume.memory_bytes;
  }
  if (virtual_lights_) {
    r.virtual_lights = light_list().count();
    r.memory_bytes += virtual_lights_->bytes() + (choose_virtual_lights_ ? choose_virtual_lights_->bytes() : 0);
  }
  if (virtual_light_gather_) {
    r.coarse_share = virtual_light_gather_->coarse_share();
    r.memory_bytes += virtual_light_gather_->bytes();
  }
  if (area_lights_) {
    r.area_lights = area_lights_->count();
    r.memory_bytes +=
        area_lights_->bytes() + area_light_maps_->bytes() + area_light_shadow_->bytes() + area_light_gather_->bytes();
  }
  if (near_lights_) r.memory_bytes += near_lights_->bytes() + light_parts_->bytes();
  if (negative_lights_) {
    r.negative_lights = negative_lights_->count();
    r.memory_bytes += negative_lights_->bytes() + (voxels_ ? voxels_->bytes() : 0);
  }
  return r;
}

VirtualLightList Frame::virtual_lights() const {
  VirtualLightList list;
  if (virtual_lights_) list.lights = download(light_list());
  list.world_origin = scene_.world_origin;
  if (!negative_lights_) return list;
  for (const shared::NegativeLight& n : negative_lights_->download())
    list.lights.push_back({n.position, n.area_m2, n.direction, VIRTUAL_LIGHT_NEGATIVE, n.flux, -1});
  return list;
}

}  // namespace volgi::screen
