#include "apps/demo/camera_pose.h"

#include <cmath>

#include "apps/demo/camera_control.h"

namespace volgi::demo {
namespace {

constexpr double LEVEL = 1e-6;  // height of the unit axis to the right: a float's rounding is 6e-8

}  // namespace

CameraPose pose_of(const Camera& camera, const Scene& scene) {
  CameraPose pose;
  pose.position = glm::dvec3(camera.world_from_camera[3]) + scene.world_origin;
  const glm::dvec3 back = glm::normalize(glm::dvec3(camera.world_from_camera[2]));
  const glm::dvec3 right = glm::normalize(glm::cross(glm::dvec3(camera.world_from_camera[1]), back));
  pose.orientation = glm::normalize(glm::quat_cast(glm::dmat3(right, glm::cross(back, right), back)));
  pose.yfov_rad = camera.yfov_rad;
  if (camera.kind == Camera::Kind::orthographic) pose.ymag_m = camera.ymag;
  return pose;
}

Camera camera_of(const CameraPose& pose, const Scene& scene) {
  Camera camera;
  camera.yfov_rad = float(pose.yfov_rad);
  if (pose.ymag_m) {
    camera.kind = Camera::Kind::orthographic;
    camera.ymag = float(*pose.ymag_m);
  }
  camera.world_from_camera = glm::mat4(glm::mat4_cast(pose.orientation));
  camera.world_from_camera[3] = glm::vec4(glm::vec3(pose.position - scene.world_origin), 1.0f);
  return with_depth_of(camera, scene.bounds_min, scene.bounds_max);
}

glm::dquat levelled(const glm::dquat& orientation) {
  const glm::dvec3 back = orientation * glm::dvec3(0, 0, 1);
  const glm::dvec3 level = glm::cross(glm::dvec3(0, 1, 0), back);
  if (glm::length(level) < LEVEL) return orientation;  // straight up or down
  const glm::dvec3 right = glm::normalize(level);
  const glm::dquat out = glm::normalize(glm::quat_cast(glm::dmat3(right, glm::cross(back, right), back)));
  return glm::dot(out, orientation) < 0.0 ? -out : out;
}

bool is_level(const glm::dquat& orientation) {
  return std::abs((orientation * glm::dvec3(1, 0, 0)).y) < LEVEL && (orientation * glm::dvec3(0, 1, 0)).y > 0.0;
}

}  // namespace volgi::demo
