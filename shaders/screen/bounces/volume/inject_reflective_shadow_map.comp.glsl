#version 450 core
// Deposits the light that the texels of one light's reflective shadow map reflect. A thread takes 4 x 4 texels; those that
// lie on the first one's plane, within half a cell of it, go to one place with all their power.
#include "shared/group_sizes.shared.h"
#include "shared/reflective_shadow_map.glsl"
#include "propagation/deposit.glsl"

layout(local_size_x = SQUARE_GROUP, local_size_y = SQUARE_GROUP) in;
uniform int light;
uniform int resolution;

void main() {
  ivec2 first = 4 * ivec2(gl_GlobalInvocationID.xy);
  if (first.x >= resolution || first.y >= resolution) return;
  vec3 group_start = vec3(0.0), group_normal = vec3(0.0), group_flux = vec3(0.0), offset_sum = vec3(0.0);
  float count = 0.0;
  for (int k = 0; k < 16; ++k) {
    ivec2 texel = first + ivec2(k & 3, k >> 2);
    vec3 position, normal, irradiance_flux, albedo;
    if (!rsm_texel(light, int(gl_GlobalInvocationID.z), texel, position, normal, irradiance_flux, albedo)) continue;
    vec3 flux = irradiance_flux * albedo;
    vec3 offset = position - group_start;
    bool same_plane = dot(normal, group_normal) > 0.999 && abs(dot(offset, group_normal)) < 0.02 * grid.cell_size_m;
    if (count == 0.0) {
      group_start = position;
      group_normal = normal;
      offset = vec3(0.0);
    } else if (!same_plane || dot(offset, offset) > 0.25 * grid.cell_size_m * grid.cell_size_m) {
      deposit(position, normal, flux);
      continue;
    }
    group_flux += flux;
    offset_sum += offset;
    count += 1.0;
  }
  if (count > 0.0) deposit(group_start + offset_sum / count, group_normal, group_flux);
}
