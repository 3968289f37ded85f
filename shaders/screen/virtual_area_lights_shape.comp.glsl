#version 450 core
// Position, axes and area of every cluster's area light. One work group a cluster.
#define GROUP 32
#include "screen/virtual_area_lights.glsl"
#include "screen/virtual_area_lights_reduce.glsl"

layout(std430, binding = 4) buffer AreaLights { VirtualAreaLight area_lights[]; };
layout(std430, binding = 5) readonly buffer Order { uint order[]; };

const float PI = 3.14159265358979;
#define FAR 3.0e38

uint t = gl_LocalInvocationIndex;
int first = 0, end = 0;  // in order[]

// A fixed perpendicular, so that area lights on walls along the axes get the walls' own axes and turn smoothly
// elsewhere.
vec3 right_of(vec3 normal) {
  vec3 axis = abs(normal.x) < 0.70710678 ? vec3(1.0, 0.0, 0.0) : vec3(0.0, 1.0, 0.0);
  return normalize(axis - normal * dot(normal, axis));
}

// A mean may lie where there is no light: beneath a pillar that the lights stand around. Its foot on the plane of the
// normal moves to the nearest disk of twice the radius that a light's area makes. Such disks cover an evenly lit plane:
// no point of it is farther from Halton points than 1.9 radii (measured for 64 to 1024 of them).
vec3 beside_lights(vec3 mean, vec3 normal) {
  float least = FAR;
  vec3 move = vec3(0.0);
  float mover = FAR;
  for (int j = first + int(t); j < end; j += GROUP) {
    uint i = order[j];
    vec3 across = lights[i].position - mean;
    across -= normal * dot(normal, across);
    float away = length(across);
    float excess = max(away - 2.0 * sqrt(lights[i].area_m2 / PI), 0.0);
    if (excess >= least) continue;
    least = excess;
    mover = float(j);
    move = excess > 0.0 ? across * (excess / away) : vec3(0.0);
  }
  float nearest = least_of_group(vec4(least)).x;
  float chosen = least_of_group(vec4(least == nearest ? mover : FAR)).x;
  return mean + sum_of_group(vec4(mover == chosen ? move : vec3(0.0), 0.0)).xyz;
}

// A mean around an edge or on a curved surface may lie inside what the lights lie on: behind their planes. It rises
// along the normal until it is in front of the first of them, and so out of whatever is convex; and to the height of
// any light that it is behind of, as far as that light's plane, and so above a step. The rise is 0 on a plane and in a
// hollow corner, follows the lights without jumps, and stays in the cluster's thickness: to be in front of all planes
// would take it far away for one that stands upright.
vec3 in_front(vec3 foot, vec3 normal) {
  vec2 rise = vec2(FAR, 0.0);  // to the first plane; to the lights behind
  for (int j = first + int(t); j < end; j += GROUP) {
    uint i = order[j];
    vec3 d = lights[i].position - foot;
    float behind = dot(d, lights[i].normal);
    float cosine = dot(normal, lights[i].normal);
    if (cosine <= 0.0) continue;
    float to_plane = behind / cosine;
    rise = vec2(min(rise.x, to_plane), max(rise.y, min(to_plane, dot(d, normal))));
  }
  vec4 least = least_of_group(vec4(rise.x, -rise.y, 0.0, 0.0));
  return foot + normal * max(least.x < FAR ? least.x : 0.0, -least.y);
}

// Edges of the bounding rectangle of the lights' projections along `right` and `up`.
vec2 rectangle(vec3 middle, vec3 right, vec3 up) {
  vec4 bounds = vec4(FAR);  // least of s, t, -s, -t
  for (int j = first + int(t); j < end; j += GROUP) {
    vec3 d = lights[order[j]].position - middle;
    vec2 st = vec2(dot(d, right), dot(d, up));
    bounds = min(bounds, vec4(st, -st));
  }
  bounds = least_of_group(bounds);
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
  vec3 middle = in_front(beside_lights(position.xyz / float(count), normal), normal);
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
