#pragma once
// Direct light by rays against every triangle, in double: what the screen passes must agree with.
#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "core/camera.h"
#include "core/scene.h"
#include "core/surface.h"

namespace volgi::test {

struct Hit {
  size_t mesh;
  std::uint32_t triangle;
  double distance;
  SurfacePoint point;
};

/// Nearest triangle along a ray, passing through where alpha is 0.
inline std::optional<Hit> trace(const Scene& scene, glm::dvec3 origin, glm::dvec3 direction, double from, double to) {
  std::optional<Hit> best;
  for (size_t m = 0; m < scene.meshes.size(); ++m) {
    const Mesh& mesh = scene.meshes[m];
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      const glm::dvec3 a(mesh.positions[mesh.triangles[t].x]);
      const glm::dvec3 ab = glm::dvec3(mesh.positions[mesh.triangles[t].y]) - a;
      const glm::dvec3 ac = glm::dvec3(mesh.positions[mesh.triangles[t].z]) - a;
      const glm::dvec3 p = glm::cross(direction, ac);
      const double determinant = glm::dot(ab, p);
      if (determinant == 0.0) continue;
      const glm::dvec3 s = origin - a;
      const double u = glm::dot(s, p) / determinant;
      const glm::dvec3 q = glm::cross(s, ab);
      const double v = glm::dot(direction, q) / determinant;
      const double distance = glm::dot(ac, q) / determinant;
      if (u < 0.0 || v < 0.0 || u + v > 1.0 || distance <= from || distance >= (best ? best->distance : to)) continue;
      const SurfacePoint point = surface_point(scene, mesh, t, float(u), float(v));
      if (point.alpha > 0.0f) best = Hit{m, t, distance, point};
    }
  }
  return best;
}

/// Perpendicular irradiance by the formulas of KHR_lights_punctual, and the way to the light (length: its distance).
inline glm::dvec3 irradiance_at(const Light& light, glm::dvec3 position, glm::dvec3& to_light) {
  const glm::dvec3 intensity(light.intensity);
  if (light.type == Light::Type::directional) {
    to_light = -1e6 * glm::dvec3(light.direction);
    return intensity;
  }
  to_light = glm::dvec3(light.position) - position;
  const double squared = glm::dot(to_light, to_light);
  double falloff = 1.0;
  if (light.type == Light::Type::spot) {
    const double cosine = -glm::dot(to_light, glm::dvec3(light.direction)) / std::sqrt(squared);
    const double outer = std::cos(double(light.outer_cone_rad));
    const double scale = 1.0 / std::max(0.001, std::cos(double(light.inner_cone_rad)) - outer);
    falloff = std::pow(std::clamp((cosine - outer) * scale, 0.0, 1.0), 2.0);
  }
  return intensity * falloff / squared;
}

struct TruePixel {
  bool hit = false;
  size_t mesh = 0;
  SurfacePoint point{};
  glm::dvec3 radiance{0.0};
  unsigned lit = 0;  // bit per light
};

inline TruePixel true_pixel(const Scene& scene, const Camera& camera, glm::vec2 at, glm::ivec2 size) {
  TruePixel pixel;
  const CameraRay ray = camera_ray(camera, at, size);
  const auto hit = trace(scene, ray.origin, ray.direction, 0.0, 1e30);
  if (!hit) return pixel;
  pixel.hit = true;
  pixel.mesh = hit->mesh;
  pixel.point = hit->point;
  const glm::dvec3 position = glm::dvec3(ray.origin) + hit->distance * glm::dvec3(ray.direction);
  const bool front = glm::dot(pixel.point.geometric_normal, ray.direction) < 0.0f;
  const glm::dvec3 geometric = glm::dvec3(pixel.point.geometric_normal) * (front ? 1.0 : -1.0);
  glm::dvec3 shading(pixel.point.shading_normal);
  if (glm::dot(shading, geometric) < 0.0) shading = -shading;
  for (size_t i = 0; i < scene.lights.size(); ++i) {
    glm::dvec3 to_light;
    const glm::dvec3 irradiance = irradiance_at(scene.lights[i], position, to_light);
    const double cosine = glm::dot(shading, glm::normalize(to_light));
    if (cosine <= 0.0 || glm::dot(geometric, to_light) <= 0.0 || irradiance == glm::dvec3(0.0)) continue;
    // The step off the surface must outgrow the rounding of float vertices only.
    const double step = 1e-6 * hit->distance;
    if (trace(scene, position + step * geometric, to_light, 0.0, 1.0)) continue;
    pixel.lit |= 1u << i;
    pixel.radiance += glm::dvec3(pixel.point.albedo) / 3.141592653589793 * irradiance * cosine;
  }
  return pixel;
}

struct TruePicture {
  glm::ivec2 size;
  std::vector<TruePixel> pixels;
  const TruePixel& at(int x, int y) const { return pixels[size_t(y) * size_t(size.x) + size_t(x)]; }

  /// No edge of a surface or of a shadow within `reach` pixels: there a picture must be exact.
  bool smooth_around(int x, int y, int reach) const {
    const TruePixel& p = at(x, y);
    for (int v = std::max(0, y - reach); v <= std::min(size.y - 1, y + reach); ++v) {
      for (int u = std::max(0, x - reach); u <= std::min(size.x - 1, x + reach); ++u) {
        const TruePixel& q = at(u, v);
        if (q.hit != p.hit || q.mesh != p.mesh || q.lit != p.lit) return false;
        if (p.hit && glm::dot(q.point.shading_normal, p.point.shading_normal) < 0.9f) return false;
      }
    }
    return true;
  }
};

inline TruePicture true_picture(const Scene& scene, const Camera& camera, glm::ivec2 size) {
  TruePicture picture{size, {}};
  for (int y = 0; y < size.y; ++y) {
    for (int x = 0; x < size.x; ++x) {
      picture.pixels.push_back(true_pixel(scene, camera, glm::vec2(x, y) + 0.5f, size));
    }
  }
  return picture;
}

}  // namespace volgi::test
