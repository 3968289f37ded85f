#version 450 core
// Cochran and Steele 2007, section 3.5: pixels whose surface is like that of the coarse pixels around them take their
// irradiance from those; the others are listed, to be gathered again. We depart: irradiance is interpolated between two
// or four coarse pixels, all of which must be like the pixel; and albedo comes after it, at full resolution.
#include "shared/octahedral.glsl"
#include "screen/coarse_pixels.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0) uniform sampler2D position_map;
layout(binding = 1) uniform sampler2D normal_map;
layout(binding = 2) uniform sampler2D albedo_map;
layout(binding = 3) uniform sampler2D coarse_indirect;  // irradiance; w = 0 in the background
layout(binding = 4) uniform sampler2D coarse_direct;
layout(binding = 0, rgba32f) uniform writeonly image2D indirect_radiance;
layout(binding = 1, rgba32f) uniform writeonly image2D direct_radiance;
layout(std430, binding = 0) buffer PixelList { PixelListHead head; uint listed[]; };
uniform float threshold;
uniform float contrast;
uniform float unlike_distance_m;
uniform int with_direct;

const float PI = 3.14159265358979;

struct Surface {
  vec3 position, normal;
};

// The threshold is an angle [rad]: between the normals, and of the way between the points with the tangent plane.
bool alike(Surface here, vec3 position, vec3 normal) {
  vec3 way = position - here.position;
  float squared = dot(way, way);
  vec3 bend = normal - here.normal;
  float off_plane = dot(way, here.normal);
  return dot(bend, bend) <= threshold * threshold && off_plane * off_plane <= threshold * threshold * squared &&
         squared <= unlike_distance_m * unlike_distance_m;
}

void list(ivec2 pixel) {
  uint slot = atomicAdd(head.count, 1u);
  uint group = slot / 64u;
  if (slot % 64u == 0u) {
    if (group < GROUPS_A_ROW) atomicAdd(head.groups_x, 1u);
    else if (group % GROUPS_A_ROW == 0u) atomicAdd(head.groups_y, 1u);
  }
  listed[slot] = pack_pixel(pixel);
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  ivec2 size = textureSize(position_map, 0);
  if (any(greaterThanEqual(pixel, size))) return;
  vec4 position = texelFetch(position_map, pixel, 0);
  imageStore(indirect_radiance, pixel, vec4(0.0));
  if (with_direct != 0) imageStore(direct_radiance, pixel, vec4(0.0));
  if (position.w == 0.0) return;
  Surface here = Surface(position.xyz, octahedral_decode(texelFetch(normal_map, pixel, 0).xy));

  ivec2 low = pixel / stride;
  ivec2 from = pixel_of_coarse(low, size);
  vec2 t = vec2(pixel - from) / vec2(max(pixel_of_coarse(low + 1, size) - from, ivec2(1)));
  vec3 indirect = vec3(0.0), direct = vec3(0.0), least = vec3(1e30), most = vec3(0.0);
  for (int k = 0; k < 4; ++k) {
    ivec2 corner = ivec2(k & 1, k >> 1);
    vec2 w = mix(1.0 - t, t, vec2(corner));
    float weight = w.x * w.y;
    if (weight == 0.0) continue;
    ivec2 coarse_pixel = pixel_of_coarse(low + corner, size);
    vec4 there = texelFetch(coarse_indirect, low + corner, 0);
    if (there.w == 0.0 || (coarse_pixel != pixel &&
                           !alike(here, texelFetch(position_map, coarse_pixel, 0).xyz,
                                  octahedral_decode(texelFetch(normal_map, coarse_pixel, 0).xy)))) {
      list(pixel);
      return;
    }
    indirect += weight * there.rgb;
    vec3 all = there.rgb;
    if (with_direct != 0) {
      vec3 d = texelFetch(coarse_direct, low + corner, 0).rgb;
      direct += weight * d;
      all += d;
    }
    least = min(least, all);
    most = max(most, all);
  }
  if (any(greaterThan(most - least, contrast * most))) {
    list(pixel);
    return;
  }
  vec3 reflectance = texelFetch(albedo_map, pixel, 0).rgb / PI;
  imageStore(indirect_radiance, pixel, vec4(reflectance * indirect, 1.0));
  if (with_direct != 0) imageStore(direct_radiance, pixel, vec4(reflectance * direct, 1.0));
}
