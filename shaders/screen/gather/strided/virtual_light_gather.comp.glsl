#version 450 core
// Irradiance of virtual lights, without visibility, at pixels of the G-buffer: the disk-to-point
// form (docs/conventions.md#virtual-lights), less what negative lights take away. A dispatch takes one block of lights;
// the first begins the sum, the last ends it.
// IN_THE_AIR: lights of a lattice. LIGHT_MAPS: each as far as its own map sees. NEGATIVE: there are negative lights. LISTED: the pixels in a list; else every stride-th in both directions, and the last row and column.
#include "shared/constants.glsl"
#include "shared/disk_to_point.shared.h"
#include "shared/lattice_light.shared.h"
#include "screen/base/gbuffer.glsl"
#include "screen/base/virtual_lights_block.glsl"
#include "screen/gather/strided/slots.shared.h"
#include "shared/group_sizes.shared.h"
#include "shared/octahedral.glsl"
#include "screen/visibility/negative/negative_light.shared.h"
#include "screen/base/coarse_pixels.glsl"

layout(local_size_x = LINEAR_GROUP) in;
// Irradiance; when the sum ends at full resolution radiance.
layout(binding = GATHERED_IMAGE, rgba32f) uniform image2D target;
uniform int first_light;  // of the block
uniform int end_light;
uniform int begins;
uniform int ends;
#ifdef LISTED
layout(std430, binding = PIXEL_LIST_SLOT) readonly buffer PixelList { WorkListHead head; uint listed[]; };
#endif

#ifdef LIGHT_MAPS
#include "screen/visibility/imperfect/light_map_visibility.glsl"
uniform int first_of_block;  // among all lights
#endif

// Irradiance over the light's flux.
float form_of(VirtualLight light, vec3 x, vec3 normal) {
  vec3 w = light.position - x;
  float squared = dot(w, w);
  float along = dot(w, normal);
#ifdef IN_THE_AIR
  return lattice_light(-dot(w, light.normal), along, squared, light.area_m2);
#else
  float height = max(-dot(w, light.normal), 0.0);
  return disk_to_point(height, along, -dot(normal, light.normal), squared, light.area_m2);
#endif
}

vec3 sum_of_lights(vec3 x, vec3 normal, vec3 geometric) {
  vec3 sum = vec3(0.0);
  for (int i = first_light; i < end_light; ++i) {
    vec3 w = lights[i].position - x;
    float form = min(dot(w, normal), dot(w, geometric)) > 0.0 ? form_of(lights[i], x, normal) : 0.0;
#ifdef LIGHT_MAPS
    if (form > 0.0) form *= light_map_visibility(first_of_block + i, lights[i].position, lights[i].normal, x, geometric);
#endif
    sum += lights[i].flux * form;
  }
  return sum;
}

#ifdef NEGATIVE
#include "screen/visibility/negative/negative_lights_block.glsl"
#include "screen/visibility/negative/negative_sum.glsl"
uniform int negative_count;
#endif

void main() {
  int index = int(global_index());
#ifdef LISTED
  if (index >= int(head.count)) return;
  ivec2 texel = unpack_pixel(listed[index]);
  ivec2 pixel = texel;
#else
  ivec2 coarse_size = imageSize(target);
  if (index >= coarse_size.x * coarse_size.y) return;
  ivec2 texel = ivec2(index % coarse_size.x, index / coarse_size.x);
  ivec2 pixel = pixel_of_coarse(texel, textureSize(position_map, 0));
#endif
  vec4 position = texelFetch(position_map, pixel, 0);
  vec4 irradiance = vec4(0.0);
  if (position.w != 0.0) {
    vec4 normals = texelFetch(normal_map, pixel, 0);
    vec3 normal = octahedral_decode(normals.xy);
    irradiance = vec4(sum_of_lights(position.xyz, normal, octahedral_decode(normals.zw)), 1.0);
    if (begins == 0) irradiance.rgb += imageLoad(target, texel).rgb;
    if (ends != 0) {
#ifdef NEGATIVE
      irradiance.rgb = max(irradiance.rgb - sum_of_negative_lights(position.xyz, normal, negative_count), 0.0);
#endif
      if (stride == 1) irradiance.rgb *= texelFetch(albedo_map, pixel, 0).rgb / PI;
    }
  }
  imageStore(target, texel, irradiance);
}
