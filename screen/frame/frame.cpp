#include "screen/frame/frame.h"

#include <algorithm>
#include <utility>

#include "core/error.h"
#include "core/gl/context.h"
#include "core/log.h"
#include "core/sample_sequence.h"
#include "core/surface.h"
#include "screen/frame/registry.h"

namespace volgi::screen {

bool runs_on_gpu(Backend backend) {
  return backend == Backend::gpu || (backend == Backend::automatic && !gl::current_is_software());
}

Frame::Frame(const Scene& scene, const FrameOptions& options) : Frame(scene, options, recipe_of(options)) {}

Frame::Frame(const Scene& scene, const FrameOptions& options, Recipe recipe,
             std::shared_ptr<gl::SceneBuffers> triangles)
    : scene_(scene),
      options_(options),
      recipe_(std::move(recipe)),
      buffers_(triangles ? std::move(triangles) : std::make_shared<gl::SceneBuffers>(scene)),
      shadow_maps_(options.of<ReflectiveShadowMap::Resolution>()),
      gbuffer_(options.size, GL_RGBA16_SNORM, shines(scene), has_phong_lobes(scene)),
      direct_(options.size, gbuffer_.shines(), buffers_->has_glass(), gbuffer_.phong()),
      compose_(options.size) {
  follow_with_stages();
}

Frame::~Frame() = default;

void Frame::follow_scene(gl::PassTimer& timer) {
  const auto scope = timer.scope("screen/frame/follow_scene");
  buffers_->set_geometry(scene_);
  layers_.clear();
  products_ = {};
  follow_with_stages();
}

/// Stages that the picture needs now: those there are follow, others are made.
void Frame::follow_with_stages() {
  const Plan plan = plan_picture(recipe_, options_, paths_in(scene_), gbuffer_.shines());
  wanted_ = plan.wanted;
  gbuffer_.set_mirror_apart(plan.mirror_apart ? std::optional(options_.of<MirrorApart>().least) : std::nullopt);
  std::vector<Step> before = std::exchange(steps_, {});
  // First those that go, so that there are never two of what is large.
  std::erase_if(before, [&](const Step& step) {
    return std::none_of(plan.steps.begin(), plan.steps.end(),
                        [&](const Plan::Step& p) { return p.type == step.plan.type && p.taken == step.plan.taken; });
  });
  for (const Plan::Step& step : plan.steps) steps_.push_back({step, take_stage(before, step)});
  warn_of_missing_light(plan.missing);
}

std::unique_ptr<Stage> Frame::take_stage(std::vector<Step>& from, const Plan::Step& step) {
  for (Step& old : from) {
    if (!old.stage || old.plan.type != step.type) continue;
    old.stage->scene_changed();
    return std::move(old.stage);
  }
  return step.type->make({scene_, options_, wanted_, step.taken});
}

void Frame::warn_of_missing_light(LightPaths missing) const {
  if (missing.contains(LightPath::sky_direct))
    warn_once(scene_.name + ": the sky is seen but lights nothing with --gi " + recipe_.name + " and these options");
  const bool bounces_asked = options_.bounces && *options_.bounces > 1;
  if (missing.contains(LightPath::emission_direct)) {
    warn_once(scene_.name + ": emissive surfaces are seen but light nothing with --gi " + recipe_.name);
  } else if (missing.contains(LightPath::emission_first)) {
    warn_once(scene_.name + ": light of emissive surfaces is not reflected with --gi " + recipe_.name +
              "; these do: " + recipes_that_carry({LightPath::emission_first}));
  } else if (bounces_asked && missing.contains(LightPath::punctual_higher)) {
    warn_once(std::string("--gi ") + recipe_.name + " carries one bounce, whatever --bounces asks for");
  }
}

void Frame::set_sample(int index, bool jitter) {
  sample_ = jitter ? index : 0;
  buffers_->set_sample(float(sample_shift(SampleChoice::coverage, std::uint64_t(index))));
  gbuffer_.set_jitter(glm::vec2(pixel_shift(std::uint64_t(sample_))));
}

void Frame::render(const Camera& camera, gl::PassTimer& timer) {
  shadow_maps_.run(*buffers_, scene_, timer);
  gbuffer_.run(*buffers_, camera, timer);
  if (scene_.sky) {
    if (!sky_seen_) sky_seen_.emplace(gbuffer_);
    sky_seen_->run(*scene_.sky, camera, timer);
  }
  FrameData frame{.scene = scene_,
                  .triangles = *buffers_,
                  .camera = camera,
                  .gbuffer = gbuffer_,
                  .shadow_maps = shadow_maps_,
                  .wanted = wanted_,
                  .scene_diagonal_m = glm::distance(scene_.bounds_min, scene_.bounds_max),
                  .sky = sky_seen_ ? &*sky_seen_ : nullptr,
                  .sample = sample_};
  layers_.clear();  // of later stages before those of earlier ones: small light first
  bool lights_ready = false;
  for (const Step& step : steps_) {
    if (!lights_ready && step.plan.type->slot > Slot::lights) {
      for (const Step& any : steps_) any.stage->lights_ready(frame, timer);
      lights_ready = true;
    }
    frame.earlier = layers_;
    step.stage->run(frame, timer);
    check_layers(step.plan, frame.layers);
    layers_.insert(layers_.begin(), frame.layers.begin(), frame.layers.end());
    frame.layers.clear();
  }
  direct_.run(gbuffer_, camera, shadow_maps_, timer);
  layers_.insert(layers_.begin(),
                 {RadianceLayer{&direct_.radiance(), {LightPath::punctual_direct}},
                  RadianceLayer{&gbuffer_.emission(), {LightPath::emission_seen, LightPath::sky_seen}}});
  products_ = std::move(frame.products);
  compose(timer);
}

void Frame::compose(gl::PassTimer& timer) {
  compose_.run(gbuffer_, shown(), scene_.sky ? &gbuffer_.emission() : nullptr, timer, buffers_.get());
}

/// Direct light, then indirect, of what --light asks for.
std::vector<const gl::Texture*> Frame::shown() const {
  std::vector<const gl::Texture*> direct, indirect;
  for (const RadianceLayer& layer : layers_) {
    if (!layer.paths.meets(shown_)) continue;
    (layer.paths.meets(INDIRECT_PATHS) ? indirect : direct).push_back(layer.texture);
  }
  if (options_.light == LightPart::direct) return direct;
  if (options_.light == LightPart::indirect) return indirect;
  direct.insert(direct.end(), indirect.begin(), indirect.end());
  return direct;
}

std::vector<NamedTexture> Frame::textures() const {
  std::vector<NamedTexture> list;
  shadow_maps_.list_textures(list);
  gbuffer_.list_textures(list);
  for (const Step& step : steps_) step.stage->list_textures(list);
  list_texture(list, Direct::name, "", direct_.radiance());
  list_texture(list, Compose::name, "", compose_.radiance());
  return list;
}

std::vector<const StageType*> Frame::stages() const {
  std::vector<const StageType*> list;
  for (const Step& step : steps_) list.push_back(step.plan.type);
  return list;
}

FrameReport Frame::report() const {
  FrameReport r;
  r.memory_bytes = buffers_->bytes() + shadow_maps_.bytes() + gbuffer_.bytes() + direct_.bytes() + compose_.bytes() +
                   (sky_seen_ ? sky_seen_->bytes() : 0);
  for (const Step& step : steps_) step.stage->report(r);
  return r;
}

VirtualLightList Frame::virtual_lights() const {
  VirtualLightList list;
  list.world_origin = scene_.world_origin;
  for (const Step& step : steps_) step.stage->list_lights(list);
  return list;
}

std::vector<std::string> Frame::announcements() const {
  std::vector<std::string> lines;
  for (const Step& step : steps_) {
    if (std::string line = step.stage->announcement(); !line.empty()) lines.push_back(std::move(line));
  }
  return lines;
}

}  // namespace volgi::screen
