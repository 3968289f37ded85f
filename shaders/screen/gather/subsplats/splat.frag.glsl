#version 450 core
// What one light gives one subsplat, added to the flattened buffer. CLUSTERS: as far as its cluster's map sees.
// NEGATIVE: instead, what all negative lights take away.
#include "screen/base/virtual_lights_block.glsl"
#include "screen/gather/subsplats/slots.shared.h"
#include "screen/gather/subsplats/subsplat_light.glsl"
#ifdef CLUSTERS
#include "screen/visibility/area_maps/area_light_shadow.glsl"
#include "screen/visibility/area_maps/area_lights_block.glsl"
#endif
#ifdef NEGATIVE
#include "screen/gather/subsplats/negative_sum.glsl"
#endif

layout(location = 0) out vec4 irradiance;  // w > 0: there is light
uniform ivec2 picture_size;
uniform int finest_level;
flat in uint packed_subsplat;
flat in int light;

void main() {
  Subsplat s = unpack_subsplat(packed_subsplat);
  Receiver at = receiver_of(s, picture_size, s.level > finest_level);
#ifdef NEGATIVE
  irradiance = vec4(sum_of_lights(at), 0.0);
#else
  vec3 given = light_at(lights[light], at);
#ifdef CLUSTERS
  int k = lights[light].source;
  if (given != vec3(0.0)) given *= area_light_visibility(k, area_lights[k], at.position, at.geometric);
#endif
  irradiance = vec4(given, 1.0);
#endif
}
