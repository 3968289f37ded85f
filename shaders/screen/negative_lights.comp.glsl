#version 450 core
// Places negative lights, one to a work group. Cochran and Steele 2007, section 3.3.
// PASSED_FLUX: on candidates, chosen by the flux that passes through them; else on pixels of a Halton sequence.
#include "screen/negative_surface.glsl"
#ifdef SIDES
#include "screen/first_passage.glsl"
#endif
#include "shared/negative_light.shared.h"

layout(local_size_x = 64) in;
layout(std430, binding = 1) writeonly buffer Negative { NegativeLight negative_lights[]; };
uniform int negative_count;

shared vec3 irradiance_part[64];
shared vec3 direction_part[64];

float radical_inverse_3(uint i) {
  float sum = 0.0, digit = 1.0 / 3.0;
  for (; i > 0u; i /= 3u, digit /= 3.0) sum += float(i % 3u) * digit;
  return sum;
}

#ifdef PASSED_FLUX
// A candidate chosen with probability p stands for 1 / (count p) of itself.
ExitSurface chosen_surface(int k) {
  int candidate = candidate_at(total_weight() * (float(k) + 0.5) / float(negative_count));
  ExitSurface surface = exit_surface(candidate);
  surface.area_m2 *= total_weight() / (float(negative_count) * weight_of(candidate));
  return surface;
}
#else
ExitSurface chosen_surface(int k) {
  vec2 halton = vec2(float(bitfieldReverse(uint(k + 1))) / 4294967296.0, radical_inverse_3(uint(k + 1)));
  ivec2 size = textureSize(position_map, 0);
  ivec2 pixel = min(ivec2(halton * vec2(size)), size - 1);
  return exit_surface_of_pixel(pixel, float(size.x) * float(size.y) / float(negative_count));
}
#endif

#ifdef SIDES
bool enters_first(ExitSurface surface, int light) {
  if (dot(surface.position - lights[light].position, surface.normal) <= 0.0) return false;
  vec3 source = cell_from_world(grid, lights[light].position) + lights[light].normal;
  return is_first_passage(cell_from_world(grid, surface.position), surface.cell, source);
}
#endif

// Exponent of a lobe cos^e whose mean direction is as long as that of the light: (e + 1) / (e + 2) = length.
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
  float area = surface.area_m2;
  float exponent = lobe_exponent(length(sum.direction) / weight);
#else
  float area = surface.area_m2;
  float exponent = 1.0;
#endif
  negative_lights[k] =
      NegativeLight(surface.position, area, normalize(sum.direction), exponent, sum.irradiance * area, 0.0);
}
