#version 450 core
// One level of the discontinuity mipmaps from the one below: screen/gather/subsplats/discontinuity_mipmaps.h.
// FROM_PIXELS: the first one, from the G-buffer.
#include "screen/base/gbuffer.glsl"
#include "screen/gather/subsplats/discontinuity.shared.h"
#include "screen/gather/subsplats/slots.shared.h"
#include "screen/gather/subsplats/subsplat.shared.h"
#include "shared/group_sizes.shared.h"
#include "shared/octahedral.glsl"
#include "shared/storage.glsl"

layout(local_size_x = SQUARE_GROUP, local_size_y = SQUARE_GROUP) in;
layout(binding = DEPTH_RANGES_IMAGE, rg32f) uniform image2D depth_ranges;            // [m], nearest and farthest
layout(binding = LEAST_NORMALS_IMAGE, STORED_RGBA16_SNORM) uniform image2D least_normals;   // of each component
layout(binding = MOST_NORMALS_IMAGE, STORED_RGBA16_SNORM) uniform image2D most_normals;
layout(binding = BENDS_IMAGE, rg32f) uniform image2D bends;                          // largest derivative, curvature
layout(binding = DISCONTINUITIES_IMAGE, r8ui) uniform uimage2D discontinuities;      // SUBSPLAT_*
uniform ivec2 picture_size;
uniform int level;
uniform int border;       // 1: what lies beside a texel counts as well
uniform int with_normals, with_derivative, with_curvature;
uniform vec4 depth_plane;  // depth along the view axis = dot(depth_plane, vec4(position, 1))
uniform float depth_threshold_m;
uniform float derivative_threshold_m;  // a pixel
uniform float normal_threshold;
uniform float curvature_threshold;

struct Range {
  float nearest, farthest;  // FAR_AWAY: background, in all or in some of it
  vec3 least, most;
  float derivative, curvature;
};

Range no_range() { return Range(FAR_AWAY, 0.0, vec3(1.0), vec3(-1.0), 0.0, 0.0); }

void include(inout Range sum, Range part) {
  sum.nearest = min(sum.nearest, part.nearest);
  sum.farthest = max(sum.farthest, part.farthest);
  sum.least = min(sum.least, part.least);
  sum.most = max(sum.most, part.most);
  sum.derivative = max(sum.derivative, part.derivative);
  sum.curvature = max(sum.curvature, part.curvature);
}

#ifdef FROM_PIXELS
float depth_of(vec4 position) { return position.w == 0.0 ? FAR_AWAY : dot(depth_plane, position); }

vec3 normal_of(ivec2 pixel) { return octahedral_decode(texelFetch(normal_map, pixel, 0).xy); }

// With the next pixels to the right and above. Where those show background depth says so already.
void add_bends(ivec2 pixel, inout Range range) {
  vec3 normal = normal_of(pixel);
  vec2 slope = vec2(0.0);
  for (int axis = 0; axis < 2; ++axis) {
    ivec2 next = pixel + ivec2(1 - axis, axis);
    if (any(greaterThanEqual(next, picture_size))) continue;
    float depth = depth_of(texelFetch(position_map, next, 0));
    if (depth == FAR_AWAY) continue;
    slope[axis] = depth - range.nearest;
    // Eq. 3.1: 2 sin of half the angle is the chord.
    if (with_curvature != 0) range.curvature = max(range.curvature, distance(normal, normal_of(next)));
  }
  range.derivative = length(slope);
}

Range part_at(ivec2 pixel, out bool has_surface) {
  Range range = no_range();
  float depth = depth_of(texelFetch(position_map, pixel, 0));
  range.nearest = range.farthest = depth;
  has_surface = depth != FAR_AWAY;
  if (!has_surface) return range;
  if (with_normals != 0) range.least = range.most = normal_of(pixel);
  if (with_derivative + with_curvature != 0) add_bends(pixel, range);
  return range;
}
#else
Range part_at(ivec2 texel, out bool has_surface) {
  ivec2 at = tower_corner(picture_size, level - 1) + texel;
  Range range = no_range();
  vec2 depths = imageLoad(depth_ranges, at).rg;
  range.nearest = depths.x;
  range.farthest = depths.y;
  has_surface = (imageLoad(discontinuities, at).r & uint(SUBSPLAT_HAS_SURFACE)) != 0u;
  if (with_normals != 0) {
    range.least = imageLoad(least_normals, at).rgb;
    range.most = imageLoad(most_normals, at).rgb;
  }
  if (with_derivative + with_curvature != 0) {
    vec2 bend = imageLoad(bends, at).rg;
    range.derivative = bend.x;
    range.curvature = bend.y;
  }
  return range;
}
#endif

bool is_discontinuous(Range range) {
  if (range.nearest == FAR_AWAY) return false;
  // Surface beside background, whatever the criteria.
  if (range.farthest == FAR_AWAY) return true;
  vec3 turn = range.most - range.least;
  return range.farthest - range.nearest > depth_threshold_m ||
         (with_normals != 0 && max(turn.x, max(turn.y, turn.z)) > normal_threshold) ||
         (with_derivative != 0 && range.derivative > derivative_threshold_m) ||
         (with_curvature != 0 && range.curvature > curvature_threshold);
}

void main() {
  ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(texel, level_size(picture_size, level)))) return;
  ivec2 below = level_size(picture_size, level - 1);
  Range sum = no_range();
  bool has_surface = false;
  for (int y = -border; y < 2 + border; ++y) {
    for (int x = -border; x < 2 + border; ++x) {
      ivec2 part = 2 * texel + ivec2(x, y);
      if (any(lessThan(part, ivec2(0))) || any(greaterThanEqual(part, below))) continue;
      bool part_has_surface;
      include(sum, part_at(part, part_has_surface));
      bool inside = all(equal(part >> 1, texel));
      has_surface = has_surface || (inside && part_has_surface);
    }
  }
  ivec2 at = tower_corner(picture_size, level) + texel;
  imageStore(depth_ranges, at, vec4(sum.nearest, sum.farthest, 0.0, 0.0));
  if (with_normals != 0) {
    imageStore(least_normals, at, vec4(sum.least, 0.0));
    imageStore(most_normals, at, vec4(sum.most, 0.0));
  }
  if (with_derivative + with_curvature != 0) imageStore(bends, at, vec4(sum.derivative, sum.curvature, 0.0, 0.0));
  uint bits = (is_discontinuous(sum) ? uint(SUBSPLAT_DISCONTINUOUS) : 0u) |
              (has_surface ? uint(SUBSPLAT_HAS_SURFACE) : 0u);
  imageStore(discontinuities, at, uvec4(bits));
}
