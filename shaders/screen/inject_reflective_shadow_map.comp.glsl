#version 450 core
// Deposits the light that the texels of one light's reflective shadow map reflect. A thread takes 4 x 4 texels and adds
// up what goes to one side before it touches memory.
#include "shared/reflective_shadow_map.glsl"
#include "propagation/deposit.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
uniform int light;
uniform int resolution;

void main() {
  ivec2 first = 4 * ivec2(gl_GlobalInvocationID.xy);
  if (first.x >= resolution || first.y >= resolution) return;
  ivec3 pending = ivec3(-2);
  vec3 sums[3] = vec3[3](vec3(0.0), vec3(0.0), vec3(0.0));
  for (int k = 0; k < 16; ++k) {
    ivec2 texel = first + ivec2(k & 3, k >> 2);
    vec3 position, normal, irradiance_flux, albedo;
    if (!rsm_texel(light, int(gl_GlobalInvocationID.z), texel, position, normal, irradiance_flux, albedo)) continue;
    ivec3 targets;
    vec3 weights;
    sides_of_point(position, normal, targets, weights);
    for (int axis = 0; axis < 3; ++axis) {
      if (weights[axis] == 0.0) continue;
      if (targets[axis] != pending[axis]) {
        if (pending[axis] != -2) add_flux(pending[axis], sums[axis]);
        pending[axis] = targets[axis];
        sums[axis] = vec3(0.0);
      }
      sums[axis] += weights[axis] * irradiance_flux * albedo;
    }
  }
  for (int axis = 0; axis < 3; ++axis) {
    if (pending[axis] != -2) add_flux(pending[axis], sums[axis]);
  }
}
