// Irradiance of all lights at a point, by a soft cut through the light tree.
#ifndef VOLGI_LIGHT_CUT_GLSL
#define VOLGI_LIGHT_CUT_GLSL
#include "screen/gather/multires/light_tree.glsl"
#include "screen/visibility/area_maps/area_light_shadow.glsl"
#include "screen/visibility/area_maps/area_lights_block.glsl"
#include "shared/disk_to_point.shared.h"
#include "shared/octahedral.glsl"
#include "shared/virtual_light.shared.h"

// LightNode, LIGHT_NODE_TEXELS each. A buffer texture: software rasterizers read it faster than storage.
layout(binding = LIGHT_NODES_UNIT) uniform samplerBuffer node_texels;
layout(std430, binding = LIGHT_ROOTS_SLOT) readonly buffer LightRoots { int first_root[]; };
uniform int area_light_count;
uniform int seen_level;  // of nodes that are worth a virtual light
uniform float zone;

#define UNHIDDEN_ZONE 0.5  // sizes of a virtual light

struct Receiver {
  vec3 position, normal, geometric;
};

struct Irradiance {
  vec3 reflected, emitted;
};

// A node as a point sees it.
struct SeenNode {
  vec3 irradiance;  // of all of it, as of a disk
  float squared;    // distance [m^2]
  float size_m2;
  bool emitted;
  bool has_light;  // it or its parts may light the point
};

// Mean height over a plane of a disk whose middle is at `height` and whose rim rises by `reach` over that: of what lies
// over the plane, over all of the disk.
float height_over(float height, float reach) {
  float t = clamp(height / max(reach, 1e-30), -1.0, 1.0);
  float part = (t * acos(-t) + sqrt(1.0 - t * t) * (2.0 + t * t) / 3.0) * (1.0 / 3.14159265);
  return abs(t) < 1.0 ? reach * part : max(height, 0.0);
}

#define SPAN_OF_DEVIATION 1.7320508  // half of a uniform span, over its standard deviation

// What a sum of lights gives that is no disk [m^-2]: parts that lie behind, or under the point's horizon, give nothing,
// the second order of its spread is that of its axes, and normals that turn away from their mean take light from it.
// @param w  from the point. The others as disk_to_point() has them.
float form_of_sum(Receiver at, int node, bool few, vec3 w, float height, float along, float facing, float squared,
                  float area_m2) {
  vec4 spread = texelFetch(node_texels, LIGHT_NODE_TEXELS * node + 3);
  vec2 turned = unpackHalf2x16(floatBitsToUint(spread.w));
  float more = 0.5 * dot(spread.xyz, spread.xyz), up_stretch = dot(at.normal, spread.xyz);
  float w_stretch = dot(w, spread.xyz), off_plane = turned.x * turned.x * area_m2;
  float in_plane = 0.5 * (area_m2 * (0.5 / 3.14159265) - off_plane) - more;
  float rise_2 = in_plane * (1.0 - facing * facing) + up_stretch * up_stretch + off_plane * facing * facing;
  // Four lights are seen or not, each whole.
  if (!few) along = height_over(along, SPAN_OF_DEVIATION * sqrt(max(rise_2, 0.0)));
  float fan = 0.25 * max(1.0 - turned.y * turned.y, 0.0) * squared;
  height = height_over(height, 2.0 * sqrt(off_plane + fan));
  float form = disk_to_point(height, along, facing, squared, area_m2);
  float bent = w_stretch * w_stretch - more * (squared - height * height);
  float lean = w_stretch * up_stretch - more * (along - facing * height);
  float inverse = 1.0 / (squared + 1e-30);
  form += height * (12.0 * along * bent * inverse - 4.0 * lean) * (inverse * inverse * inverse * (1.0 / 3.14159265));
  return along > 0.0 ? max(form, 0.0) * turned.y : 0.0;
}

SeenNode seen_node(Receiver at, int node, int level) {
  vec4 place = texelFetch(node_texels, LIGHT_NODE_TEXELS * node);
  vec4 light = texelFetch(node_texels, LIGHT_NODE_TEXELS * node + 1);
  vec4 bounds = texelFetch(node_texels, LIGHT_NODE_TEXELS * node + 2);
  vec3 w = place.xyz - at.position;
  vec3 normal = octahedral_decode(unpackSnorm2x16(floatBitsToUint(light.w)));
  float squared = dot(w, w);
  float along = dot(w, at.normal), above = dot(w, at.geometric), height = -dot(w, normal);
  float facing = -dot(normal, at.normal);
  bool has_light = light.rgb != vec3(0.0) && above > -bounds.y && height > bounds.z;
  float form = level == 0 ? disk_to_point(max(height, 0.0), along, facing, squared, place.w)
                          : form_of_sum(at, node, level == 1, w, height, along, facing, squared, place.w);
  form = min(form, 0.5 * (1.0 + facing) / max(place.w, 1e-30));  // of the whole plane: none of its disks gives more
  bool gives = has_light && (level > 1 || min(along, above) > 0.0);
  int kind = floatBitsToInt(bounds.w);
  return SeenNode(gives ? light.rgb * form : vec3(0.0), squared, level == 0 ? 0.0 : node_size(place.w, kind),
                  (kind & NODE_KIND_BITS) == VIRTUAL_LIGHT_EMITTED, has_light);
}

void add_light(vec3 irradiance, bool emitted, inout Irradiance sum) {
#ifdef WITH_DIRECT
  sum.emitted += emitted ? irradiance : vec3(0.0);
  sum.reflected += emitted ? vec3(0.0) : irradiance;
#else
  sum.reflected += irradiance;
#endif
}

// A root and what is below it, depth first. All of it is seen as far as its cluster is, but nothing is taken to hide a
// light from what is nearer than it is large: its cluster's map, drawn from elsewhere, knows nothing of such ways.
void add_root(Receiver at, int root, float visibility, inout Irradiance sum) {
  int level = top_level;
  int i = root;
  float seen = visibility;
  // What nodes above have not taken, of the light of each level's node; vectors, as software rasterizers index arrays
  // slowly.
  vec4 left_low = vec4(1.0), left_high = vec4(1.0);
  bool done = false;
  while (!done) {
    SeenNode node = seen_node(at, first_of_level(level) + i, level);
    float hidden = (1.0 - visibility) * node_share(node.squared, abs(node.size_m2), UNHIDDEN_ZONE);
    seen = level > seen_level ? visibility : level == seen_level ? 1.0 - hidden : seen;
    float own = level > 0 ? node_share(node.squared, node.size_m2, zone) : 1.0;
    bvec4 is_low = equal(ivec4(0, 1, 2, 3), ivec4(level)), is_high = equal(ivec4(4, 5, 6, 7), ivec4(level));
    float here = dot(left_low, vec4(is_low)) + dot(left_high, vec4(is_high));
    add_light(node.irradiance * (own * here * seen), node.emitted, sum);
    // The first part, or the next node: of this level, or of one above where four are done.
    bool down = own < 1.0 && node.has_light;
    int up = down ? -1 : min(findLSB(i + 1) / 2, top_level - level);
    i = down ? 4 * i : (i + 1) >> (2 * up);
    level += up;
    vec4 for_parts = vec4(here * (1.0 - own));
    left_low = mix(left_low, for_parts, equal(ivec4(0, 1, 2, 3), ivec4(down ? level : -1)));
    left_high = mix(left_high, for_parts, equal(ivec4(4, 5, 6, 7), ivec4(down ? level : -1)));
    done = level == top_level;
  }
}

// Whether a point may see something of a node.
bool may_see(Receiver at, int node) {
  vec4 place = texelFetch(node_texels, LIGHT_NODE_TEXELS * node), light = texelFetch(node_texels, LIGHT_NODE_TEXELS * node + 1);
  vec4 bounds = texelFetch(node_texels, LIGHT_NODE_TEXELS * node + 2);
  vec3 w = place.xyz - at.position;
  vec3 normal = octahedral_decode(unpackSnorm2x16(floatBitsToUint(light.w)));
  return light.rgb != vec3(0.0) && dot(w, at.geometric) > -bounds.y && -dot(w, normal) > bounds.z;
}

Irradiance irradiance_of_lights(Receiver at) {
  Irradiance sum = Irradiance(vec3(0.0), vec3(0.0));
  int first = first_of_level(top_level), roots = first_root[area_light_count];
  // By 32: first which of them are seen at all, then those, so that nobody waits for a map that others look at.
  for (int begin = 0; begin < roots; begin += 32) {
    uint seen_roots = 0u;
    int end = min(begin + 32, roots);
    for (int k = begin; k < end; ++k) seen_roots |= may_see(at, first + k) ? 1u << uint(k - begin) : 0u;
    while (seen_roots != 0u) {
      int k = begin + findLSB(seen_roots);
      seen_roots &= seen_roots - 1u;
      int cluster = floatBitsToInt(texelFetch(node_texels, LIGHT_NODE_TEXELS * (first + k) + 2).w) >> NODE_CLUSTER_SHIFT;
      float visibility = area_light_visibility(cluster, area_lights[cluster], at.position, at.geometric);
      add_root(at, k, visibility, sum);
    }
  }
  return sum;
}

#endif
