// Nichols 2010, §4.2.4.1: a patch gives way to its four parts where the bound of what it gives, eq. 4.7, exceeds the
// threshold; which is where it is as near as eq. 4.8 says. Depth first, as parts follow on one another.
#include "screen/lights/patches/light_patch.shared.h"

layout(binding = PATCH_TREE_UNIT) uniform samplerBuffer patch_thirds;  // LightPatch in three thirds each
uniform int root_count;
uniform int deepest;      // traversal depth
uniform float near_share;  // (1 - tau) / (pi tau): a patch is refined within this many of its bounding areas

#ifdef CLUSTERS
layout(std430, binding = CLUSTER_OF_SLOT) readonly buffer Clusters { uint cluster_of[]; };
#endif

vec3 light_of_root(Receiver at, int root) {
  vec3 sum = vec3(0.0);
  int depth = 0, i = root;
  do {
    int at_node = 3 * (first_of_depth(root_count, depth) + i);
    vec4 place = texelFetch(patch_thirds, at_node), normal = texelFetch(patch_thirds, at_node + 1);
    vec3 w = place.xyz - at.position;
    bool down = depth < deepest && dot(w, w) <= near_share * normal.w;
    if (!down) {
      vec3 flux = texelFetch(patch_thirds, at_node + 2).rgb;
      sum += light_at(place.xyz, normal.xyz, place.w, flux, at);
    }
    // Its first part; or the next patch, of a depth above where four are done.
    int up = down ? -1 : min(findLSB(i + 1) / 2, depth);
    i = down ? 4 * i : (i + 1) >> (2 * up);
    depth -= up;
  } while (depth > 0);
  return sum;
}

vec3 sum_of_lights(Receiver at) {
  vec3 sum = vec3(0.0);
  for (int root = 0; root < root_count; ++root) {
    vec3 light = light_of_root(at, root);
#ifdef CLUSTERS
    // Parts inherit the cluster of their root.
    uint k = cluster_of[root];
    if (light != vec3(0.0) && k != NO_VIRTUAL_AREA_LIGHT)
      light *= area_light_visibility(int(k), area_lights[k], at.position, at.geometric);
#endif
    sum += light;
  }
  return sum;
}
