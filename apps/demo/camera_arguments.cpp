#include "apps/demo/camera_arguments.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <glm/gtc/constants.hpp>

namespace volgi::demo {
namespace {

constexpr float LEAST_YFOV_DEG = 0.1f, MOST_YFOV_DEG = 179.0f;  // of --yfov
constexpr float SAME_AXES = 1e-5f;                              // 0.0006 degrees

glm::vec3 forward_of(const Camera& camera) { return -glm::normalize(glm::vec3(camera.world_from_camera[2])); }

double parsed(const std::string& text) {
  double value = 0.0;
  std::from_chars(text.data(), text.data() + text.size(), value);
  return value;
}

/// The number of fewest digits near `exact` that `is_same` takes; with 17 it is that itself.
template <class IsSame>
std::string shortest(double exact, IsSame is_same) {
  for (int digits = 1; digits < 17; ++digits) {
    const double rounded = parsed(fmt::format("{:.{}g}", exact, digits));
    if (is_same(rounded)) return fmt::format("{}", rounded);
  }
  return fmt::format("{}", exact);
}

std::string point_text(glm::vec3 point, glm::dvec3 world_origin) {
  std::string text;
  for (int k = 0; k < 3; ++k) {
    const auto is_same = [&](double world) { return float(world - world_origin[k]) == point[k]; };
    text += (k == 0 ? "" : ",") + shortest(double(point[k]) + world_origin[k], is_same);
  }
  return text;
}

}  // namespace

namespace {

glm::vec3 target_of(const Camera& camera, const Scene& scene) {
  const glm::vec3 eye(camera.world_from_camera[3]);
  // As far as may be, for the direction's digits: look_at_camera() moves the far plane out to twice that.
  const glm::vec3 farthest = glm::max(glm::abs(scene.bounds_min - eye), glm::abs(scene.bounds_max - eye));
  const float distance = 0.5f * glm::length(farthest);
  return eye + (distance > 0.0f ? distance : 1.0f) * forward_of(camera);
}

}  // namespace

Camera camera_of_arguments(const Camera& camera, const Scene& scene) {
  if (!as_arguments_exact(camera)) return camera;
  Camera made = look_at_camera(glm::vec3(camera.world_from_camera[3]), target_of(camera, scene), camera.yfov_rad,
                               scene.bounds_min, scene.bounds_max);
  made.name = camera.name;
  return made;
}

std::string camera_arguments(const Camera& camera, const Scene& scene) {
  const glm::vec3 eye(camera.world_from_camera[3]);
  const glm::vec3 target = target_of(camera, scene);
  const auto is_same = [&](double degrees) { return float(glm::radians(degrees)) == camera.yfov_rad; };
  return fmt::format("--eye {} --target {} --yfov {}", point_text(eye, scene.world_origin),
                     point_text(target, scene.world_origin), shortest(glm::degrees(double(camera.yfov_rad)), is_same));
}

bool as_arguments_exact(const Camera& camera) {
  if (camera.kind != Camera::Kind::perspective) return false;
  const float yfov_deg = glm::degrees(camera.yfov_rad);
  if (yfov_deg < LEAST_YFOV_DEG || yfov_deg > MOST_YFOV_DEG) return false;
  const Camera made =
      look_at_camera(glm::vec3(0.0f), forward_of(camera), camera.yfov_rad, glm::vec3(-1.0f), glm::vec3(1.0f));
  for (int k = 0; k < 3; ++k) {
    const glm::vec3 axis = glm::normalize(glm::vec3(camera.world_from_camera[k]));
    if (glm::distance(axis, glm::vec3(made.world_from_camera[k])) > SAME_AXES) return false;
  }
  return true;
}

}  // namespace volgi::demo
