#include "core/camera.h"

#include <algorithm>
#include <cmath>

namespace volgi {
namespace {

struct Distances {
  float nearest;  // to the box, 0 inside
  float farthest;
};

Distances distances_to_box(glm::vec3 point, glm::vec3 bounds_min, glm::vec3 bounds_max) {
  const glm::vec3 outside = glm::max(glm::max(bounds_min - point, point - bounds_max), glm::vec3(0.0f));
  const glm::vec3 far_side = glm::max(glm::abs(bounds_min - point), glm::abs(bounds_max - point));
  return {glm::length(outside), glm::length(far_side)};
}

/// Picture plane at distance 1 (perspective) or in metres (orthographic): half its width and height.
glm::vec2 half_extent(const Camera& camera, glm::ivec2 size) {
  const float half_height = camera.kind == Camera::Kind::perspective ? std::tan(0.5f * camera.yfov_rad) : camera.ymag;
  return {half_height * float(size.x) / float(size.y), half_height};
}

}  // namespace

CameraRay camera_ray(const Camera& camera, glm::vec2 pixel_position, glm::ivec2 size) {
  const glm::vec2 extent = half_extent(camera, size);
  const glm::vec2 plane((2.0f * pixel_position.x / float(size.x) - 1.0f) * extent.x,
                        (1.0f - 2.0f * pixel_position.y / float(size.y)) * extent.y);
  const glm::mat3 axes(camera.world_from_camera);
  const glm::vec3 eye(camera.world_from_camera[3]);
  if (camera.kind == Camera::Kind::perspective) return {eye, glm::normalize(axes * glm::vec3(plane, -1.0f))};
  return {eye + axes * glm::vec3(plane, 0.0f), glm::normalize(-axes[2])};
}

glm::mat4 clip_from_camera(const Camera& camera, glm::ivec2 size) {
  const glm::vec2 extent = half_extent(camera, size);
  const float n = camera.znear;
  const float f = camera.zfar;
  glm::mat4 clip(0.0f);
  clip[0][0] = 1.0f / extent.x;
  clip[1][1] = 1.0f / extent.y;
  if (camera.kind == Camera::Kind::perspective) {
    clip[2][2] = n / (f - n);
    clip[3][2] = f * n / (f - n);
    clip[2][3] = -1.0f;
  } else {
    clip[2][2] = 1.0f / (f - n);
    clip[3][2] = f / (f - n);
    clip[3][3] = 1.0f;
  }
  return clip;
}

glm::mat4 camera_from_world(const Camera& camera) {
  return glm::mat4(glm::inverse(glm::dmat4(camera.world_from_camera)));
}

Camera look_at_camera(glm::vec3 eye, glm::vec3 target, float yfov_rad, glm::vec3 bounds_min, glm::vec3 bounds_max) {
  Camera camera;
  camera.name = "look at";
  camera.yfov_rad = yfov_rad;

  const glm::vec3 towards_eye = eye - target;
  const float distance = glm::length(towards_eye);
  const glm::vec3 back = distance > 0.0f ? towards_eye / distance : glm::vec3(0.0f, 0.0f, 1.0f);
  // Straight up or down +Y is no guide; north (-Z) is then at the top of the picture.
  const glm::vec3 up = std::abs(back.y) < 0.9999f ? glm::vec3(0.0f, 1.0f, 0.0f) : glm::vec3(0.0f, 0.0f, -1.0f);
  const glm::vec3 right = glm::normalize(glm::cross(up, back));
  camera.world_from_camera = glm::mat4(glm::vec4(right, 0.0f), glm::vec4(glm::cross(back, right), 0.0f),
                                       glm::vec4(back, 0.0f), glm::vec4(eye, 1.0f));

  const Distances box = distances_to_box(eye, bounds_min, bounds_max);
  camera.zfar = std::max({1.01f * box.farthest, 2.0f * distance, 1e-6f});
  camera.znear = std::max(0.5f * box.nearest, 1e-4f * camera.zfar);
  return camera;
}

Camera framing_camera(glm::vec3 bounds_min, glm::vec3 bounds_max) {
  constexpr float yfov_rad = 0.698131701f;  // 40 degrees
  const glm::vec3 centre = 0.5f * (bounds_min + bounds_max);
  const float half_diagonal = 0.5f * glm::length(bounds_max - bounds_min);
  const float radius = half_diagonal > 0.0f ? half_diagonal : 1.0f;
  const glm::vec3 towards_eye = glm::normalize(glm::vec3(0.5f, 0.4f, 1.0f));
  const float distance = 1.02f * radius / std::sin(0.5f * yfov_rad);  // the box's sphere fits a square picture
  Camera camera = look_at_camera(centre + distance * towards_eye, centre, yfov_rad, bounds_min, bounds_max);
  camera.name = "framing";
  return camera;
}

}  // namespace volgi
