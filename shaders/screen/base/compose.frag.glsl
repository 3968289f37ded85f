#version 450 core
// Sum of radiance layers; where there is no geometry one of them alone, or black.
#include "screen/base/compose.shared.h"
#include "screen/base/gbuffer.glsl"

layout(binding = COMPOSE_LAYERS_UNIT) uniform sampler2D layers[COMPOSE_LAYERS];
uniform int layer_count;
uniform int background_layer;  // -1: none

layout(location = 0) out vec4 radiance;

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  radiance = vec4(0.0, 0.0, 0.0, 1.0);
  bool background = texelFetch(position_map, pixel, 0).w == 0.0;
  // Samplers of an array may only be chosen alike by all pixels.
  for (int i = 0; i < layer_count; ++i) {
    vec3 layer = texelFetch(layers[i], pixel, 0).rgb;
    if (!background || i == background_layer) radiance.rgb += layer;
  }
}
