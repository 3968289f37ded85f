#version 450 core
// Irradiance of every pixel from the radiance of the cells around a point half a cell in front of its surface, as spherical
// harmonics: trilinear, dot product with the clamped cosine. Gaitatzes 2010 section 4.3, eq. 9-12: "from the eight closest
// grid points only the ones corresponding to occupied voxels".
// Set by the program: ORDER = 2
#include "shared/constants.glsl"
#include "screen/base/gbuffer.glsl"
#include "screen/bounces/volume/slots.shared.h"
#include "shared/octahedral.glsl"
#include "shared/sh.shared.h"
#include "voxel/grid_block.glsl"

layout(binding = RADIANCE_UNIT) uniform sampler3D radiance_sh;        // coefficients stacked in z
layout(binding = OCCUPANCY_UNIT) uniform sampler3D normal_occupancy;  // w: occupancy
uniform bool occupied_only;

layout(location = 0) out vec4 direct_radiance;
layout(location = 1) out vec4 indirect_radiance;

vec3 coefficient(ivec3 cell, int i) { return texelFetch(radiance_sh, cell + ivec3(0, 0, i * grid.cells.z), 0).rgb; }

// Irradiance on a surface of normal n: the directions of radiance are those that light travels, so the cosine is about -n.
vec3 irradiance_of_cell(ivec3 cell, vec3 n) {
  vec4 low = sh_basis_1(-n);
  vec3 sum = PI * coefficient(cell, 0);
  for (int i = 1; i < 4; ++i) sum += (2.0 * PI / 3.0) * low[i] * coefficient(cell, i);
#if ORDER == 2
  vec4 mid = sh_basis_2(-n);
  for (int i = 0; i < 4; ++i) sum += (PI / 4.0) * mid[i] * coefficient(cell, 4 + i);
  sum += (PI / 4.0) * sh_basis_22(-n) * coefficient(cell, 8);
#endif
  return sum / sqrt(4.0 * PI);
}

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec4 position = texelFetch(position_map, pixel, 0);
  direct_radiance = vec4(0.0);
  indirect_radiance = vec4(0.0);
  if (position.w == 0.0) return;
  vec3 normal = octahedral_decode(texelFetch(normal_map, pixel, 0).zw);  // geometric
  vec3 point = cell_from_world(grid, position.xyz) + 0.5 * normal - 0.5;  // in cells, from their centres
  vec3 low = floor(point);
  vec3 t = point - low;
  vec4 sum = vec4(0.0);
  for (int k = 0; k < 8; ++k) {
    ivec3 corner = ivec3(k & 1, (k >> 1) & 1, k >> 2);
    ivec3 cell = ivec3(low) + corner;
    if (!cell_inside(grid, cell)) continue;
    if (occupied_only && texelFetch(normal_occupancy, cell, 0).w <= 0.0) continue;
    vec3 w = mix(1.0 - t, t, vec3(corner));
    sum += w.x * w.y * w.z * vec4(irradiance_of_cell(cell, normal), 1.0);
  }
  if (sum.w <= 0.0) return;
  vec3 albedo = texelFetch(albedo_map, pixel, 0).rgb;
  indirect_radiance = vec4(albedo / PI * max(sum.rgb / sum.w, vec3(0.0)), 1.0);
}
