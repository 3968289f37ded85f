#version 450 core
// What every side sends of light that has come to it from other surfaces [W m^-2]: of the first bounce, and of all
// bounces after.
#include "screen/bounces/glossy/slots.shared.h"
#include "shared/global_index.shared.h"
#include "shared/group_sizes.shared.h"
#include "voxel/grid_block.glsl"
#include "voxel/side_count.glsl"
#include "voxel/sides.glsl"

layout(local_size_x = LINEAR_GROUP) in;
layout(std430, binding = GLOSSY_PUNCTUAL_FLUX_SLOT) readonly buffer Punctual { vec4 punctual_flux[]; };
layout(std430, binding = GLOSSY_EMITTED_FLUX_SLOT) readonly buffer Emitted { vec4 emitted_flux[]; };
layout(std430, binding = GLOSSY_DIRECT_IRRADIANCE_SLOT) readonly buffer DirectIrradiance { vec4 direct_irradiance[]; };
layout(std430, binding = GLOSSY_INDIRECT_IRRADIANCE_SLOT) readonly buffer IndirectIrradiance {
  vec4 indirect_irradiance[];
};
layout(std430, binding = GLOSSY_RADIOSITY_SLOT) writeonly buffer Radiosity { vec4 radiosity[]; };
uniform int has_punctual;  // 0: that buffer is another's
uniform int has_emitted;
uniform int has_direct;
uniform int has_indirect;

void main() {
  uint s = global_index();
  if (s >= side_count || s >= uint(sides.length())) return;
  Side side = sides[s];
  vec3 flux = vec3(0.0), irradiance = has_indirect != 0 ? indirect_irradiance[s].rgb : vec3(0.0);
  if (has_punctual != 0) flux += punctual_flux[s].rgb;
  if (has_emitted != 0) flux += emitted_flux[s].rgb;
  if (has_direct != 0) irradiance += direct_irradiance[s].rgb;
  float area_m2 = max(side.area_m2, LEAST_SIDE_AREA * grid.cell_size_m * grid.cell_size_m);
  radiosity[s] = vec4(flux / area_m2 + side.albedo * irradiance, 0.0);
}
