#include "screen/bounces/volume/largest_power.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "core/emitter_points.h"
#include "core/sky.h"

namespace volgi::screen {

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

float largest_reflected_power(const Scene& scene) {
  float sum = 0.0f;
  for (const Light& light : scene.lights) sum += largest_power(light, scene.bounds_min, scene.bounds_max);
  if (scene.sky != nullptr) {
    const glm::vec3 d = scene.bounds_max - scene.bounds_min;
    const glm::dvec3 sky = scene.sky->integral();
    sum +=
        float(std::max({sky.x, sky.y, sky.z})) * glm::dot(d, d);  // what enters the ball around the bounds is a pi-th
  }
  return sum;
}

float largest_emitted_power(const Scene& scene) {
  const glm::dvec3 flux = EmitterPoints(scene).flux();
  return 4.0f * float(std::max({flux.x, flux.y, flux.z}));
}

}  // namespace volgi::screen
