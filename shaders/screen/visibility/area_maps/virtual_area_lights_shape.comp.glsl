#version 450 core
// Position, axes and area of every cluster's area light. One work group a cluster.
#define GROUP 32
#include "screen/visibility/area_maps/virtual_area_lights.glsl"
#include "screen/visibility/area_maps/virtual_area_lights_reduce.glsl"

layout(std430, binding = MADE_AREA_LIGHTS_SLOT) buffer AreaLights { VirtualAreaLight area_lights[]; };
layout(std430, binding = MADE_ORDER_SLOT) readonly buffer Order { uint order[]; };

uniform bool at_mean;       // VirtualAreaLightOptions::position
uniform int any_light;      // 1: the position is that of any light instead
uniform float which_light;  // in [0, 1)

#define FAR 3.0e38

uint t = gl_LocalInvocationIndex;
int first = 0, end = 0;  // in order[]

// A fixed perpendicular, so that area lights on walls along the axes get the walls' own axes and turn smoothly
// elsewhere.
vec3 right_of(vec3 normal) {
  vec3 axis = abs(normal.x) < 0.70710678 ? vec3(1.0, 0.0, 0.0) : vec3(0.0, 1.0, 0.0);
  return normalize(axis - normal * dot(normal, axis));
}

// The light nearest to the mean of all. The mean itself may lie inside what the lights lie on, beneath a pillar that
// they stand around, or behind a sill; moved out of all these as little as it takes, it still saw what none of them sees
// (atrium: 84 % instead of 45 %).
vec3 nearest_light(vec3 mean) {
  float smallest = FAR;
  float which = FAR;
  for (int j = first + int(t); j < end; j += GROUP) {
    vec3 d = lights[order[j]].position - mean;
    float squared = dot(d, d);
    if (squared >= smallest) continue;
    smallest = squared;
    which = float(j);
  }
  float nearest = min_of_group(vec4(smallest)).x;
  return lights[order[int(min_of_group(vec4(smallest == nearest ? which : FAR)).x)]].position;
}

// Edges of the bounding rectangle of the lights' projections along `right` and `up`.
vec2 rectangle(vec3 middle, vec3 right, vec3 up) {
  vec4 bounds = vec4(FAR);  // least of s, t, -s, -t
  for (int j = first + int(t); j < end; j += GROUP) {
    vec3 d = lights[order[j]].position - middle;
    vec2 st = vec2(dot(d, right), dot(d, up));
    bounds = min(bounds, vec4(st, -st));
  }
  bounds = min_of_group(bounds);
  return -bounds.xy - bounds.zw;
}

void main() {
  uint cluster = gl_WorkGroupID.x;
  int count = area_lights[cluster].light_count;
  if (count == 0) return;
  first = area_lights[cluster].first_light;
  end = first + count;
  vec4 position = vec4(0.0), flux = vec4(0.0);  // flux and area
  vec3 normal = vec3(0.0);
  for (int j = first + int(t); j < end; j += GROUP) {
    uint i = order[j];
    position.xyz += lights[i].position;
    normal += lights[i].normal;
    flux += vec4(lights[i].flux, lights[i].area_m2);
  }
  position = sum_of_group(position);
  normal = sum_of_group(vec4(normal, 0.0)).xyz;
  flux = sum_of_group(flux);
  float sum = length(normal);
  if (count > 1) normal = sum > 1e-3 * float(count) ? normal / sum : centers[cluster].normal;
  vec3 middle = position.xyz / float(count);
  if (any_light != 0) {
    // Other ones in every cluster: multiples of the golden ratio.
    float at = fract(which_light + 0.618034 * float(cluster));
    middle = lights[order[first + min(int(at * float(count)), count - 1)]].position;
  } else if (!at_mean) {
    middle = nearest_light(middle);
  }
  vec3 right = right_of(normal);
  vec2 edges = rectangle(middle, right, cross(normal, right));
  if (t != 0u) return;
  area_lights[cluster].position = middle;
  area_lights[cluster].normal = normal;
  area_lights[cluster].right = right;
  area_lights[cluster].flux = flux.xyz;
  float area = max(edges.x * edges.y, flux.w);
  area_lights[cluster].area_m2 = area;
  area_lights[cluster].size_m = sqrt(area);
}
