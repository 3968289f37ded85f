#version 450 core
// Flux of all lights, mean of the bands [W], always in the same order of additions. One work group.
#include "screen/base/virtual_lights.glsl"
#include "screen/views/lights_view.glsl"

#define LANES 256

layout(local_size_x = LANES) in;
layout(std430, binding = TOTAL_FLUX_SLOT) writeonly buffer Total { float total_flux; };
uniform int count;

shared float part[LANES];

void main() {
  int lane = int(gl_LocalInvocationIndex);
  float sum = 0.0;
  for (int i = lane; i < count; i += LANES) sum += mean_flux(lights[i].flux);
  part[lane] = sum;
  barrier();
  for (int half_size = LANES / 2; half_size > 0; half_size /= 2) {
    if (lane < half_size) part[lane] += part[lane + half_size];
    barrier();
  }
  if (lane == 0) total_flux = part[0];
}
