// How the layers of a light's reflective shadow map look at the scene: 1 for a sun or a spot, 6 for a point light or a
// spot wider than 60 degrees from its axis. Faces of a cube are +x, -x, +y, -y, +z, -z.
#ifndef VOLGI_REFLECTIVE_SHADOW_MAP_SHARED_H
#define VOLGI_REFLECTIVE_SHADOW_MAP_SHARED_H
#include "shared/light.shared.h"
SHARED_BEGIN

// ReflectiveShadowMap::bind().
#define RSM_LIGHTS_SLOT 1
#define RSM_LAYERS_SLOT 2
#define RSM_DEPTH_UNIT 12
#define RSM_NORMAL_UNIT 13
#define RSM_ALBEDO_UNIT 14
#define RSM_TINT_UNIT 15  // where there is glass

// Texels around a layer that lie outside the light's cone, cube face or bounds, so that the four nearest texels of
// every lit point exist.
#define RSM_MARGIN_TEXELS 2

// std430, 80 bytes.
struct ReflectiveShadowLight {
  PunctualLight light;
  int first_layer;  // in the array of layers of all lights
  int layer_count;
  int resolution;  // texels on each side of a layer
  int pad0;
};

// std430, 128 bytes. Coordinates (u, v) of a layer run from -1 to 1, v up, as normalised device coordinates do.
// Perspective: position = origin + z (forward + u extent.x right + v extent.y up), depth = scale / z (reversed, no far
// plane: 32 bits of float then give the same relative precision at every distance).
// Directional: position = origin + z forward + u extent.x right + v extent.y up, depth = 1 - z / scale.
struct ReflectiveShadowLayer {
  mat4 clip_from_world;
  vec3 origin;
  float depth_scale_m;
  vec3 right;
  float extent_x;  // tangent of half the field of view; directional: half the width [m]
  vec3 up;
  float extent_y;
  vec3 forward;
  int directional;
};
#ifdef __cplusplus
static_assert(sizeof(ReflectiveShadowLight) == 80 && offsetof(ReflectiveShadowLight, first_layer) == 64);
static_assert(sizeof(ReflectiveShadowLayer) == 128 && offsetof(ReflectiveShadowLayer, origin) == 64);
#endif

// Layer of a light that sees what lies in `from_light`, of any length.
SHARED_FUNCTION int rsm_layer_of_direction(int layer_count, vec3 from_light) {
  if (layer_count == 1) return 0;
  vec3 a = abs(from_light);
  if (a.x >= a.y && a.x >= a.z) return from_light.x >= 0.0f ? 0 : 1;
  if (a.y >= a.z) return from_light.y >= 0.0f ? 2 : 3;
  return from_light.z >= 0.0f ? 4 : 5;
}

// (u, v) and z [m] of a point; z > 0 is in front of the light.
SHARED_FUNCTION vec3 rsm_uvz_from_position(ReflectiveShadowLayer layer, vec3 position) {
  vec3 d = position - layer.origin;
  float z = dot(d, layer.forward);
  float spread = layer.directional != 0 ? 1.0f : z;
  return vec3(dot(d, layer.right) / (layer.extent_x * spread), dot(d, layer.up) / (layer.extent_y * spread), z);
}

SHARED_FUNCTION vec3 rsm_position_from_uvz(ReflectiveShadowLayer layer, vec3 uvz) {
  vec3 across = layer.right * (uvz.x * layer.extent_x) + layer.up * (uvz.y * layer.extent_y);
  float spread = layer.directional != 0 ? 1.0f : uvz.z;
  return layer.origin + layer.forward * uvz.z + across * spread;
}

// Distance [m] along `forward` of what was drawn with `depth` > 0; 0 is the background.
SHARED_FUNCTION float rsm_z_from_depth(ReflectiveShadowLayer layer, float depth) {
  return layer.directional != 0 ? (1.0f - depth) * layer.depth_scale_m : layer.depth_scale_m / depth;
}

// Edge [m] of a texel at distance z, the longer one.
SHARED_FUNCTION float rsm_texel_size_m(ReflectiveShadowLayer layer, int resolution, float z) {
  float edge = 2.0f * max(layer.extent_x, layer.extent_y) / float(resolution);
  return layer.directional != 0 ? edge : edge * z;
}

// What a texel at (u, v) catches: its solid angle [sr] = dx dy cos^3, x and y on the plane at distance 1; for a
// directional light its area across the light [m^2].
SHARED_FUNCTION float rsm_texel_measure(ReflectiveShadowLayer layer, int resolution, float u, float v) {
  float edge = 2.0f / float(resolution);
  float area = edge * edge * layer.extent_x * layer.extent_y;
  if (layer.directional != 0) return area;
  float x = u * layer.extent_x;
  float y = v * layer.extent_y;
  float squared = 1.0f + x * x + y * y;  // 1 / cos^2
  return area / (squared * sqrt(squared));
}

// Whether a texel belongs to the layer alone: texels in the margin of a cube's face are seen by the next face, too.
SHARED_FUNCTION bool rsm_texel_counts(int layer_count, int resolution, int x, int y) {
  if (layer_count == 1) return true;
  int last = resolution - 1 - RSM_MARGIN_TEXELS;
  return min(x, y) >= RSM_MARGIN_TEXELS && max(x, y) <= last;
}

SHARED_END
#endif
