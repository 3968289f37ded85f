// Where the layers of a reflective shadow map look.
#include "core/light_layers.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace volgi {
namespace {

using shared::ReflectiveShadowLayer;

/// Makes room for the margin: the light's own cone, face or bounds end RSM_MARGIN_TEXELS before the layer does.
float margin_factor(int resolution) { return float(resolution) / float(resolution - 2 * RSM_MARGIN_TEXELS); }

void set_axes(ReflectiveShadowLayer& layer, glm::vec3 forward) {
  const glm::vec3 helper = std::abs(forward.y) < 0.9f ? glm::vec3(0, 1, 0) : glm::vec3(1, 0, 0);
  layer.forward = forward;
  layer.right = glm::normalize(glm::cross(forward, helper));
  layer.up = glm::cross(layer.right, forward);
}

/// Rows of clip_from_world, from the four linear functions of position that clip coordinates are.
glm::mat4 matrix_from_rows(glm::vec4 x, glm::vec4 y, glm::vec4 z, glm::vec4 w) {
  return glm::transpose(glm::mat4(x, y, z, w));
}

glm::vec4 plane(glm::vec3 axis, glm::vec3 origin) {
  return {axis, float(-glm::dot(glm::dvec3(axis), glm::dvec3(origin)))};
}

ReflectiveShadowLayer perspective_layer(glm::vec3 origin, glm::vec3 forward, float extent, float near_m) {
  ReflectiveShadowLayer layer{};
  set_axes(layer, forward);
  layer.origin = origin;
  layer.depth_scale_m = near_m;
  layer.extent_x = layer.extent_y = extent;
  layer.clip_from_world = matrix_from_rows(plane(layer.right, origin) / extent, plane(layer.up, origin) / extent,
                                           {0, 0, 0, near_m}, plane(forward, origin));
  return layer;
}

/// Half of what a box is wide along an axis. A flat or empty one still gets some.
float half_width(const SceneBox& box, glm::vec3 axis) {
  const glm::vec3 half = 0.5f * (box.max - box.min);
  const float least = std::max({1e-3f * glm::length(half), 1e-6f * glm::length(box.middle()), 1e-20f});
  return std::max(glm::dot(glm::abs(axis), half), least);
}

/// As wide as `across` is, and as deep as `all`.
ReflectiveShadowLayer directional_layer(glm::vec3 direction, int resolution, const SceneBox& across,
                                        const SceneBox& all) {
  ReflectiveShadowLayer layer{};
  set_axes(layer, direction);
  const glm::vec3 middle = across.middle();
  layer.extent_x = half_width(across, layer.right) * margin_factor(resolution);
  layer.extent_y = half_width(across, layer.up) * margin_factor(resolution);
  const float reach = half_width(all, direction) * 1.01f;  // nothing is clipped for a rounding error
  layer.origin = middle + (glm::dot(all.middle() - middle, direction) - reach) * direction;
  layer.depth_scale_m = 2.0f * reach;
  layer.directional = 1;
  const glm::vec4 z = plane(direction, layer.origin) / layer.depth_scale_m;
  layer.clip_from_world =
      matrix_from_rows(plane(layer.right, middle) / layer.extent_x, plane(layer.up, middle) / layer.extent_y,
                       glm::vec4(0, 0, 0, 1) - z, {0, 0, 0, 1});
  return layer;
}

constexpr float widest_single_spot_rad = 1.0471976f;  // 60 degrees: beyond it texels stretch by more than 8

}  // namespace

std::vector<ReflectiveShadowLayer> reflective_shadow_layers(const Light& light, int resolution, glm::vec3 bounds_min,
                                                            glm::vec3 bounds_max) {
  assert(resolution > 2 * RSM_MARGIN_TEXELS);
  if (light.type == Light::Type::directional) {
    const SceneBox bounds{bounds_min, bounds_max};
    return {directional_layer(light.direction, resolution, bounds, bounds)};
  }
  // Relative precision of depth is the same at all distances (no far plane), so the near plane may lie very close.
  const float near_m = std::max(1e-5f * glm::distance(bounds_min, bounds_max), 1e-20f);
  if (light.type == Light::Type::spot && light.outer_cone_rad <= widest_single_spot_rad) {
    const float extent = std::max(std::tan(light.outer_cone_rad), 1e-4f) * margin_factor(resolution);
    return {perspective_layer(light.position, light.direction, extent, near_m)};
  }
  std::vector<ReflectiveShadowLayer> faces;
  for (int face = 0; face < 6; ++face) {
    glm::vec3 forward(0.0f);
    forward[face / 2] = face % 2 == 0 ? 1.0f : -1.0f;
    faces.push_back(perspective_layer(light.position, forward, margin_factor(resolution), near_m));
  }
  return faces;
}

ReflectiveShadowLayer layer_across(glm::vec3 direction, int resolution, const SceneBox& across, const SceneBox& all) {
  assert(resolution > 2 * RSM_MARGIN_TEXELS);
  return directional_layer(direction, resolution, across, all);
}

}  // namespace volgi
