#version 450 core
// One more picture into the mean of those before.
#include "screen/display/slots.shared.h"
#include "shared/group_sizes.shared.h"

layout(local_size_x = SQUARE_GROUP, local_size_y = SQUARE_GROUP) in;
layout(binding = ACCUMULATED_RADIANCE_UNIT) uniform sampler2D radiance;
layout(binding = MEAN_RADIANCE_IMAGE, rgba32f) uniform image2D mean_radiance;
uniform int count;  // with this one

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, imageSize(mean_radiance)))) return;
  vec4 added = texelFetch(radiance, pixel, 0);
  if (count > 1) {  // the first one replaces what was there, finite or not
    vec4 mean = imageLoad(mean_radiance, pixel);
    added = mean + (added - mean) / float(count);
  }
  imageStore(mean_radiance, pixel, added);
}
