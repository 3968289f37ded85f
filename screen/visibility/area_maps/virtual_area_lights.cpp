#include "screen/visibility/area_maps/virtual_area_lights.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <string>

#include "core/error.h"
#include "core/sample_sequence.h"
#include "shaders/screen/base/slots.shared.h"
#include "shaders/screen/visibility/area_maps/slots.shared.h"
#include "shaders/shared/group_sizes.shared.h"

namespace volgi::screen {
namespace {

constexpr int kListStep = LINEAR_GROUP;  // lists fill whole work groups
constexpr size_t kCenterBytes = 2 * sizeof(glm::vec4);

const VirtualAreaLightOptions& checked(const VirtualAreaLightOptions& options) {
  if (options.count < 1 || options.count > MAX_VIRTUAL_AREA_LIGHTS) {
    throw Error(ExitCode::usage, std::to_string(options.count) + " area lights: the number must lie between 1 and " +
                                     std::to_string(MAX_VIRTUAL_AREA_LIGHTS));
  }
  for (const float weight : {options.position_weight, options.normal_weight, options.plane_weight}) {
    if (std::isfinite(weight) && weight >= 0.0f) continue;
    throw Error(ExitCode::usage, "weight " + std::to_string(weight) + " of area lights: must be finite and at least 0");
  }
  return options;
}

void wait_for_writes() { glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_UNIFORM_BARRIER_BIT); }

}  // namespace

VirtualAreaLights::VirtualAreaLights(const VirtualAreaLightOptions& options)
    : options_(checked(options)),
      area_lights_(MAX_VIRTUAL_AREA_LIGHTS * sizeof(shared::VirtualAreaLight)),
      centers_(MAX_VIRTUAL_AREA_LIGHTS * kCenterBytes),
      progress_((1 + kMaxIterations) * sizeof(GLuint)),
      seed_(gl::Program::compute("screen/visibility/area_maps/virtual_area_lights_seed.comp.glsl")),
      assign_(gl::Program::compute("screen/visibility/area_maps/virtual_area_lights_assign.comp.glsl")),
      update_(gl::Program::compute("screen/visibility/area_maps/virtual_area_lights_update.comp.glsl")),
      list_(gl::Program::compute("screen/visibility/area_maps/virtual_area_lights_list.comp.glsl")),
      shape_(gl::Program::compute("screen/visibility/area_maps/virtual_area_lights_shape.comp.glsl")) {
  area_lights_.clear();
  seed_.set("cluster_count", options_.count);
  seed_.set("max_iterations", kMaxIterations);
  assign_.set("weight_per_rad", options_.normal_weight / glm::pi<float>());
  list_.set("cluster_count", options_.count);
  shape_.set("at_mean", int(options_.position == VirtualAreaLightOptions::Position::mean));
}

void VirtualAreaLights::run(const VirtualLights& lights, float scene_diagonal_m, gl::PassTimer& timer) {
  run(lights.buffer(), lights.count(), scene_diagonal_m, timer);
}

void VirtualAreaLights::run(const gl::Buffer& lights, int count, float scene_diagonal_m, gl::PassTimer& timer,
                            int sample) {
  assert(count >= 0 && lights.bytes() >= size_t(count) * sizeof(shared::VirtualLight));
  const auto scope = timer.scope(name);
  const size_t list_bytes = size_t((count + kListStep - 1) / kListStep) * kListStep * sizeof(GLuint);
  if (cluster_of_.id() == 0 || cluster_of_.bytes() < list_bytes) {
    cluster_of_ = gl::Buffer(list_bytes);
    order_ = gl::Buffer(list_bytes);
  }
  lights.bind_storage(VIRTUAL_LIGHTS_SLOT);
  cluster_of_.bind_storage(MADE_CLUSTER_OF_SLOT);
  centers_.bind_storage(CENTERS_SLOT);
  centers_.bind_uniform(CENTERS_BLOCK);
  progress_.bind_storage(PROGRESS_SLOT);
  area_lights_.bind_storage(MADE_AREA_LIGHTS_SLOT);
  order_.bind_storage(MADE_ORDER_SLOT);
  for (const gl::Program* program : {&seed_, &assign_, &update_, &list_}) program->set("light_count", count);
  const float diagonal_m = std::max(scene_diagonal_m, 1e-30f);
  assign_.set("weight_per_m", options_.position_weight / diagonal_m);
  assign_.set("weight_off_plane_per_m", options_.plane_weight / diagonal_m);

  seed_.use();
  gl::dispatch({1, 1, 1}, {1, 1, 1});
  wait_for_writes();
  for (int iteration = 0; iteration < kMaxIterations && count > 0; ++iteration) {
    if (iteration > 0) {
      update_.use();
      update_.set("iteration", iteration - 1);
      gl::dispatch({options_.count, 1, 1}, {1, 1, 1});
      wait_for_writes();
    }
    assign_.use();
    assign_.set("iteration", iteration);
    gl::dispatch_linear(size_t(count), kListStep);
    wait_for_writes();
  }
  list_.use();
  gl::dispatch({options_.count + 1, 1, 1}, {1, 1, 1});
  wait_for_writes();
  shape_.set("any_light", sample > 0 ? 1 : 0);
  shape_.set("which_light", float(sample_shift(SampleChoice::seen_from, std::uint64_t(sample))));
  shape_.use();
  gl::dispatch({options_.count, 1, 1}, {1, 1, 1});
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_UNIFORM_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
}

std::vector<shared::VirtualAreaLight> VirtualAreaLights::download() const {
  return area_lights_.download<shared::VirtualAreaLight>(size_t(options_.count));
}

int VirtualAreaLights::alive() const {
  const auto lights = download();
  return int(std::count_if(lights.begin(), lights.end(), [](const auto& l) { return l.light_count > 0; }));
}

int VirtualAreaLights::iterations() const {
  const auto moved = progress_.download<GLuint>(kMaxIterations, sizeof(GLuint));
  return int(std::count(moved.begin(), moved.end(), 1u));
}

size_t VirtualAreaLights::bytes() const {
  return area_lights_.bytes() + cluster_of_.bytes() + order_.bytes() + centers_.bytes() + progress_.bytes();
}

}  // namespace volgi::screen
