#version 450 core
// Irradiance of virtual lights, each as far as its area light is visible: Dong et al. 2009, section 4; we take the
// disk-to-point form of docs/conventions.md#virtual-lights.
// Every interleave-th pixel in both directions takes one subset of the lights, times the number of subsets; with
// interleave 1, and LISTED (the pixels of a list), all of the lights, and the sum ends in radiance.
#include "shared/constants.glsl"
#include "shared/disk_to_point.shared.h"
#include "screen/base/gbuffer.glsl"
#include "shared/group_sizes.shared.h"
#include "shared/near_light.shared.h"
#include "shared/octahedral.glsl"
#include "screen/visibility/area_maps/area_light_shadow.glsl"
#include "screen/visibility/area_maps/area_lights_block.glsl"
#include "screen/base/coarse_pixels.glsl"
#include "screen/base/virtual_lights_block.glsl"
#include "screen/gather/interleaved/slots.shared.h"

#ifdef LISTED
layout(local_size_x = LINEAR_GROUP) in;
layout(std430, binding = PIXEL_LIST_SLOT) readonly buffer PixelList { WorkListHead head; uint listed[]; };
#else
layout(local_size_x = SQUARE_GROUP, local_size_y = SQUARE_GROUP) in;
#endif
layout(binding = INDIRECT_IMAGE, rgba32f) uniform image2D indirect;
layout(binding = DIRECT_IMAGE, rgba32f) uniform image2D direct;
uniform int first_of_block;  // its lights[0], in the order of clusters
uniform int first_light;     // taken from the block, in that order
uniform int end_light;
uniform int area_light_count;
uniform int interleave;
uniform ivec2 offset;  // of the pixels in their blocks
uniform float near_zone;
uniform int with_direct;
uniform int begins;
uniform int ends;

#ifdef FROM_AFAR  // near_zone is DISK_FAR_AREAS at least: nearer there is nothing of a light
#define LIGHT_DISK_TO_POINT disk_to_point_from_afar
#else
#define LIGHT_DISK_TO_POINT disk_to_point
#endif

struct Irradiance {
  vec3 reflected, emitted;
};

Irradiance sum_of_lights(int begin, int end, vec3 x, vec3 normal, vec3 geometric) {
  Irradiance sum = Irradiance(vec3(0.0), vec3(0.0));
  for (int i = begin; i < end; ++i) {
    vec3 w = lights[i].position - x;
    float squared = dot(w, w);
    float along = dot(w, normal);
    float height = max(-dot(w, lights[i].normal), 0.0);
    float share = far_share(disk_nearness(squared, lights[i].area_m2), near_zone);
    float form = LIGHT_DISK_TO_POINT(height, along, -dot(normal, lights[i].normal), squared, lights[i].area_m2);
    form = min(min(along, dot(w, geometric)), share) > 0.0 ? form : 0.0;
    vec3 irradiance = lights[i].flux * (share * form);
    if (lights[i].kind == VIRTUAL_LIGHT_EMITTED) sum.emitted += irradiance;
    else sum.reflected += irradiance;
  }
  return sum;
}

// A loop over clusters around one over lights: software rasterizers run both sides of a branch, but leave loops.
Irradiance sum_of_clusters(vec3 x, vec3 normal, vec3 geometric) {
  Irradiance sum = Irradiance(vec3(0.0), vec3(0.0));
  for (int k = lights[first_light - first_of_block].source; k < area_light_count; ++k) {
    int begin = max(area_lights[k].first_light, first_light);
    if (begin >= end_light) break;
    int end = min(area_lights[k].first_light + area_lights[k].light_count, end_light);
    float visibility = area_light_visibility(k, area_lights[k], x, geometric);
    Irradiance cluster = sum_of_lights(begin - first_of_block, end - first_of_block, x, normal, geometric);
    if (begin >= end) continue;  // a cluster without lights has no place either
    sum.reflected += visibility * cluster.reflected;
    sum.emitted += visibility * cluster.emitted;
  }
  return sum;
}

void main() {
#ifdef LISTED
  int index = int(global_index());
  if (index >= int(head.count)) return;
  ivec2 pixel = unpack_pixel(listed[index]);
#else
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy) * interleave + offset;
  if (any(greaterThanEqual(pixel, textureSize(position_map, 0)))) return;
#endif
  vec4 position = texelFetch(position_map, pixel, 0);
  Irradiance sum = Irradiance(vec3(0.0), vec3(0.0));
  if (position.w != 0.0 && first_light < end_light) {
    vec4 normals = texelFetch(normal_map, pixel, 0);
    sum = sum_of_clusters(position.xyz, octahedral_decode(normals.xy), octahedral_decode(normals.zw));
  }
  if (begins == 0) sum.reflected += imageLoad(indirect, pixel).rgb;
  if (begins == 0 && with_direct != 0) sum.emitted += imageLoad(direct, pixel).rgb;
  if (ends != 0) {
    vec3 scale = interleave == 1 ? texelFetch(albedo_map, pixel, 0).rgb / PI : vec3(interleave * interleave);
    sum.reflected *= scale;
    sum.emitted *= scale;
  }
  imageStore(indirect, pixel, vec4(sum.reflected, 1.0));
  if (with_direct != 0) imageStore(direct, pixel, vec4(sum.emitted, 1.0));
}
