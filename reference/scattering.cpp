#include "reference/scattering.h"

#include <algorithm>
#include <cmath>

namespace volgi {
namespace {

constexpr float kPi = 3.14159265358979f;
constexpr float kLeastAlpha = 1e-3f;   // a mirror's highlight would be a number that floats do not hold
constexpr float kLeastCosine = 1e-4f;  // of viewers below the shading normal's horizon

float largest(glm::vec3 c) { return std::max({c.x, c.y, c.z}); }

/// Duff et al. 2017, "Building an Orthonormal Basis, Revisited".
glm::mat3 around(glm::vec3 n) {
  const float sign = std::copysign(1.0f, n.z);
  const float a = -1.0f / (sign + n.z), b = n.x * n.y * a;
  return {{1.0f + sign * n.x * n.x * a, sign * b, -sign * n.x}, {b, sign + n.y * n.y * a, -n.y}, n};
}

/// Shirley and Chiu's concentric map keeps the strata of the square.
glm::vec2 on_disk(glm::vec2 xi) {
  const glm::vec2 p = 2.0f * xi - 1.0f;
  if (std::abs(p.x) > std::abs(p.y)) {
    const float angle = kPi / 4 * (p.y / p.x);
    return p.x * glm::vec2(std::cos(angle), std::sin(angle));
  }
  if (p.y == 0.0f) return glm::vec2(0.0f);
  const float angle = kPi / 2 - kPi / 4 * (p.x / p.y);
  return p.y * glm::vec2(std::cos(angle), std::sin(angle));
}

/// Smith's Lambda for GGX of a direction with this cosine.
float lambda(float cosine, float alpha) {
  const float squared = cosine * cosine;
  const float tangent_squared = std::max(1.0f - squared, 0.0f) / squared;
  return 0.5f * (std::sqrt(1.0f + alpha * alpha * tangent_squared) - 1.0f);
}

float ggx(float cos_half, float alpha) {
  const float a2 = alpha * alpha, d = cos_half * cos_half * (a2 - 1.0f) + 1.0f;
  return a2 / (kPi * d * d);
}

/// Heitz 2018, "Sampling the GGX Distribution of Visible Normals": in the frame whose z is the normal.
glm::vec3 visible_normal(glm::vec3 viewer, float alpha, glm::vec2 xi) {
  const glm::vec3 stretched = glm::normalize(glm::vec3(alpha * viewer.x, alpha * viewer.y, viewer.z));
  const glm::mat3 frame = around(stretched);
  glm::vec2 p = on_disk(xi);
  const float s = 0.5f * (1.0f + stretched.z);
  // The disk's y axis must point to where visible facets end: across the normal's own plane.
  const glm::vec3 up(0, 0, 1);
  glm::vec3 across = glm::cross(up, stretched);
  across = glm::dot(across, across) > 1e-12f ? glm::normalize(across) : frame[0];
  const glm::vec3 along = glm::cross(stretched, across);
  p.y = (1.0f - s) * std::sqrt(std::max(1.0f - p.x * p.x, 0.0f)) + s * p.y;
  const glm::vec3 h = p.x * across + p.y * along + std::sqrt(std::max(1.0f - glm::dot(p, p), 0.0f)) * stretched;
  return glm::normalize(glm::vec3(alpha * h.x, alpha * h.y, std::max(h.z, 1e-6f)));
}

/// (R.l)^n, R the viewer's mirror direction.
float to_power(glm::vec3 normal, glm::vec3 to_viewer, glm::vec3 to_light, float n) {
  return std::pow(glm::clamp(glm::dot(glm::reflect(-to_viewer, normal), to_light), 0.0f, 1.0f), n);
}

}  // namespace

Scattering::Scattering(const SurfacePoint& s)
    : diffuse_(s.diffuse),
      f0_(s.reflectance_0),
      f90_(s.reflectance_90),
      alpha_(std::max(s.roughness * s.roughness, kLeastAlpha)),
      exponent_(s.phong ? shared::phong_exponent(s.roughness) : -1.0f) {}

glm::vec3 Scattering::reflected(glm::vec3 normal, glm::vec3 to_viewer, glm::vec3 to_light) const {
  const float cos_light = glm::dot(normal, to_light);
  if (cos_light <= 0.0f) return glm::vec3(0.0f);
  if (!shines()) return diffuse_ * (cos_light / kPi);
  if (exponent_ >= 0.0f) {
    const glm::vec3 lobe = f0_ * ((exponent_ + 2.0f) / (2.0f * kPi) * to_power(normal, to_viewer, to_light, exponent_));
    return (diffuse_ * ((1.0f - largest(f0_)) / kPi) + lobe) * cos_light;
  }
  const float cos_viewer = std::max(glm::dot(normal, to_viewer), kLeastCosine);
  const glm::vec3 half = glm::normalize(to_viewer + to_light);
  const float cos_half = glm::clamp(glm::dot(normal, half), 0.0f, 1.0f);
  const float grazing = std::pow(std::max(1.0f - std::abs(glm::dot(to_viewer, half)), 0.0f), 5.0f);
  const glm::vec3 fresnel = f0_ + (glm::vec3(f90_) - f0_) * grazing;
  const float masking = 1.0f / (1.0f + lambda(cos_viewer, alpha_) + lambda(cos_light, alpha_));
  const glm::vec3 mirror = fresnel * (ggx(cos_half, alpha_) * masking / (4.0f * cos_viewer));
  return diffuse_ * ((1.0f - largest(fresnel)) * cos_light / kPi) + mirror;
}

float Scattering::mirror_share(glm::vec3 normal, glm::vec3 to_viewer) const {
  if (!shines()) return 0.0f;
  if (diffuse_ == glm::vec3(0.0f)) return 1.0f;
  const float grazing =
      exponent_ >= 0.0f ? 0.0f : std::pow(1.0f - glm::clamp(glm::dot(normal, to_viewer), 0.0f, 1.0f), 5.0f);
  const float mirror = largest(f0_) + (f90_ - largest(f0_)) * grazing;
  return std::clamp(mirror / (mirror + largest(diffuse_)), 0.1f, 0.9f);
}

float Scattering::pdf(glm::vec3 normal, glm::vec3 to_viewer, glm::vec3 to_light) const {
  const float cos_light = glm::dot(normal, to_light);
  if (cos_light <= 0.0f) return 0.0f;
  const float mirror = mirror_share(normal, to_viewer);
  float density = (1.0f - mirror) * cos_light / kPi;
  if (mirror > 0.0f && exponent_ >= 0.0f) {
    const float lobe = to_power(normal, to_viewer, to_light, exponent_);
    return density + mirror * (exponent_ + 1.0f) / (2.0f * kPi) * lobe;
  }
  if (mirror > 0.0f) {
    const float cos_viewer = std::max(glm::dot(normal, to_viewer), kLeastCosine);
    const float cos_half = glm::clamp(glm::dot(normal, glm::normalize(to_viewer + to_light)), 0.0f, 1.0f);
    density += mirror * ggx(cos_half, alpha_) / ((1.0f + lambda(cos_viewer, alpha_)) * 4.0f * cos_viewer);
  }
  return density;
}

glm::vec3 Scattering::sample(glm::vec3 normal, glm::vec3 to_viewer, glm::vec2 xi, float choice) const {
  const glm::mat3 frame = around(normal);
  if (choice >= mirror_share(normal, to_viewer)) {
    const glm::vec2 disk = on_disk(xi);
    const float z = std::sqrt(std::max(0.0f, 1.0f - glm::dot(disk, disk)));
    return glm::normalize(frame * glm::vec3(disk, z));
  }
  if (exponent_ >= 0.0f) {
    const float z = std::pow(xi.x, 1.0f / (exponent_ + 1.0f)), turn = 2.0f * kPi * xi.y;
    const float r = std::sqrt(std::max(0.0f, 1.0f - z * z));
    return glm::normalize(around(glm::reflect(-to_viewer, normal)) *
                          glm::vec3(r * std::cos(turn), r * std::sin(turn), z));
  }
  glm::vec3 viewer = glm::transpose(frame) * to_viewer;
  viewer.z = std::max(viewer.z, kLeastCosine);
  viewer = glm::normalize(viewer);
  const glm::vec3 half = visible_normal(viewer, alpha_, xi);
  return glm::normalize(frame * (2.0f * glm::dot(viewer, half) * half - viewer));
}

}  // namespace volgi
