#version 450 core
// Flux that passes through each candidate [W], luminance.
#include "shared/global_index.shared.h"
#include "screen/visibility/negative/negative_surface.glsl"
#include "shared/group_sizes.shared.h"

layout(local_size_x = LINEAR_GROUP) in;

void main() {
  int candidate = int(global_index());
  if (candidate >= candidate_count()) return;
  ExitSurface surface = exit_surface(candidate);
  PassedLight sum = PassedLight(vec3(0.0), vec3(0.0));
  if (surface.area_m2 > 0.0) {
    for (int i = 0; i < light_count; ++i) add_passed_light(i, surface.position, surface.normal, sum);
  }
  weights[candidate] = luminance(sum.irradiance) * surface.area_m2;
}
