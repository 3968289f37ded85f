#version 450 core
// One thread for each triangle, layer and band of tile rows: draws the triangle where its bounds hold few texels, else lists
// the tiles that it may touch for paraboloid_depth_maps_tiles.comp.glsl. Bands, because llvmpipe ends an invocation after
// 65535 turns of all its loops without a word, and a triangle that is drawn here for want of room in the list takes one for
// each texel.
#include "screen/visibility/area_maps/paraboloid_triangle.glsl"
#include "shared/group_sizes.shared.h"

layout(local_size_x = LINEAR_GROUP) in;
uniform int first_triangle;
uniform int triangle_count;
uniform int first_layer;

#define FEW_TEXELS (TILE_TEXELS * TILE_TEXELS)

struct Bounds {
  vec2 low, high;
};

vec2 disk_of(vec3 q) { return q.xy / (length(q) + q.z); }

// The image of a great circle of unit normal n is a circle of radius 1 / |n.z|, which the disk cuts at ends of a
// diameter: what lies on the disk is at most half of it, and rises above its chord of length c by the sagitta
// R - sqrt(R^2 - c^2 / 4).
// margin: how far rounding may have turned the plane of the edge.
void include_arc(vec2 from, vec2 to, float normal_z, float margin, inout Bounds bounds) {
  vec2 chord = to - from;
  float quarter = 0.25 * dot(chord, chord);
  float rise_per_chord = 0.5 * sqrt(quarter) * normal_z / (1.0 + sqrt(max(1.0 - quarter * normal_z * normal_z, 0.0)));
  vec2 grow = abs(chord.yx) * rise_per_chord + margin;
  bounds.low = min(bounds.low, min(from, to) - grow);
  bounds.high = max(bounds.high, max(from, to) + grow);
}

// The part of an edge above the horizon, and where it crosses that (in `crossing`, which alternates).
void include_edge(vec3 a, vec3 b, vec3 edge, inout Bounds bounds, inout vec2 crossing, inout int crossings) {
  if (a.z < 0.0 && b.z < 0.0) return;
  float edge_length = length(edge);
  float margin = 9.54e-7 + min(9.54e-7 * length(a) * length(b) / edge_length, 2.0);  // 2^-20: 16 roundings
  vec2 from = disk_of(a);
  vec2 to = disk_of(b);
  if (min(a.z, b.z) < 0.0) {
    vec2 rim = normalize(a.xy * (-b.z) + b.xy * a.z) * (a.z > b.z ? 1.0 : -1.0);
    if (a.z < 0.0) from = rim; else to = rim;
    if (crossings == 1) include_arc(crossing, rim, 1.0, margin, bounds);
    crossing = rim;
    ++crossings;
  }
  include_arc(from, to, abs(edge.z) / edge_length, margin, bounds);
}

bool tile_may_touch(LayerTriangle t, ivec2 tile) {
  vec2 disk = (vec2(tile * TILE_TEXELS) + 0.5 * float(TILE_TEXELS)) * (2.0 / float(resolution)) - 1.0;
  float reach = 1.41421357 * float(TILE_TEXELS) / float(resolution);
  float squared = dot(disk, disk);
  if (sqrt(squared) > 1.0 + reach) return false;
  vec3 d = vec3(2.0 * disk, 1.0 - squared);
  for (int k = 0; k < 3; ++k) {
    vec3 n = k == 0 ? t.edge_ab : k == 1 ? t.edge_bc : t.edge_ca;
    // dot(n, d) over the tile is its value at the middle, a slope and a curvature.
    float upper_bound = dot(n, d) + reach * (2.0 * length(n.xy - disk * n.z) + reach * abs(n.z));
    if (upper_bound < -9.54e-7 * length(n)) return false;
  }
  return true;
}

void list_tiles(LayerTriangle t, int triangle, ivec2 low, ivec2 high, ivec2 rows) {
  low.y = max(low.y / TILE_TEXELS, rows.x);
  high.y = min(high.y / TILE_TEXELS, rows.y - 1);
  for (int y = low.y; y <= high.y; ++y) {
    for (int x = low.x / TILE_TEXELS; x <= high.x / TILE_TEXELS; ++x) {
      if (!tile_may_touch(t, ivec2(x, y))) continue;
      uint slot = atomicAdd(head.count, 1u);
      if (slot < head.capacity) {
        int tile = (t.layer * tiles_across() + y) * tiles_across() + x;
        entries[slot] = uvec2(triangle, atomicExchange(tile_ends[tile], slot + 1u));
        continue;
      }
      for (int i = 0; i < TILE_TEXELS * TILE_TEXELS; ++i) {
        ivec2 texel = ivec2(x, y) * TILE_TEXELS + ivec2(i % TILE_TEXELS, i / TILE_TEXELS);
        if (max(texel.x, texel.y) < resolution) draw_texel(t, texel);
      }
    }
  }
}

void main() {
  int index = int(gl_GlobalInvocationID.x);
  if (index >= triangle_count) return;
  int triangle = first_triangle + index;
  LayerTriangle t;
  if (!layer_triangle(first_layer + int(gl_GlobalInvocationID.y), triangle, t)) return;
  Bounds bounds = Bounds(vec2(2.0), vec2(-2.0));
  vec2 crossing = vec2(0.0);
  int crossings = 0;
  include_edge(t.a, t.b, t.edge_ab, bounds, crossing, crossings);
  include_edge(t.b, t.c, t.edge_bc, bounds, crossing, crossings);
  include_edge(t.c, t.a, t.edge_ca, bounds, crossing, crossings);
  float half_resolution = 0.5 * float(resolution);
  ivec2 low = max(ivec2(ceil((bounds.low + 1.0) * half_resolution - 0.5)), ivec2(0));
  ivec2 high = min(ivec2(floor((bounds.high + 1.0) * half_resolution - 0.5)), ivec2(resolution - 1));
  ivec2 size = high - low + 1;
  if (min(size.x, size.y) <= 0) return;
  if (size.x * size.y > FEW_TEXELS) {
    int bands = int(gl_NumWorkGroups.z), band = int(gl_GlobalInvocationID.z);
    list_tiles(t, triangle, low, high, ivec2(band, band + 1) * tiles_across() / bands);
    return;
  }
  if (gl_GlobalInvocationID.z != 0u) return;
  ivec2 texel = low;
  for (int i = 0; i < size.x * size.y; ++i) {  // one loop, as neighbouring triangles have other shapes
    draw_texel(t, texel);
    texel.x += 1;
    if (texel.x > high.x) texel = ivec2(low.x, texel.y + 1);
  }
}
