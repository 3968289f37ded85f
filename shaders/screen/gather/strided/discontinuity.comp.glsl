#version 450 core
// Cochran and Steele 2007, section 3.5: pixels whose surface is like that of the coarse pixels around them take their
// irradiance from those; the others are listed, to be gathered again. We depart: irradiance is interpolated between two
// or four coarse pixels, all of which must be like the pixel; and albedo comes after it, at full resolution.
#include "shared/constants.glsl"
#include "screen/base/gbuffer.glsl"
#include "shared/group_sizes.shared.h"
#include "shared/octahedral.glsl"
#include "screen/base/coarse_pixels.glsl"
#include "screen/base/slots.shared.h"
#include "screen/gather/strided/slots.shared.h"

layout(local_size_x = SQUARE_GROUP, local_size_y = SQUARE_GROUP) in;
layout(binding = COARSE_INDIRECT_UNIT) uniform sampler2D coarse_indirect;  // irradiance; w = 0 in the background
layout(binding = COARSE_DIRECT_UNIT) uniform sampler2D coarse_direct;
layout(binding = FINE_INDIRECT_IMAGE, rgba32f) uniform writeonly image2D indirect_radiance;
layout(binding = FINE_DIRECT_IMAGE, rgba32f) uniform writeonly image2D direct_radiance;
layout(std430, binding = PIXEL_LIST_SLOT) buffer PixelList { WorkListHead head; uint listed[]; };
uniform float threshold;
uniform float contrast;
uniform float unlike_distance_m;
uniform int with_direct;

struct Coarse {
  vec3 position, normal;
  vec3 indirect, direct;
  bool background;
};

// The threshold is an angle [rad]: between the normals, and of the way between the points with the tangent plane.
bool alike(vec3 position, vec3 normal, Coarse there) {
  vec3 way = there.position - position;
  float squared = dot(way, way);
  vec3 bend = there.normal - normal;
  float off_plane = dot(way, normal);
  return dot(bend, bend) <= threshold * threshold && off_plane * off_plane <= threshold * threshold * squared &&
         squared <= unlike_distance_m * unlike_distance_m;
}

Coarse coarse_at(ivec2 texel, ivec2 size) {
  ivec2 pixel = pixel_of_coarse(texel, size);
  vec4 irradiance = texelFetch(coarse_indirect, texel, 0);
  return Coarse(texelFetch(position_map, pixel, 0).xyz, octahedral_decode(texelFetch(normal_map, pixel, 0).xy),
                irradiance.rgb, with_direct != 0 ? texelFetch(coarse_direct, texel, 0).rgb : vec3(0.0),
                irradiance.w == 0.0);
}

void list(ivec2 pixel) {
  uint slot;
  APPEND_TO_LIST(head, uint(LINEAR_GROUP), slot)
  listed[slot] = pack_pixel(pixel);
}

// Light of a pixel from those of the four coarse ones around it that have weight. False where it differs from any.
bool interpolate(ivec2 pixel, ivec2 size, Coarse around[4], vec2 t, out vec3 indirect, out vec3 direct) {
  vec3 position = texelFetch(position_map, pixel, 0).xyz;
  vec3 normal = octahedral_decode(texelFetch(normal_map, pixel, 0).xy);
  vec3 smallest = vec3(1e30), largest = vec3(0.0);
  indirect = direct = vec3(0.0);
  for (int k = 0; k < 4; ++k) {
    vec2 w = mix(1.0 - t, t, vec2(k & 1, k >> 1));
    float weight = w.x * w.y;
    if (weight == 0.0) continue;
    if (around[k].background || (weight < 1.0 && !alike(position, normal, around[k]))) return false;
    indirect += weight * around[k].indirect;
    direct += weight * around[k].direct;
    smallest = min(smallest, around[k].indirect + around[k].direct);
    largest = max(largest, around[k].indirect + around[k].direct);
  }
  return all(lessThanEqual(largest - smallest, contrast * largest));
}

void light_pixel(ivec2 pixel, ivec2 size, Coarse around[4], vec2 t) {
  vec3 indirect = vec3(0.0), direct = vec3(0.0);
  bool background = texelFetch(position_map, pixel, 0).w == 0.0;
  if (!background && !interpolate(pixel, size, around, t, indirect, direct)) {
    list(pixel);
    return;
  }
  vec3 reflectance = background ? vec3(0.0) : texelFetch(albedo_map, pixel, 0).rgb / PI;
  imageStore(indirect_radiance, pixel, vec4(reflectance * indirect, 1.0));
  if (with_direct != 0) imageStore(direct_radiance, pixel, vec4(reflectance * direct, 1.0));
}

// One thread for the pixels between four coarse ones; the last row and column have coarse pixels of their own.
void main() {
  ivec2 low = ivec2(gl_GlobalInvocationID.xy);
  ivec2 size = textureSize(position_map, 0);
  ivec2 last = textureSize(coarse_indirect, 0) - 1;
  if (any(greaterThan(low, last))) return;
  ivec2 from = pixel_of_coarse(low, size);
  Coarse around[4];
  for (int k = 0; k < 4; ++k) around[k] = coarse_at(min(low + ivec2(k & 1, k >> 1), last), size);
  ivec2 step = max(pixel_of_coarse(low + 1, size) - from, ivec2(1));
  for (int y = 0; y < step.y; ++y) {
    for (int x = 0; x < step.x; ++x) light_pixel(from + ivec2(x, y), size, around, vec2(x, y) / vec2(step));
  }
}
