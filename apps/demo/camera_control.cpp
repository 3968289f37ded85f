#include "apps/demo/camera_control.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <glm/gtc/quaternion.hpp>

namespace volgi::demo {
namespace {

constexpr double VERTICAL = 1.0 - 1e-12;  // of the elevation's sine
constexpr double SPARE = 1.05;            // around a framed box
constexpr double LEAST_EXTENT = 1e-6;     // of a ymag, a distance or a depth range [m]

glm::dvec3 eye_of(const Camera& camera) { return glm::dvec3(camera.world_from_camera[3]); }

/// Right, up and back, of unit length and at right angles.
glm::dmat3 axes_of(const Camera& camera) {
  const glm::dvec3 back = glm::normalize(glm::dvec3(camera.world_from_camera[2]));
  const glm::dvec3 up(camera.world_from_camera[1]);
  const glm::dvec3 right = glm::normalize(glm::cross(up, back));
  return {right, glm::cross(back, right), back};
}

glm::dmat3 world_from_angles(const ViewAngles& a) {
  const auto about = [](double angle, glm::dvec3 axis) { return glm::mat3_cast(glm::angleAxis(angle, axis)); };
  return about(a.yaw_rad, {0, 1, 0}) * about(a.pitch_rad, {1, 0, 0}) * about(a.roll_rad, {0, 0, 1});
}

Camera placed(const Camera& camera, const glm::dmat3& axes, glm::dvec3 eye) {
  Camera out = camera;
  for (int k = 0; k < 3; ++k) out.world_from_camera[k] = glm::vec4(glm::vec3(axes[k]), 0.0f);
  out.world_from_camera[3] = glm::vec4(glm::vec3(eye), 1.0f);
  return out;
}

Camera moved_to(const Camera& camera, glm::dvec3 eye) {
  Camera out = camera;
  out.world_from_camera[3] = glm::vec4(glm::vec3(eye), 1.0f);
  return out;
}

ViewAngles turned(ViewAngles angles, double yaw_rad, double pitch_rad) {
  angles.yaw_rad += yaw_rad;
  const double steepest = std::max(STEEPEST_RAD, std::abs(angles.pitch_rad));
  angles.pitch_rad = std::clamp(angles.pitch_rad + pitch_rad, -steepest, steepest);
  return angles;
}

double half_height_at_1(const Camera& camera) { return std::tan(0.5 * double(camera.yfov_rad)); }

std::array<glm::dvec3, 8> corners(glm::dvec3 low, glm::dvec3 high) {
  std::array<glm::dvec3, 8> out;
  for (size_t i = 0; i < 8; ++i)
    out[i] = {(i & 1) != 0 ? high.x : low.x, (i & 2) != 0 ? high.y : low.y, (i & 4) != 0 ? high.z : low.z};
  return out;
}

/// Where along one axis of the picture, and how far back, a camera sees all of the points just so.
struct Place {
  double along, back;
};
Place place_for(const std::array<glm::dvec3, 8>& points, int axis, double slope) {
  double positive = -1e300, negative = -1e300;
  for (const glm::dvec3& p : points) {
    positive = std::max(positive, p[axis] + slope * p.z);
    negative = std::max(negative, -p[axis] + slope * p.z);
  }
  return {0.5 * (positive - negative), 0.5 * (positive + negative) / slope};
}

struct Interval {
  double low = 1e300, high = -1e300;
  double middle() const { return 0.5 * (low + high); }
  double half() const { return 0.5 * (high - low); }
};
Interval extent(const std::array<glm::dvec3, 8>& points, int axis) {
  Interval out;
  for (const glm::dvec3& p : points) {
    out.low = std::min(out.low, p[axis]);
    out.high = std::max(out.high, p[axis]);
  }
  return out;
}

}  // namespace

ViewAngles view_angles(const Camera& camera) {
  const glm::dmat3 axes = axes_of(camera);
  const glm::dvec3 right = axes[0], up = axes[1], back = axes[2];
  ViewAngles out;
  out.pitch_rad = std::asin(std::clamp(-back.y, -1.0, 1.0));
  if (std::abs(back.y) > VERTICAL) {
    out.yaw_rad = std::atan2(-right.z, right.x);
  } else {
    out.yaw_rad = std::atan2(back.x, back.z);
    out.roll_rad = std::atan2(right.y, up.y);
  }
  return out;
}

Camera with_angles(const Camera& camera, const ViewAngles& angles) {
  return placed(camera, world_from_angles(angles), eye_of(camera));
}

Camera orbited(const Camera& camera, glm::vec3 pivot, double yaw_rad, double pitch_rad) {
  const ViewAngles before = view_angles(camera);
  const glm::dmat3 axes = world_from_angles(turned(before, yaw_rad, pitch_rad));
  const glm::dvec3 middle(pivot);
  const glm::dvec3 from_pivot = glm::transpose(world_from_angles(before)) * (eye_of(camera) - middle);
  return placed(camera, axes, middle + axes * from_pivot);
}

Camera panned(const Camera& camera, glm::vec3 pivot, glm::vec2 drag, glm::ivec2 size) {
  assert(size.y > 0);
  const glm::dmat3 axes = axes_of(camera);
  double half_height = camera.ymag;
  if (camera.kind == Camera::Kind::perspective) {
    const glm::dvec3 to_pivot = glm::dvec3(pivot) - eye_of(camera);
    const double depth = -glm::dot(to_pivot, axes[2]);
    half_height = half_height_at_1(camera) * (depth > 0.0 ? depth : glm::length(to_pivot));
  }
  const double metres_per_pixel = 2.0 * half_height / double(size.y);
  const glm::dvec2 way = metres_per_pixel * glm::dvec2(drag);
  return moved_to(camera, eye_of(camera) - way.x * axes[0] + way.y * axes[1]);
}

Camera dollied(const Camera& camera, glm::vec3 pivot, double factor) {
  assert(factor > 0.0);
  const glm::dvec3 to_pivot = glm::dvec3(pivot) - eye_of(camera);
  if (camera.kind == Camera::Kind::perspective) {
    const double distance = glm::length(to_pivot);
    const double nearest = std::min(1.0, LEAST_EXTENT / std::max(distance, LEAST_EXTENT));
    return moved_to(camera, eye_of(camera) + (1.0 - std::max(factor, nearest)) * to_pivot);
  }
  const double ymag = std::max(double(camera.ymag) * factor, LEAST_EXTENT);
  const glm::dvec3 back = axes_of(camera)[2];
  const glm::dvec3 in_plane = to_pivot - glm::dot(to_pivot, back) * back;
  Camera out = moved_to(camera, eye_of(camera) + (1.0 - ymag / double(camera.ymag)) * in_plane);
  out.ymag = float(ymag);
  return out;
}

Camera flown(const Camera& camera, const Flight& flight, double seconds) {
  const glm::dvec3 way = seconds * glm::dvec3(flight.velocity_m_per_s);
  const glm::dvec3 eye = eye_of(camera) + axes_of(camera) * glm::dvec3(way.x, way.y, -way.z);
  return placed(camera, world_from_angles(turned(view_angles(camera), flight.yaw_rad, flight.pitch_rad)), eye);
}

Camera framed(const Camera& camera, glm::vec3 bounds_min, glm::vec3 bounds_max, double aspect) {
  assert(aspect > 0.0);
  const glm::dmat3 axes = axes_of(camera);
  const glm::dvec3 centre = 0.5 * (glm::dvec3(bounds_min) + glm::dvec3(bounds_max));
  glm::dvec3 half = 0.5 * (glm::dvec3(bounds_max) - glm::dvec3(bounds_min));
  if (glm::length(half) < LEAST_EXTENT) half = glm::dvec3(0.5);  // a point, or nothing
  std::array<glm::dvec3, 8> points = corners(-half, half);
  for (glm::dvec3& p : points) p = glm::transpose(axes) * p;
  Camera out = camera;
  glm::dvec3 eye;
  if (camera.kind == Camera::Kind::perspective) {
    const double slope = half_height_at_1(camera) / SPARE;
    const Place x = place_for(points, 0, slope * aspect), y = place_for(points, 1, slope);
    eye = {x.along, y.along, std::max(x.back, y.back)};
  } else {
    const Interval x = extent(points, 0), y = extent(points, 1);
    out.ymag = float(SPARE * std::max({y.half(), x.half() / aspect, LEAST_EXTENT}));
    eye = {x.middle(), y.middle(), extent(points, 2).high + glm::length(half)};
  }
  return with_depth_of(moved_to(out, centre + axes * eye), bounds_min, bounds_max);
}

Camera with_depth_of(const Camera& camera, glm::vec3 bounds_min, glm::vec3 bounds_max) {
  Camera out = camera;
  if (camera.kind == Camera::Kind::perspective) {
    const glm::vec3 eye(camera.world_from_camera[3]);
    const Camera fitted = look_at_camera(eye, eye, camera.yfov_rad, bounds_min, bounds_max);
    out.znear = fitted.znear;
    out.zfar = fitted.zfar;
    return out;
  }
  const glm::dmat3 axes = axes_of(camera);
  std::array<glm::dvec3, 8> points = corners(glm::dvec3(bounds_min), glm::dvec3(bounds_max));
  for (glm::dvec3& p : points) p = glm::transpose(axes) * (p - eye_of(camera));
  const Interval z = extent(points, 2);
  const double spare = 0.01 * std::max(z.high - z.low, std::abs(z.low));  // a flat box has no extent
  const double far_depth = std::max(spare - z.low, LEAST_EXTENT);
  out.zfar = float(far_depth);
  out.znear = float(std::max(-z.high - spare, 1e-4 * far_depth));
  return out;
}

float typical_speed_m_per_s(glm::vec3 bounds_min, glm::vec3 bounds_max) {
  const float diagonal = glm::distance(bounds_min, bounds_max);
  return diagonal > 0.0f ? 0.1f * diagonal : 0.1f;
}

Camera levelled(const Camera& camera) {
  ViewAngles angles = view_angles(camera);
  angles.roll_rad = 0.0;
  return with_angles(camera, angles);
}

}  // namespace volgi::demo
