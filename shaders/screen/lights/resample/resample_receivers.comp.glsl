#version 450 core
// Pixels that stand for the picture: 256 points of the Halton sequence of bases 2 and 3 that follow on one another.
#include "screen/base/gbuffer.glsl"
#include "shared/global_index.shared.h"
#include "shared/group_sizes.shared.h"
#include "shared/luminance.glsl"
#include "shared/octahedral.glsl"
#include "screen/base/halton_pixel.glsl"
#include "screen/lights/resample/light_candidates.glsl"

layout(local_size_x = LINEAR_GROUP) in;
uniform uint first_point;

void main() {
  uint k = global_index();
  if (k >= uint(RESAMPLE_RECEIVERS)) return;
  ivec2 pixel = halton_pixel(first_point + k, textureSize(position_map, 0));
  vec4 position = texelFetch(position_map, pixel, 0);
  position.w *= luminance(texelFetch(albedo_map, pixel, 0).rgb);
  receivers[k] = Receiver(position, vec4(octahedral_decode(texelFetch(normal_map, pixel, 0).xy), 0.0));
}
