#version 450 core
// Adds one source's fixed-point deposits to the flux per side and clears them for the next source.
#include "propagation/slots.shared.h"
#include "shared/global_index.shared.h"
#include "propagation/fixed_flux.glsl"
#include "shared/group_sizes.shared.h"
#include "voxel/side_count.glsl"

layout(local_size_x = LINEAR_GROUP) in;
layout(std430, binding = SOURCE_SLOT) buffer Source { vec4 source_flux[]; };
layout(std430, binding = LOST_SLOT) buffer Lost { vec4 lost_flux; };

void main() {
  uint i = global_index();
  if (i == 0u) {
    for (int band = 0; band < 3; ++band) {
      lost_flux[band] += source_power * share_from_fixed(flux_lost[band]);
      flux_lost[band] = uvec2(0u);
    }
  }
  if (i >= side_count) return;
  for (uint band = 0u; band < 3u; ++band) {
    source_flux[i][band] += source_power * share_from_fixed(flux_fixed[3u * i + band]);
    flux_fixed[3u * i + band] = uvec2(0u);
  }
}
