#version 450 core
// Mean irradiance over the coarsest grid, what pixels of it that are nearly dark are judged by.
#include "screen/base/gbuffer.glsl"
#include "screen/base/smooth_pictures.glsl"
#include "shared/luminance.glsl"

#define THREADS 256
layout(local_size_x = THREADS) in;
layout(std430, binding = SMOOTH_MEAN_SLOT) writeonly buffer Mean { float mean_irradiance; };
uniform int step_px;
shared vec2 sums[THREADS];

void main() {
  uint t = gl_LocalInvocationIndex;
  ivec2 grid = (textureSize(position_map, 0) + step_px - 1) / step_px;
  vec2 sum = vec2(0.0);
  for (int i = int(t); i < grid.x * grid.y; i += THREADS) {
    ivec2 pixel = ivec2(i % grid.x, i / grid.x) * step_px;
    if (texelFetch(position_map, pixel, 0).w == 0.0) continue;
    vec3 irradiance = vec3(0.0);
    for (int k = 0; k < PICTURES; ++k) irradiance += texelFetch(known[k], pixel, 0).rgb;
    sum += vec2(luminance(irradiance), 1.0);
  }
  sums[t] = sum;
  barrier();
  if (t != 0u) return;
  sum = vec2(0.0);
  for (int i = 0; i < THREADS; ++i) sum += sums[i];
  mean_irradiance = sum.y > 0.0 ? sum.x / sum.y : 0.0;
}
