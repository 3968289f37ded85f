#version 450 core
// Level 1 of the pyramid of reflected light.
#include "screen/lights/rsm/slots.shared.h"
#include "shared/group_sizes.shared.h"
#include "shared/reflective_shadow_map.glsl"
#include "screen/lights/rsm/flux_importance.glsl"

layout(local_size_x = SQUARE_GROUP, local_size_y = SQUARE_GROUP) in;
layout(std430, binding = FLUX_PYRAMID_SLOT) writeonly buffer Pyramid { float pyramid[]; };
uniform int light;

void main() {
  int resolution = rsm_lights[light].resolution;
  int size = level_size(resolution, 1);
  ivec3 block = ivec3(gl_GlobalInvocationID);
  if (block.x >= size || block.y >= size) return;
  float sum = 0.0;
  for (int k = 0; k < 16; ++k) {
    ivec2 texel = 4 * block.xy + ivec2(k & 3, k >> 2);
    vec3 position, normal, arriving, albedo;
    if (max(texel.x, texel.y) >= resolution) continue;
    if (rsm_texel(light, block.z, texel, position, normal, arriving, albedo)) sum += luminance(arriving * albedo);
  }
  pyramid[(block.z * size + block.y) * size + block.x] = sum;
}
