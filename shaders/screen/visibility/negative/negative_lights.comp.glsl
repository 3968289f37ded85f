#version 450 core
// Places negative lights, one to a work group. Cochran and Steele 2007, section 3.3.
// PASSED_FLUX: on candidates, chosen by the flux that passes through them; else on pixels of a Halton sequence.
#include "screen/base/halton_pixel.glsl"
#include "screen/visibility/negative/negative_surface.glsl"
#ifdef SIDES
#include "screen/visibility/negative/first_passage.glsl"
#endif
#include "screen/visibility/negative/negative_light.shared.h"
#include "screen/visibility/negative/slots.shared.h"

layout(local_size_x = 64) in;
layout(std430, binding = PLACED_LIGHTS_SLOT) writeonly buffer Negative { NegativeLight negative_lights[]; };
uniform int negative_count;

shared vec3 irradiance_part[64];
shared vec3 direction_part[64];

#ifdef PASSED_FLUX
uniform float in_step;  // where in each of the steps, from 0 to 1

// A candidate chosen with probability p stands for 1 / (count p) of itself. Sums that threads made apart may fall by a
// rounding between two candidates: one met there has no weight of its own, and stands for nothing.
ExitSurface chosen_surface(int k) {
  int candidate = candidate_at(total_weight() * (float(k) + in_step) / float(negative_count));
  ExitSurface surface = exit_surface(candidate);
  float weight = weight_of(candidate);
  surface.area_m2 *= weight > 0.0 ? total_weight() / (float(negative_count) * weight) : 0.0;
  return surface;
}
#else
uniform uint first_point;  // of Halton's sequence

ExitSurface chosen_surface(int k) {
  ivec2 size = textureSize(position_map, 0);
  return exit_surface_of_pixel(halton_pixel(first_point + uint(k), size), float(size.x) * float(size.y) / float(negative_count));
}
#endif

#ifdef SIDES
bool enters_first(ExitSurface surface, int light) {
  if (dot(surface.position - lights[light].position, surface.normal) <= 0.0) return false;
  vec3 source = cell_from_world(grid, lights[light].position) + lights[light].normal;
  return is_first_passage(cell_from_world(grid, surface.position), surface.cell, source);
}
#endif

// Exponent of a lobe cos^e whose mean direction is as long as that of the light: (e + 1) / (e + 2) = length. At most 998,
// which is 1.8 degrees wide (1 / sqrt(e)): a single light's lobe would have no width.
float lobe_exponent(float mean_length) {
  float r = min(mean_length, 0.999);
  return max((2.0 * r - 1.0) / (1.0 - r), 1.0);
}

void main() {
  int k = int(gl_WorkGroupID.x);
  uint thread = gl_LocalInvocationIndex;
  ExitSurface surface = chosen_surface(k);
  PassedLight sum = PassedLight(vec3(0.0), vec3(0.0));
  if (surface.area_m2 > 0.0) {
    for (int i = int(thread); i < light_count; i += 64) {
#ifdef SIDES
      if (!enters_first(surface, i)) continue;
#endif
      add_passed_light(i, surface.position, surface.normal, sum);
    }
  }
  irradiance_part[thread] = sum.irradiance;
  direction_part[thread] = sum.direction;
  barrier();
  if (thread != 0u) return;
  sum = PassedLight(vec3(0.0), vec3(0.0));
  for (int i = 0; i < 64; ++i) {
    sum.irradiance += irradiance_part[i];
    sum.direction += direction_part[i];
  }
  float weight = luminance(sum.irradiance);
  if (weight <= 0.0) {
    negative_lights[k] = NegativeLight(vec3(0.0), 1.0, vec3(0.0, 0.0, 1.0), 1.0, vec3(0.0), 0.0);
    return;
  }
#ifdef PASSED_FLUX
  float exponent = lobe_exponent(length(sum.direction) / weight);
#else
  float exponent = 1.0;
#endif
  negative_lights[k] = NegativeLight(surface.position, surface.area_m2, normalize(sum.direction), exponent,
                                     sum.irradiance * surface.area_m2, 0.0);
}
