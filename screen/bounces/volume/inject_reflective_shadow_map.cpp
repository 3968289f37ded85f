#include "screen/bounces/volume/inject_reflective_shadow_map.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "shaders/shared/group_sizes.shared.h"

namespace volgi::screen {

namespace {

/// No light sends more than this into its map [W], largest band, up to what few texels get wrong: the fixed-point sums
/// are shares of it.
float largest_power(const Light& light, glm::vec3 bounds_min, glm::vec3 bounds_max) {
  float intensity = std::max({light.intensity.x, light.intensity.y, light.intensity.z});
  // A sun's layer covers the bounds seen from any direction: at most the square on their diagonal, with some margin.
  if (light.type == Light::Type::directional) {
    glm::vec3 d = bounds_max - bounds_min;
    return 2.0f * intensity * glm::dot(d, d);
  }
  // Of a cone: 2 pi (1 - cos) without its cancellation.
  const float half_angle = light.type == Light::Type::spot ? light.outer_cone_rad : glm::pi<float>();
  const float s = std::sin(0.5f * half_angle);
  return 4.0f * glm::pi<float>() * s * s * intensity;
}

}  // namespace

InjectReflectiveShadowMap::InjectReflectiveShadowMap()
    : program_(gl::Program::compute("screen/bounces/volume/inject_reflective_shadow_map.comp.glsl")) {}

void InjectReflectiveShadowMap::run(const VoxelGridGl& voxels, const ReflectiveShadowMap& maps, const Scene& scene,
                                    SideFluxGl& flux, gl::PassTimer& timer) {
  if (maps.light_count() == 0) return;
  auto scope = timer.scope(name);
  for (int light = 0; light < maps.light_count(); ++light) {
    flux.begin_source(voxels, program_, largest_power(scene.lights[size_t(light)], scene.bounds_min, scene.bounds_max));
    maps.bind(light);
    program_.use();
    program_.set("light", light);
    program_.set("resolution", maps.resolution(light));
    int threads = (maps.resolution(light) + 3) / 4;
    gl::dispatch({threads, threads, maps.layer_count(light)}, {SQUARE_GROUP, SQUARE_GROUP, 1});
    flux.collect(voxels, flux.punctual());
  }
}

}  // namespace volgi::screen
