#version 450 core
// One group for each map: splats its run of points, closes the holes between them, and writes distances. MAP_TEXELS: on a
// side of a map. Ritschel et al. 2008, sections 4.2 and 4.3.
#include "screen/visibility/imperfect/slots.shared.h"
#include "screen/visibility/area_maps/virtual_area_light.shared.h"
#include "shared/constants.glsl"
#include "shared/global_index.shared.h"
#include "shared/occluder_point.shared.h"

#ifndef MAP_TEXELS
#define MAP_TEXELS 32
#endif
#define GROUP 128
layout(local_size_x = GROUP) in;
layout(std430, binding = MAP_VIEWS_SLOT) readonly buffer Views { VirtualAreaLight views[]; };
layout(std430, binding = OCCLUDER_POINTS_SLOT) readonly buffer Points { OccluderPoint points[]; };
layout(binding = IMPERFECT_DISTANCE_IMAGE, r32f) uniform writeonly image2DArray distances;
uniform int maps;
uniform int tiles;         // on a side of a layer
uniform int all_points;    // powers of two, both
uniform int points_of_map;
uniform float farthest_m;  // that a point may be from a view
uniform int pull_levels;   // coarser levels that holes are closed from

// Where the nearest point is, and which of the map's run it is: distances are in even ratios of 5e-5. Points that cover
// the texel's middle come before those that lie beside it.
#define POINT_BITS 13
#define RATIO_STEPS float((1 << (31 - POINT_BITS)) - 1)
#define RATIO_OCTAVES 20.0
#define BESIDE 0x80000000u
#define NO_POINT 0xffffffffu
#define MAX_SPLAT 4  // texels beside the middle one

#define LEVEL_TEXELS (MAP_TEXELS * MAP_TEXELS)
shared uint nearest[LEVEL_TEXELS + LEVEL_TEXELS / 2];

int level_start(int level) {
  int start = 0;
  for (int l = 0; l < level; ++l) start += LEVEL_TEXELS >> (2 * l);
  return start;
}

vec3 in_view(VirtualAreaLight view, vec3 v) {
  return vec3(dot(v, view.right), dot(v, cross(view.normal, view.right)), dot(v, view.normal));
}

OccluderPoint point_of(int map, int k) { return points[(map * points_of_map + k) & (all_points - 1)]; }

struct Splat {
  vec3 at, normal;  // in the view
  float distance_m, radius_m;
};

// False for what the view does not see: behind it, or in a plane through it, as the surface is that a light lies on.
bool splat_of(VirtualAreaLight view, int map, int k, out Splat s) {
  OccluderPoint p = point_of(map, k);
  s.at = in_view(view, p.position - view.position);
  s.normal = in_view(view, p.normal);
  s.distance_m = length(s.at);
  s.radius_m = sqrt(p.area_m2 * float(all_points / points_of_map) / PI);
  float error_m = (length(view.position) + 2.0 * s.distance_m) / 1048576.0;
  return p.area_m2 > 0.0 && s.at.z > 0.0 && abs(dot(s.at, s.normal)) > error_m;
}

vec2 disk_of_texel(ivec2 texel) { return (vec2(texel) + 0.5) * (2.0 / float(MAP_TEXELS)) - 1.0; }

// Along a texel's own direction, on the point's plane as far as the point reaches: texels of one plane then hold that
// plane, however obliquely it is seen, and it does not hide itself.
float distance_through(Splat s, ivec2 texel) {
  float slope = dot(s.normal, direction_from_paraboloid(disk_of_texel(texel)));
  float on_plane = dot(s.at, s.normal) / (abs(slope) > 1e-6 ? slope : 1e-6);
  return clamp(on_plane > 0.0 ? on_plane : s.distance_m, max(s.distance_m - s.radius_m, 0.5 * s.distance_m),
               2.0 * s.distance_m);
}

uint key_of(float distance_m, int k) {
  float octaves = log2(max(distance_m / farthest_m, 1e-30)) + RATIO_OCTAVES;
  uint step = uint(clamp(octaves * (RATIO_STEPS / RATIO_OCTAVES), 0.0, RATIO_STEPS - 1.0));
  return step << POINT_BITS | uint(k);
}
int point_in(uint key) { return int(key & ((1u << POINT_BITS) - 1u)); }

void splat(Splat s, int k) {
  vec2 disk = paraboloid_from_direction(s.at / s.distance_m);
  // A disk of the point's area, seen at its angle; the map's scale on the unit disk is 2 / (1 + r^2). Such disks leave a
  // third of the texels' middles to points beside them; larger ones (1.5) let edges grow: cornell 2.5 % instead of 1.7.
  float facing = max(abs(dot(s.at, s.normal)) / s.distance_m, 0.05);
  float radius = s.radius_m * sqrt(facing) / s.distance_m * 0.25 * (1.0 + dot(disk, disk)) * float(MAP_TEXELS);
  vec2 at = (disk * 0.5 + 0.5) * float(MAP_TEXELS);
  int reach = clamp(int(radius + 0.5), 0, MAX_SPLAT);
  ivec2 middle = ivec2(floor(at));
  for (int y = -reach; y <= reach; ++y) {
    for (int x = -reach; x <= reach; ++x) {
      ivec2 texel = middle + ivec2(x, y);
      if (min(texel.x, texel.y) < 0 || max(texel.x, texel.y) >= MAP_TEXELS) continue;
      vec2 beside = vec2(texel) + 0.5 - at;
      bool covers = dot(beside, beside) <= radius * radius;
      if (!covers && (x != 0 || y != 0)) continue;
      uint key = key_of(distance_through(s, texel), k) | (covers ? 0u : BESIDE);
      atomicMin(nearest[texel.y * MAP_TEXELS + texel.x], key);
    }
  }
}

// Holes take what is nearest in the first coarser level that knows anything.
void pull_push(int lane) {
  for (int level = 1; level <= pull_levels; ++level) {
    int edge = MAP_TEXELS >> level, from = level_start(level - 1), to = level_start(level);
    for (int i = lane; i < edge * edge; i += GROUP) {
      int first = from + (i / edge) * 4 * edge + (i % edge) * 2;
      nearest[to + i] = min(min(nearest[first], nearest[first + 1]),
                            min(nearest[first + 2 * edge], nearest[first + 2 * edge + 1]));
    }
    barrier();
  }
  for (int level = pull_levels; level > 0; --level) {
    int edge = MAP_TEXELS >> (level - 1), from = level_start(level), to = level_start(level - 1);
    for (int i = lane; i < edge * edge; i += GROUP) {
      if (nearest[to + i] == NO_POINT) nearest[to + i] = nearest[from + (i / edge / 2) * (edge / 2) + i % edge / 2];
    }
    barrier();
  }
}

void main() {
  int map = int(group_index());
  int lane = int(gl_LocalInvocationIndex);
  if (map >= maps) return;
  VirtualAreaLight view = views[map];
  for (int i = lane; i < LEVEL_TEXELS; i += GROUP) nearest[i] = NO_POINT;
  barrier();
  if (view.light_count > 0) {
    for (int k = lane; k < points_of_map; k += GROUP) {
      Splat s;
      if (splat_of(view, map, k, s)) splat(s, k);
    }
  }
  barrier();
  pull_push(lane);
  ivec2 corner = ivec2(map % (tiles * tiles) % tiles, map % (tiles * tiles) / tiles) * MAP_TEXELS;
  for (int i = lane; i < LEVEL_TEXELS; i += GROUP) {
    ivec2 texel = ivec2(i % MAP_TEXELS, i / MAP_TEXELS);
    float distance_m = uintBitsToFloat(0x7f800000u);
    vec2 disk = disk_of_texel(texel);
    if (nearest[i] != NO_POINT && dot(disk, disk) <= 1.0) {
      Splat s;
      splat_of(view, map, point_in(nearest[i]), s);
      distance_m = distance_through(s, texel);
    }
    imageStore(distances, ivec3(corner + texel, map / (tiles * tiles)), vec4(distance_m));
  }
}
