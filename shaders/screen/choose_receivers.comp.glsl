#version 450 core
// Pixels that stand for the picture: the first 256 points of the Halton sequence of bases 2 and 3.
#include "shared/octahedral.glsl"
#include "screen/light_candidates.glsl"

layout(local_size_x = 64) in;
layout(binding = 0) uniform sampler2D position_map;
layout(binding = 1) uniform sampler2D normal_map;
layout(binding = 2) uniform sampler2D albedo_map;

float radical_inverse_3(uint i) {
  float sum = 0.0, digit = 1.0 / 3.0;
  for (; i > 0u; i /= 3u, digit /= 3.0) sum += float(i % 3u) * digit;
  return sum;
}

void main() {
  uint k = gl_GlobalInvocationID.x;
  if (k >= uint(RECEIVERS)) return;
  vec2 halton = vec2(float(bitfieldReverse(k + 1u)) / 4294967296.0, radical_inverse_3(k + 1u));
  ivec2 size = textureSize(position_map, 0);
  ivec2 pixel = min(ivec2(halton * vec2(size)), size - 1);
  vec4 position = texelFetch(position_map, pixel, 0);
  float reflectance = dot(texelFetch(albedo_map, pixel, 0).rgb, vec3(0.2126, 0.7152, 0.0722));
  position.w *= reflectance;
  receivers[k] = Receiver(position, vec4(octahedral_decode(texelFetch(normal_map, pixel, 0).xy), 0.0));
}
