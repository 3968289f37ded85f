#pragma once
#include <glm/glm.hpp>

#include "core/scene.h"

namespace volgi {

/// What a point of a triangle is made of. Normals point to the triangle's front side.
struct SurfacePoint {
  glm::vec3 position;
  glm::vec3 geometric_normal;  // unit; zero for a triangle without area
  glm::vec3 shading_normal;    // unit, interpolated
  glm::vec3 albedo;            // shared::surface_albedo of baseColor · COLOR_0, linear, in [0,1]
  float alpha;                 // 1 when opaque; 0 or 1 for MASK; coverage for BLEND
  glm::vec3 emission;          // radiance sent to the front side (both sides when the material is double-sided)
};

/// Point with barycentric weights (1-u-v, u, v) of triangle `triangle` of `mesh`. Textures are sampled bilinearly (or
/// nearest as the sampler says) at level 0. CPU twin of shaders/shared/material.glsl.
SurfacePoint surface_point(const Scene& scene, const Mesh& mesh, std::uint32_t triangle, float u, float v);

/// RGBA in linear light at texture coordinate uv (after uv_from_texcoord); `srgb` decodes RGB.
glm::vec4 sample_texture(const Scene& scene, int texture, glm::vec2 uv, bool srgb);

/// Largest albedo component that any point of the scene can have (factors, vertex colours and texture maxima).
float largest_albedo(const Scene& scene);

}  // namespace volgi
