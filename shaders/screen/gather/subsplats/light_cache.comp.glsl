#version 450 core
// The cache of virtual lights (Nichols 2010, §4.2.1.2): those that have flux, one behind the other, in their order.
// CLUSTERED: in the order of clusters, whose numbers they take for their sources; no scan is needed, as what has no
// flux comes last there. COUNT: what the scan starts from.
#include "screen/base/virtual_lights.glsl"
#include "screen/gather/subsplats/slots.shared.h"
#include "shared/global_index.shared.h"
#include "shared/group_sizes.shared.h"
#ifdef CLUSTERED
#include "screen/visibility/area_maps/slots.shared.h"
#include "screen/visibility/area_maps/virtual_area_light.shared.h"
layout(std430, binding = LIGHT_ORDER_SLOT) readonly buffer Order { uint order[]; };
layout(std430, binding = CLUSTER_OF_SLOT) readonly buffer Clusters { uint cluster_of[]; };
#else
layout(std430, binding = CACHE_STARTS_SLOT) buffer Starts { uint starts[]; };
#endif

layout(local_size_x = LINEAR_GROUP) in;
layout(std430, binding = CACHED_LIGHTS_SLOT) writeonly buffer Cached { VirtualLight cached[]; };
layout(std430, binding = CACHE_SIZE_SLOT) writeonly buffer CacheSize { int cached_lights; };
uniform int light_count;

bool has_light(int i) { return lights[i].flux.r + lights[i].flux.g + lights[i].flux.b > 0.0; }

void main() {
  int i = int(global_index());
  if (i >= light_count) return;
#ifdef CLUSTERED
  uint light = order[i];
  if (cluster_of[light] == NO_VIRTUAL_AREA_LIGHT) return;
  VirtualLight copy = lights[light];
  copy.source = int(cluster_of[light]);
  cached[i] = copy;
  if (i + 1 == light_count || cluster_of[order[i + 1]] == NO_VIRTUAL_AREA_LIGHT) cached_lights = i + 1;
#elif defined(COUNT)
  starts[i] = has_light(i) ? 1u : 0u;
#else
  int at = int(starts[i]);
  if (has_light(i)) cached[at] = lights[i];
  if (i + 1 == light_count) cached_lights = at + (has_light(i) ? 1 : 0);
#endif
}
