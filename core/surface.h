#pragma once
#include <glm/glm.hpp>

#include "core/scene.h"
#include "shaders/shared/material.shared.h"

namespace volgi {

/// What a point of a triangle is made of. Normals point to the triangle's front side.
struct SurfacePoint {
  glm::vec3 position;
  glm::vec3 geometric_normal;  // unit; zero for a triangle without area
  glm::vec3 shading_normal;    // unit, interpolated
  glm::vec3 albedo;            // of all that it reflects, as if diffuse (shared::surface_albedo), linear, in [0,1]
  // Its parts, glTF 2.0 appendix B: the diffuse part, and what a mirror of facets reflects from in front and at grazing
  // angles (none: 0).
  glm::vec3 diffuse;
  glm::vec3 reflectance_0;
  float reflectance_90;
  float roughness;     // perceptual: its square is GGX's alpha
  bool phong;          // a Phong lobe of shared::phong_exponent() in place of GGX
  float alpha;         // 1 when opaque; 0 or 1 for MASK; coverage for BLEND; of glass, what it stops
  glm::vec3 tint;      // what light that the surface does not stop is coloured by: 1, but for glass
  glm::vec3 unlit;     // radiance that the camera alone sees
  glm::vec3 emission;  // radiance sent to the front side (both sides when the material is double-sided)
};

/// Point with barycentric weights (1-u-v, u, v) of triangle `triangle` of `mesh`. Textures are sampled bilinearly (or
/// nearest as the sampler says) at level 0. CPU twin of shaders/shared/material.glsl.
SurfacePoint surface_point(const Scene& scene, const Mesh& mesh, std::uint32_t triangle, float u, float v);

/// @param base  baseColor · COLOR_0. @param metallic  factor times texture.
shared::Reflectance reflectance_of(const Material& material, glm::vec3 base, float metallic);

/// RGBA in linear light at texture coordinate uv (after uv_from_texcoord); `srgb` decodes RGB.
glm::vec4 sample_texture(const Scene& scene, int texture, glm::vec2 uv, bool srgb);

/// Whether some material of the scene is not Lambertian.
bool shines(const Scene& scene);

/// Whether what shines does so by Phong lobes (--materials phong).
bool has_phong_lobes(const Scene& scene);

/// Largest albedo component that any point of the scene can have (factors, vertex colours and texture maxima).
float largest_albedo(const Scene& scene);

}  // namespace volgi
