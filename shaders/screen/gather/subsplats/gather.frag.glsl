#version 450 core
// Irradiance of virtual lights at the fragments that the stencil has marked (Nichols 2010, §4.2.1.2), added to what
// earlier blocks of lights have given. CLUSTERS: each seen as far as its cluster's map sees. TREE: by a traversal of
// the tree of patches for each fragment (§4.2.4.1). NEGATIVE: instead, what negative lights take away.
#include "screen/base/virtual_lights_block.glsl"
#include "screen/gather/subsplats/slots.shared.h"
#include "screen/gather/subsplats/subsplat_light.glsl"
#ifdef CLUSTERS
#include "screen/visibility/area_maps/area_light_shadow.glsl"
#include "screen/visibility/area_maps/area_lights_block.glsl"
#endif

layout(early_fragment_tests) in;
layout(location = 0) out vec4 irradiance;  // w > 0: there is light
uniform ivec2 picture_size;
uniform int last_level;
uniform int finest_level;

#if defined(NEGATIVE)
#include "screen/gather/subsplats/negative_sum.glsl"
#elif defined(TREE)
#include "screen/gather/subsplats/patch_traversal.glsl"
#else
layout(std430, binding = CACHE_SIZE_SLOT) readonly buffer CacheSize { int cached_lights; };
uniform int first_of_block;

vec3 sum_of_lights(Receiver at) {
  vec3 sum = vec3(0.0);
  int end = min(cached_lights - first_of_block, VIRTUAL_LIGHTS_PER_BLOCK);
#ifdef CLUSTERS
  // The cache is in the order of clusters: a loop over them around one over lights, with one look-up each.
  int i = 0;
  while (i < end) {
    int k = lights[i].source;
    vec3 cluster = vec3(0.0);
    for (; i < end && lights[i].source == k; ++i)
      cluster += light_at(lights[i], at);
    if (cluster != vec3(0.0)) sum += cluster * area_light_visibility(k, area_lights[k], at.position, at.geometric);
  }
#else
  for (int i = 0; i < end; ++i)
    sum += light_at(lights[i], at);
#endif
  return sum;
}
#endif

void main() {
  Subsplat s = subsplat_at(picture_size, last_level, ivec2(gl_FragCoord.xy));
  vec3 sum = sum_of_lights(receiver_of(s, picture_size, s.level > finest_level));
#ifdef NEGATIVE
  irradiance = vec4(sum, 0.0);
#else
  irradiance = vec4(sum, 1.0);
#endif
}
