#version 450 core
// Which pixels of a level are gathered, and what the others have from the coarser one (Nichols 2010, section 5.3.4):
// those at edges of geometry, where light varies between the corners, where the visibility of many lights does. FIRST:
// the coarsest level, all of it. Of a level whose pixels share lights, those that have one share.
#include "screen/base/coarse_pixels.glsl"
#include "screen/gather/area/area_level.glsl"
#include "shared/group_sizes.shared.h"
#include "shared/luminance.glsl"

layout(local_size_x = SQUARE_GROUP, local_size_y = SQUARE_GROUP) in;
layout(binding = AREA_IRRADIANCE_IMAGE, rgba32f) uniform writeonly image2D irradiance;
layout(binding = AREA_MASK_IMAGE, rgba32ui) uniform writeonly uimage2D masks;
layout(binding = AREA_STEP_IMAGE, r8ui) uniform writeonly uimage2D gathered_step;
layout(std430, binding = AREA_LIST_SLOT) buffer PixelList { WorkListHead head; uint listed[]; };
uniform float tolerance;    // of irradiance, between corners
uniform float most_in_part; // groups that are seen in part, or from some corners only
uniform int share;
uniform int shares;

int count_bits2(uvec2 v) { return bitCount(v.x) + bitCount(v.y); }

void main() {
  // Shares go by i + 2 j: along rows, columns and diagonals pixels of all of them follow on one another.
  ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  ivec2 pixel = step_px * (shares == 1 ? at : ivec2(shares * at.x + (share - 2 * at.y & shares - 1), at.y));
  if (any(greaterThanEqual(pixel, textureSize(position_map, 0)))) return;
  vec4 position = texelFetch(position_map, pixel, 0);
  bool known = position.w == 0.0;  // nothing
  vec3 sum = vec3(0.0);
  uvec4 mask = uvec4(0u);
#ifndef FIRST
  if (all(equal(pixel % (2 * step_px), ivec2(0)))) return;  // of the coarser level
  if (!known) {
    Corners c = corners_of(pixel, position.xyz, octahedral_decode(texelFetch(normal_map, pixel, 0).xy));
    float least = 3.0e38, most = 0.0, largest = 0.0;
    int nearest = 0;
    for (int k = 0; k < 4; ++k) {
      if (c.weights[k] <= 0.0) continue;
      vec3 e = texelFetch(known_irradiance, c.at[k], 0).rgb;
      sum += c.weights[k] * e;
      least = min(least, luminance(e));
      most = max(most, luminance(e));
      if (c.weights[k] > largest) nearest = k;
      largest = max(largest, c.weights[k]);
    }
    uvec2 seen, hidden;
    agreed(c, seen, hidden);
    float in_part = float(count_bits2(~(seen | hidden)));
    known = c.whole && most - least <= tolerance * most && in_part <= most_in_part;
    mask = texelFetch(known_mask, c.at[nearest], 0);
  }
#endif
  if (known) {
    imageStore(irradiance, pixel, vec4(sum, 1.0));
    imageStore(masks, pixel, mask);
  } else {
    imageStore(gathered_step, pixel, uvec4(step_px));
    uint slot;
    APPEND_TO_LIST(head, uint(LINEAR_GROUP), slot)
    listed[slot] = pack_pixel(pixel);
  }
}
