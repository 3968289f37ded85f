// What the passes that cluster virtual lights share. Dong et al. 2009, sections 5 and 6.
#include "screen/base/virtual_lights.glsl"
#include "screen/visibility/area_maps/slots.shared.h"
#include "screen/visibility/area_maps/virtual_area_light.shared.h"

struct ClusterCenter {
  vec3 position;
  vec3 normal;
};

#ifdef CENTERS_UNIFORM
layout(std140, binding = CENTERS_BLOCK) uniform Centers { ClusterCenter centers[MAX_VIRTUAL_AREA_LIGHTS]; };
#else
layout(std430, binding = CENTERS_SLOT) buffer Centers { ClusterCenter centers[]; };
#endif
#ifdef CLUSTERS_AS_UVEC4
layout(std430, binding = MADE_CLUSTER_OF_SLOT) readonly buffer ClusterOf { uvec4 clusters_as_uvec4[]; };
#else
// Behind the lights NO_VIRTUAL_AREA_LIGHT.
layout(std430, binding = MADE_CLUSTER_OF_SLOT) buffer ClusterOf { uint cluster_of[]; };
#endif
layout(std430, binding = PROGRESS_SLOT) buffer Progress {
  uint seeded;   // clusters with a seed; the others stay empty
  uint moved[];  // of every iteration: whether a light changed its cluster
};
uniform int light_count;
uniform int iteration;

bool has_flux(int i) { return max(lights[i].flux.x, max(lights[i].flux.y, lights[i].flux.z)) > 0.0; }
