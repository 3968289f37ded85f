#version 450 core
// Adds one source's fixed-point deposits to the flux per side and clears them for the next source.
#include "shared/global_index.shared.h"

layout(local_size_x = 64) in;
layout(std430, binding = 5) readonly buffer SideCount { uint side_count; };
layout(std430, binding = 9) buffer Source { vec4 source_flux[]; };
layout(std430, binding = 12) buffer FluxFixed { uint flux_fixed[]; };
layout(std430, binding = 13) buffer FluxLost { uint flux_lost[3]; };
layout(std430, binding = 11) buffer Lost { vec4 lost_flux; };
uniform float flux_unit;

void main() {
  uint i = global_index();
  if (i == 0u) {
    lost_flux.rgb += flux_unit * vec3(flux_lost[0], flux_lost[1], flux_lost[2]);
    for (int band = 0; band < 3; ++band) flux_lost[band] = 0u;
  }
  if (i >= side_count) return;
  source_flux[i].rgb += flux_unit * vec3(flux_fixed[3u * i], flux_fixed[3u * i + 1u], flux_fixed[3u * i + 2u]);
  for (uint band = 0u; band < 3u; ++band) flux_fixed[3u * i + band] = 0u;
}
