#version 450 core
// Sum of radiance layers; black where there is no geometry.
#include "screen/base/compose.shared.h"
#include "screen/base/gbuffer.glsl"

layout(binding = COMPOSE_LAYERS_UNIT) uniform sampler2D layers[COMPOSE_LAYERS];
uniform int layer_count;

layout(location = 0) out vec4 radiance;

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  radiance = vec4(0.0, 0.0, 0.0, 1.0);
  if (texelFetch(position_map, pixel, 0).w == 0.0) return;
  for (int i = 0; i < layer_count; ++i) radiance.rgb += texelFetch(layers[i], pixel, 0).rgb;
}
