#version 450 core
// Every light to the cluster with the nearest center, of those equally near the first. Dong et al. 2009, section 5.1, and how
// far the light is off the center's plane (VirtualAreaLightOptions::plane_weight).
#define CENTERS_UNIFORM
#include "shared/constants.glsl"
#include "shared/global_index.shared.h"
#include "screen/visibility/area_maps/virtual_area_lights.glsl"
#include "shared/group_sizes.shared.h"

layout(local_size_x = LINEAR_GROUP) in;
uniform float weight_per_m;
uniform float weight_per_rad;
uniform float weight_off_plane_per_m;

// Between unit vectors, within 3e-7 rad: twice the arc sine of half the chord, which is at most sqrt(1/2) on the nearer
// of the two sides; asin(sqrt(t)) / sqrt(t) by Chebyshev interpolation over [0, 1/2]. (GLSL leaves acos's error open.)
float angle_between(vec3 a, vec3 b) {
  bool apart = dot(a, b) < 0.0;
  vec3 chord = apart ? a + b : a - b;
  float t = 0.25 * dot(chord, chord);
  float ratio = 0.0999071056;
  ratio = ratio * t - 0.0535424837;
  ratio = ratio * t + 0.0601242776;
  ratio = ratio * t + 0.0390137921;
  ratio = ratio * t + 0.0754907417;
  ratio = ratio * t + 0.166650979;
  ratio = ratio * t + 1.00000008;
  float angle = 2.0 * sqrt(t) * ratio;
  return apart ? PI - angle : angle;
}

uint nearest_cluster(vec3 position, vec3 normal) {
  uint nearest = NO_VIRTUAL_AREA_LIGHT;
  float smallest = 3.0e38;
  uint count = seeded;
  for (uint k = 0u; k < count; ++k) {
    vec3 way = position - centers[k].position;
    float d = weight_per_m * length(way) + weight_per_rad * angle_between(normal, centers[k].normal) +
              weight_off_plane_per_m * abs(dot(way, centers[k].normal));
    if (d < smallest) {
      smallest = d;
      nearest = k;
    }
  }
  return nearest;
}

void main() {
  int i = int(global_index());
  if (iteration > 0 && moved[iteration - 1] == 0u) return;
  if (i >= light_count) {
    cluster_of[i] = NO_VIRTUAL_AREA_LIGHT;
    return;
  }
  uint cluster = has_flux(i) ? nearest_cluster(lights[i].position, lights[i].normal) : NO_VIRTUAL_AREA_LIGHT;
  if (iteration == 0 || cluster_of[i] != cluster) moved[iteration] = 1u;
  cluster_of[i] = cluster;
}
