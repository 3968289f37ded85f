#version 450 core
// Pixels at the middles of METERED_EDGE^2 equal parts of the picture.
#include "screen/display/exposure_meter.shared.h"

layout(local_size_x = METERED_EDGE) in;
layout(binding = METERED_RADIANCE_UNIT) uniform sampler2D radiance;
layout(std430, binding = METERED_SAMPLES_SLOT) writeonly buffer MeteredSamples { vec4 samples[]; };

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= METERED_EDGE * METERED_EDGE) return;
  vec2 part = (vec2(i % METERED_EDGE, i / METERED_EDGE) + 0.5) / float(METERED_EDGE);
  samples[i] = vec4(texelFetch(radiance, ivec2(part * vec2(textureSize(radiance, 0))), 0).rgb, 1.0);
}
