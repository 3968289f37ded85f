// A triangle as one layer of paraboloid depth maps sees it. Everything that decides which texels it covers is `precise`
// and written out: neighbours must find opposite numbers for the edge that they share, or surfaces get holes.
#include "shared/scene_vertex.shared.h"
#include "screen/visibility/area_maps/slots.shared.h"
#include "screen/visibility/area_maps/virtual_area_light.shared.h"
#ifdef ALPHA
float texture_lod(sampler2D image, int texcoord, mat3 transform);
#define MATERIAL_LOD texture_lod(image, texcoord, transform)
#include "shared/material.glsl"
#endif

layout(std430, binding = VERTICES_SLOT) readonly buffer Vertices { float vertices[]; };
layout(std430, binding = MAPPED_AREA_LIGHTS_SLOT) readonly buffer AreaLights { VirtualAreaLight area_lights[]; };
// Positive floats are ordered as their bits are.
layout(binding = DISTANCE_BITS_IMAGE, r32ui) uniform uimage2DArray distance_bits;
uniform int resolution;

#define TILE_TEXELS 16  // edge
struct TileListHead {
  uint count;  // may exceed the capacity: the rest was drawn at once
  uint capacity;
};
// Entries of large triangles: triangle, and the next entry of the same tile, from 1 on; 0: none.
layout(std430, binding = MAP_TILES_SLOT) buffer TileList { TileListHead head; uvec2 entries[]; };
// The last entry of every tile, layer after layer, from 1 on; 0: none.
layout(std430, binding = MAP_TILE_ENDS_SLOT) buffer TileEnds { uint tile_ends[]; };

int tiles_across() { return (resolution + TILE_TEXELS - 1) / TILE_TEXELS; }

// In the frame of its area light: z along the axis.
struct LayerTriangle {
  int layer;
  int first_vertex;
  vec3 a, b, c;
  vec3 edge_ab, edge_bc, edge_ca;  // normals of the planes through the light and an edge, on the triangle's side
  vec3 normal;                     // of any length
  float volume;                    // |dot(a, normal)|
  float farthest_m;                // of its corners
};

vec3 exact_cross(vec3 a, vec3 b) {
  precise vec3 n = vec3(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
  return n;
}

vec3 corner(VirtualAreaLight light, int vertex) {
  int i = vertex * VERTEX_FLOATS + VERTEX_POSITION;
  precise vec3 d = vec3(vertices[i], vertices[i + 1], vertices[i + 2]) - light.position;
  precise vec3 up = exact_cross(light.normal, light.right);
  precise vec3 q = vec3(d.x * light.right.x + d.y * light.right.y + d.z * light.right.z,
                        d.x * up.x + d.y * up.y + d.z * up.z,
                        d.x * light.normal.x + d.y * light.normal.y + d.z * light.normal.z);
  return q;
}

// @return false when the layer cannot see it: behind the light; or in a plane through the light, as the surface is that
// the light lies on, and anything else seen edge-on. "Through" allows for what positions err: 2^-20 of their numbers,
// as in reflective_shadow_map.glsl, where lights come from.
bool layer_triangle(int layer, int triangle, out LayerTriangle t) {
  VirtualAreaLight light = area_lights[layer];
  t.layer = layer;
  t.first_vertex = 3 * triangle;
  t.a = corner(light, t.first_vertex);
  t.b = corner(light, t.first_vertex + 1);
  t.c = corner(light, t.first_vertex + 2);
  if (light.light_count == 0 || max(t.a.z, max(t.b.z, t.c.z)) <= 0.0) return false;
  precise vec3 normal = exact_cross(t.b - t.a, t.c - t.a);
  precise float volume = dot(t.a, normal);
  t.normal = normal;
  t.volume = abs(volume);
  t.farthest_m = sqrt(max(dot(t.a, t.a), max(dot(t.b, t.b), dot(t.c, t.c))));
  float error_m = (length(light.position) + t.farthest_m) / 1048576.0;
  if (t.volume <= length(normal) * error_m) return false;
  float side = volume < 0.0 ? -1.0 : 1.0;
  t.edge_ab = side * exact_cross(t.a, t.b);
  t.edge_bc = side * exact_cross(t.b, t.c);
  t.edge_ca = side * exact_cross(t.c, t.a);
  return true;
}

vec2 disk_of_texel(ivec2 texel) {
  precise vec2 disk = (vec2(texel) + 0.5) * (2.0 / float(resolution)) - 1.0;
  return disk;
}

#ifdef ALPHA
float lod_area = 0.0;  // texture space (u, v) per texel of the map
float lod_area_1 = 0.0;

float texture_lod(sampler2D image, int texcoord, mat3 transform) {
  vec2 size = vec2(textureSize(image, 0));
  float texels = (texcoord == 0 ? lod_area : lod_area_1) * abs(determinant(mat2(transform))) * size.x * size.y;
  return 0.5 * log2(max(texels, 1.0));
}

vec2 uv_at(int first_vertex, int place, vec3 weights) {
  vec2 uv = vec2(0.0);
  for (int k = 0; k < 3; ++k) {
    int i = (first_vertex + k) * VERTEX_FLOATS + place;
    uv += weights[k] * vec2(vertices[i], vertices[i + 1]);
  }
  return uv;
}

// Area of the triangle in texture space over its true one.
float uv_density(LayerTriangle t, int place) {
  vec2 o = uv_at(t.first_vertex, place, vec3(1.0, 0.0, 0.0));
  vec2 u = uv_at(t.first_vertex, place, vec3(0.0, 1.0, 0.0)) - o;
  vec2 v = uv_at(t.first_vertex, place, vec3(0.0, 0.0, 1.0)) - o;
  return abs(u.x * v.y - u.y * v.x) / length(t.normal);
}

bool texel_keeps(LayerTriangle t, ivec2 texel, vec3 weights, float distance_m, float cosine, float squared) {
  // A texel's solid angle is (2 / resolution)^2 4 / (1 + r^2)^2.
  float edge_m = 4.0 / (float(resolution) * squared) * distance_m;
  float area_m2 = edge_m * edge_m / max(cosine, 1e-6);
  lod_area = area_m2 * uv_density(t, VERTEX_UV0);
  lod_area_1 = area_m2 * uv_density(t, VERTEX_UV1);
  vec4 color = vec4(0.0);
  for (int k = 0; k < 3; ++k) {
    int i = (t.first_vertex + k) * VERTEX_FLOATS + VERTEX_COLOR;
    color += weights[k] * vec4(vertices[i], vertices[i + 1], vertices[i + 2], vertices[i + 3]);
  }
  float alpha = material_albedo_alpha(uv_at(t.first_vertex, VERTEX_UV0, weights),
                                      uv_at(t.first_vertex, VERTEX_UV1, weights), color).a;
  return material_keeps(alpha, uvec3(texel, uint(t.first_vertex / 3) * 65599u + uint(t.layer)));
}
#endif

#define NOTHING_BITS 0x7f800000u  // infinity

// Distance of the triangle at a texel's centre. The direction stays unnormalised, (2 x, 2 y, 1 - r^2), and its length is
// 1 + r^2.
uint texel_bits(LayerTriangle t, ivec2 texel) {
  vec2 disk = disk_of_texel(texel);
  precise float squared = disk.x * disk.x + disk.y * disk.y;
  if (squared > 1.0) return NOTHING_BITS;
  precise vec3 d = vec3(2.0 * disk, 1.0 - squared);
  precise vec3 inside = vec3(dot(t.edge_bc, d), dot(t.edge_ca, d), dot(t.edge_ab, d));
  if (min(inside.x, min(inside.y, inside.z)) < 0.0) return NOTHING_BITS;
  float along = abs(dot(t.normal, d));
  float distance_m = min(t.volume * (1.0 + squared) / along, t.farthest_m);
#ifdef ALPHA
  vec3 weights = inside / max(inside.x + inside.y + inside.z, 1e-37);
  if (!texel_keeps(t, texel, weights, distance_m, along / ((1.0 + squared) * length(t.normal)), 1.0 + squared)) return NOTHING_BITS;
#endif
  return floatBitsToUint(distance_m);
}

// Keeps it where it is nearer than what is there.
void draw_texel(LayerTriangle t, ivec2 texel) {
  uint bits = texel_bits(t, texel);
  ivec3 at = ivec3(texel, t.layer);
  if (bits < imageLoad(distance_bits, at).r) imageAtomicMin(distance_bits, at, bits);
}
