#include "screen/lights/lattice/wave_lattice.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <string>

#include "core/error.h"
#include "core/light_cone.h"
#include "core/surface_points.h"
#include "screen/lights/rsm/virtual_lights.h"
#include "shaders/screen/lights/lattice/slots.shared.h"
#include "shaders/shared/group_sizes.shared.h"

namespace volgi::screen {
namespace {

using Options = WaveLatticeOptions;

/// Over points spread evenly by area. A few hundred know a mean albedo to a percent or two.
glm::vec3 mean_albedo(const Scene& scene) {
  constexpr int points = 1024;
  glm::dvec3 sum(0.0);
  double area_m2 = 0.0;
  for (const SurfaceSample& p : surface_points(scene, points)) {
    sum += double(p.area_m2) * glm::dvec3(p.albedo);
    area_m2 += double(p.area_m2);
  }
  return area_m2 > 0.0 ? glm::vec3(sum / area_m2) : glm::vec3(0.0f);
}

glm::dvec3 axis_of(const Light& light) {
  return light.type == Light::Type::spot ? glm::dvec3(light.direction) : glm::dvec3(0.0, -1.0, 0.0);
}

}  // namespace

LatticeSize lattice_size(Light::Type type, float angle_deg, int shells) {
  const double angle = double(angle_deg);
  const int quarter = std::max(int(std::lround(90.0 / angle)), 1);
  LatticeSize size;
  size.about = std::max(int(std::lround(360.0 / angle)), 1);
  size.along = quarter;
  size.step_rad = float(0.5 * glm::pi<double>() / quarter);
  size.rays = 1 + size.about * quarter;
  if (type == Light::Type::point) {
    size.along = 2 * quarter - 1;
    size.rays = 2 + size.about * size.along;
  } else if (type == Light::Type::directional) {
    size.across = std::max(int(std::lround(std::sqrt(double(size.rays)))), 1);
    size.rays = size.across * size.across;
  }
  size.lights = size.rays * shells;
  return size;
}

std::vector<int> lattice_lights_on(int count, float share, int seed) {
  // Steps of the golden ratio put any run of lights evenly into [0, 1); seeds turn all of it by even steps of another.
  constexpr double golden = 0.6180339887498949, of_seeds = 0.7548776662466927;
  std::vector<int> on;
  for (int i = 0; i < count; ++i) {
    if (glm::fract(double(i) * golden + glm::fract(double(seed) * of_seeds)) < double(share)) on.push_back(i);
  }
  return on;
}

WaveLattice::WaveLattice(const Scene& scene, const WaveLatticeOptions& options, std::optional<int> bounces)
    : scene_(scene),
      options_(options),
      bounces_(bounces),
      surface_albedo_(mean_albedo(scene)),
      sums_(LATTICE_GROUPS * sizeof(shared::LatticeSums)),
      farthest_program_(gl::Program::compute("screen/lights/lattice/lattice_sums.comp.glsl", {"FARTHEST"})),
      sums_program_(gl::Program::compute("screen/lights/lattice/lattice_sums.comp.glsl")),
      lights_program_(gl::Program::compute("screen/lights/lattice/wave_lattice.comp.glsl")) {
  lay_out();
}

void WaveLattice::scene_moved() { surface_albedo_ = mean_albedo(scene_); }

/// Which lights there are, unless primary lights are of the kinds that they were.
void WaveLattice::lay_out() {
  std::vector<Light::Type> types;
  for (const Light& light : scene_.lights) types.push_back(light.type);
  if (list_.buffer.id() != 0 && types == types_) return;
  std::vector<int> on;
  list_.of_light.clear();
  for (const Light::Type type : types) {
    const LatticeSize size = lattice_size(type, options_.angle_deg, options_.shells);
    if (size.lights > VirtualLightOptions::kMaxCount) {
      throw Error(ExitCode::over_limit, fmt::format("a lattice of {} lights: more than {}; ask for larger angles "
                                                    "(lattice.angle) or fewer shells (lattice.shells)",
                                                    size.lights, VirtualLightOptions::kMaxCount));
    }
    const std::vector<int> of_light = lattice_lights_on(size.lights, options_.on_percent / 100.0f, options_.seed);
    list_.of_light.push_back(int(of_light.size()));
    on.insert(on.end(), of_light.begin(), of_light.end());
    if (on.size() > size_t(VirtualLightOptions::kMaxCount)) {
      throw Error(ExitCode::over_limit,
                  fmt::format("the lattices of {} lights have more than {} lights that are on; turn some off "
                              "(lattice.on) or ask for larger angles (lattice.angle)",
                              types.size(), VirtualLightOptions::kMaxCount));
    }
  }
  types_ = std::move(types);
  list_.reflected = int(on.size());
  list_.emitted = 0;
  list_.in_the_air = true;
  if (on.empty()) on.push_back(0);
  gl::put(on_, on);
  list_.buffer = gl::Buffer(std::vector<shared::VirtualLight>(padded_count(list_)));
}

void WaveLattice::run(const ReflectiveShadowMap& maps, gl::PassTimer& timer) {
  assert(maps.light_count() == int(scene_.lights.size()));
  const auto scope = timer.scope(name);
  lay_out();
  int first = 0;
  for (int light = 0; light < maps.light_count(); ++light) {
    if (list_.of_light[size_t(light)] == 0) continue;
    maps.bind(light);
    sums_.bind_storage(LATTICE_SUMS_SLOT);
    sum_light(light);
    make_lights(light, first);
    first += list_.of_light[size_t(light)];
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);  // the next light's sums take their place
  }
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_UNIFORM_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
}

void WaveLattice::set_shells(const gl::Program& program) const {
  program.set("shells", options_.shells);
  program.set("farthest_shell", options_.farthest);
  program.set("growth", options_.growth);
}

void WaveLattice::sum_light(int light) const {
  for (const gl::Program* program : {&farthest_program_, &sums_program_}) {
    program->set("light", light);
    set_shells(*program);
    program->use();
    glDispatchCompute(LATTICE_GROUPS, 1, 1);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
  }
}

void WaveLattice::make_lights(int light, int first) const {
  const Light& of = scene_.lights[size_t(light)];
  const LatticeSize size = lattice_size(of.type, options_.angle_deg, options_.shells);
  const gl::Program& p = lights_program_;
  set_shells(p);
  p.set("light", light);
  p.set("first", first);
  p.set("first_on", first);
  p.set("count", list_.of_light[size_t(light)]);
  p.set("rays", size.rays);
  p.set("about_count", size.about);
  p.set("step", size.step_rad);
  p.set("across", std::max(size.across, 1));
  p.set("world_from_axis", world_from_axis(axis_of(of)));
  p.set("attenuation", options_.attenuation);
  p.set("depth_by_ray", options_.depth == Options::Depth::ray ? 1 : 0);
  p.set("conserving", options_.power == Options::Power::conserving ? 1 : 0);
  p.set("on_share", options_.on_percent / 100.0f);
  p.set("surface_albedo", surface_albedo_);
  p.set("later_bounces", bounces_ ? std::max(*bounces_ - 1, 0) : -1);
  for (size_t k = 0; k < options_.factor.size(); ++k) p.set(fmt::format("factor[{}]", k).c_str(), options_.factor[k]);
  list_.buffer.bind_storage(LATTICE_LIGHTS_SLOT);
  on_.bind_storage(LATTICE_ON_SLOT);
  p.use();
  gl::dispatch_linear(size_t(list_.of_light[size_t(light)]), LINEAR_GROUP);
}

}  // namespace volgi::screen
