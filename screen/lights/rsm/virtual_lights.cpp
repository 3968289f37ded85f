#include "screen/lights/rsm/virtual_lights.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <numeric>
#include <string>
#include <utility>

#include "core/error.h"
#include "core/halton.h"
#include "core/hilbert.h"
#include "core/light_cone.h"
#include "core/sample_sequence.h"
#include "shaders/screen/lights/rsm/slots.shared.h"
#include "shaders/screen/sources/sky/slots.shared.h"
#include "shaders/shared/group_sizes.shared.h"

namespace volgi::screen {
namespace {

using Sampling = VirtualLightOptions::Sampling;

constexpr int kSkyPartsOfPoint = 32;  // that a point on a surface looks at: with 16 of them for a light, nearly all

const VirtualLightOptions& checked(const VirtualLightOptions& options) {
  const int asked = options.per_light.value_or(options.count);
  if (asked < 1 || asked > VirtualLightOptions::kMaxCount) {
    throw Error(ExitCode::usage, std::to_string(asked) + " virtual lights: the number must lie between 1 and " +
                                     std::to_string(VirtualLightOptions::kMaxCount));
  }
  return options;
}

std::vector<glm::vec4> samples_of(const Light& light, Sampling sampling, int count, std::uint64_t sample) {
  std::vector<glm::vec4> samples;
  samples.reserve(size_t(count));
  const std::uint64_t first = first_halton_point(sample, count);
  if (sampling == Sampling::flux || light.type == Light::Type::directional) {
    for (int i = 0; i < count; ++i) samples.emplace_back(glm::vec2(halton(first + std::uint64_t(i))), 0.0f, 0.0f);
    return samples;
  }
  for (const glm::vec3 d : halton_directions_in_cone(cone_height(light), count, first - 1))
    samples.emplace_back(d, 0.0f);
  return samples;
}

/// Along a curve on which neighbours are near, so that equal steps through weights of theirs are an even choice.
void order_along_curve(std::vector<glm::vec4>& samples, bool directions) {
  float widest = 1e-10f;  // of directions, as height above the cone's axis -Y
  if (directions) {
    for (const glm::vec4& s : samples) widest = std::max(widest, s.y + 1.0f);
  }
  const auto place = [&](const glm::vec4& s) {
    if (!directions) return hilbert_index(glm::vec2(s));
    return hilbert_index({std::atan2(s.z, s.x) / glm::two_pi<float>() + 0.5f, (s.y + 1.0f) / widest});
  };
  std::stable_sort(samples.begin(), samples.end(),
                   [&](const glm::vec4& a, const glm::vec4& b) { return place(a) < place(b); });
}

shared::VirtualLight to_virtual_light(const EmitterPoint& point) {
  return {point.position, point.area_m2, point.normal, VIRTUAL_LIGHT_EMITTED, point.flux, -1};
}

/// Sizes of the levels of flux_importance.glsl, from level 1.
std::vector<int> pyramid_sizes(int resolution) {
  std::vector<int> sizes;
  while (resolution > 1) sizes.push_back(resolution = (resolution + 3) / 4);
  return sizes;
}

}  // namespace

VirtualLights::VirtualLights(const Scene& scene, const VirtualLightOptions& options)
    : scene_(scene), options_(checked(options)), emitters_(scene) {
  const bool by_flux = options_.sampling == Sampling::flux;
  lights_program_ = gl::Program::compute(by_flux ? "screen/lights/rsm/flux_importance_lights.comp.glsl"  //
                                                 : "screen/lights/rsm/virtual_lights.comp.glsl");
  if (by_flux) {
    texels_program_ = gl::Program::compute("screen/lights/rsm/flux_importance_texels.comp.glsl");
    reduce_program_ = gl::Program::compute("screen/lights/rsm/flux_importance_reduce.comp.glsl");
  }
}

void VirtualLights::scene_moved() {
  emitters_ = EmitterPoints(scene_);
  moved_ = true;
}

LightShares VirtualLights::shares(bool with_sky) const {
  LightShares shares = options_.per_light ? share_equally(scene_, emitters_.flux(), *options_.per_light, with_sky)
                                          : share_by_power(scene_, emitters_.flux(), options_.count, with_sky);
  // At most kMaxCount each, so that the sum cannot overflow for any number of lights that fits in memory.
  const auto all =
      std::accumulate(shares.of_light.begin(), shares.of_light.end(), std::int64_t(shares.of_sky) + shares.of_emitters);
  if (all > VirtualLightOptions::kMaxCount) {
    throw Error(ExitCode::over_limit, std::to_string(*options_.per_light) + " virtual lights for each source make " +
                                          std::to_string(all) + ", more than " +
                                          std::to_string(VirtualLightOptions::kMaxCount) + "; ask for fewer");
  }
  for (int& of_light : shares.of_light) of_light *= options_.candidates;
  shares.of_sky *= options_.candidates;
  shares.of_emitters *= options_.candidates;
  return shares;
}

/// Makes room, and places what does not depend on the maps: points on surfaces, zeros behind the last. @return whether
/// it had to.
bool VirtualLights::lay_out(const LightShares& shares, int sample) {
  const bool others = std::exchange(sample_, sample) != sample;
  const bool moved = (std::exchange(moved_, false) || others) && shares.of_emitters + shares.of_sky > 0;
  std::vector<int> of_light = shares.of_light;
  if (shares.of_sky > 0) of_light.push_back(shares.of_sky);
  if (!moved && list_.buffer.id() != 0 && of_light == list_.of_light && shares.of_emitters == list_.emitted)
    return false;
  list_.of_light = std::move(of_light);
  list_.reflected = std::accumulate(list_.of_light.begin(), list_.of_light.end(), 0);
  list_.emitted = shares.of_emitters;
  std::vector<shared::VirtualLight> lights(padded_count(list_));
  const std::vector<EmitterPoint> points = emitters_.points(list_.emitted, sample);
  std::transform(points.begin(), points.end(), lights.begin() + list_.reflected, to_virtual_light);
  const size_t bytes = lights.size() * sizeof(shared::VirtualLight);
  if (list_.buffer.bytes() == bytes) {
    list_.buffer.upload(lights.data(), bytes);
  } else {
    list_.buffer = gl::Buffer(lights);
  }
  surfaces_ = surface_points(scene_, shares.of_sky, sample);
  return true;
}

/// What the points on surfaces reflect of the sky, unless nothing has changed.
void VirtualLights::light_by_sky(const SkyMaps& sky, bool laid_out, int first, int count) {
  if (!laid_out && sky.version() == sky_version_) return;
  sky_version_ = sky.version();
  std::vector<shared::VirtualLight> points(static_cast<size_t>(count));
  for (size_t i = 0; i < std::min(points.size(), surfaces_.size()); ++i) {
    const SurfaceSample& s = surfaces_[i];
    points[i] = {s.position, s.area_m2, s.normal, VIRTUAL_LIGHT_REFLECTED, s.albedo, -1};
  }
  list_.buffer.upload(points.data(), points.size() * sizeof(shared::VirtualLight),
                      size_t(first) * sizeof(shared::VirtualLight));
  if (sky_program_.id() == 0) sky_program_ = gl::Program::compute("screen/sources/sky/sky_points.comp.glsl");
  sky.bind(sky_program_);
  list_.buffer.bind_storage(SKY_POINTS_SLOT);
  sky_program_.set("first", first);
  sky_program_.set("count", count);
  sky_program_.set("sample_index", sample_);
  sky_program_.set("subsets", std::max(sky.part_count() / kSkyPartsOfPoint, 1));
  sky_program_.use();
  gl::dispatch_linear(size_t(count), LINEAR_GROUP);
}

/// Uploads the samples of all lights, unless they are what they were.
void VirtualLights::make_samples(const LightShares& shares, int sample) {
  if (along_curve()) sample = 0;  // there are none
  std::vector<SampleKey> keys;
  for (size_t i = 0; i < scene_.lights.size(); ++i) {
    const Light& light = scene_.lights[i];
    keys.push_back(
        {light.type, light.type == Light::Type::spot ? light.outer_cone_rad : 0.0f, shares.of_light[i], sample});
  }
  if (samples_.id() != 0 && keys == keys_) return;
  std::vector<glm::vec4> samples;
  for (size_t i = 0; i < scene_.lights.size() && !along_curve(); ++i) {
    auto of_light = samples_of(scene_.lights[i], options_.sampling, shares.of_light[i], std::uint64_t(sample));
    if (options_.candidates > 1) {
      const bool by_area = options_.sampling == Sampling::flux || scene_.lights[i].type == Light::Type::directional;
      order_along_curve(of_light, !by_area);
    }
    samples.insert(samples.end(), of_light.begin(), of_light.end());
  }
  if (samples.empty()) samples.emplace_back(0.0f);
  gl::put(samples_, samples);
  keys_ = std::move(keys);
}

void VirtualLights::run(const ReflectiveShadowMap& maps, const SkyMaps* sky, gl::PassTimer& timer, int sample) {
  assert(maps.light_count() == int(scene_.lights.size()));
  const auto scope = timer.scope(name);
  const LightShares of = shares(sky != nullptr);
  const bool laid_out = lay_out(of, sample);
  make_samples(of, sample);
  int first = 0;
  for (int light = 0; light < maps.light_count(); ++light) {
    const int count = of.of_light[size_t(light)];
    if (count == 0) continue;
    maps.bind(light);
    samples_.bind_storage(LIGHT_SAMPLES_SLOT);
    lights_program_.set("light", light);
    lights_program_.set("count", count);
    lights_program_.set("first", first);
    lights_program_.set("first_sample", first);
    if (options_.sampling == Sampling::flux) {
      sample_by_flux(maps, light);
    } else {
      sample_evenly(maps, light, sample);
    }
    list_.buffer.bind_storage(SAMPLED_LIGHTS_SLOT);
    lights_program_.use();
    gl::dispatch_linear(size_t(count), LINEAR_GROUP);
    first += count;
  }
  if (of.of_sky > 0) light_by_sky(*sky, laid_out, first, of.of_sky);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_UNIFORM_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
}

double VirtualLights::set_sampling(const gl::Program& program, const ReflectiveShadowMap& maps, int light) const {
  const Light& l = scene_.lights[size_t(light)];
  program.set("world_from_axis",
              l.type == Light::Type::spot ? world_from_axis(glm::dvec3(l.direction)) : glm::mat3(1.0f));
  program.set("cone_height", float(cone_height(l)));
  if (l.type != Light::Type::directional) return 2.0 * glm::pi<double>() * cone_height(l);
  const size_t layer = size_t(maps.lights()[size_t(light)].first_layer);
  return rectangle_of_sun_m2(maps.layers()[layer], maps.resolution(light));
}

void VirtualLights::sample_evenly(const ReflectiveShadowMap& maps, int light, int sample) const {
  const double measure = set_sampling(lights_program_, maps, light);
  lights_program_.set("measure", float(measure / keys_[size_t(light)].count));
  lights_program_.set("along_curve", along_curve() ? 1 : 0);
  lights_program_.set("in_step", float(place_in_strata(std::uint64_t(sample))));
}

void VirtualLights::sample_by_flux(const ReflectiveShadowMap& maps, int light) {
  const int layers = maps.layer_count(light);
  const std::vector<int> sizes = pyramid_sizes(maps.resolution(light));
  size_t values = 0;
  for (const int size : sizes) values += size_t(layers) * size_t(size) * size_t(size);
  if (pyramid_.bytes() < values * sizeof(float)) pyramid_ = gl::Buffer(values * sizeof(float));
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);  // the light before may still be read from the pyramid
  pyramid_.bind_storage(FLUX_PYRAMID_SLOT);
  texels_program_.set("light", light);
  texels_program_.use();
  gl::dispatch({sizes[0], sizes[0], layers}, {SQUARE_GROUP, SQUARE_GROUP, 1});
  reduce_program_.set("resolution", maps.resolution(light));
  reduce_program_.set("layer_count", layers);
  reduce_program_.use();
  for (size_t level = 2; level <= sizes.size(); ++level) {
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    reduce_program_.set("level", int(level));
    gl::dispatch({sizes[level - 1], sizes[level - 1], layers}, {SQUARE_GROUP, SQUARE_GROUP, 1});
  }
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
}

size_t VirtualLights::bytes() const { return list_.buffer.bytes() + samples_.bytes() + pyramid_.bytes(); }

}  // namespace volgi::screen
