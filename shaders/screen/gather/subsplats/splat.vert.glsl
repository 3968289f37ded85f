#version 450 core
// A subsplat as one point in its level of the flattened buffer (Nichols 2010, §3.2.4), an instance for every light of
// the block or for its own light. NEGATIVE: for all negative lights.
#include "screen/base/virtual_lights_block.glsl"
#include "screen/gather/subsplats/subsplat.shared.h"

layout(location = 0) in uvec2 subsplat;  // packed; its light in the block, or ALL_LIGHTS
uniform ivec2 picture_size;
uniform int last_level;
flat out uint packed_subsplat;
flat out int light;

void main() {
  packed_subsplat = subsplat.x;
  light = subsplat.y == ALL_LIGHTS ? gl_InstanceID : int(subsplat.y);
  vec2 place = vec2(place_of_subsplat(picture_size, unpack_subsplat(subsplat.x))) + 0.5;
  gl_Position = vec4(place / vec2(flattened_size(picture_size, last_level)) * 2.0 - 1.0, 0.5, 1.0);
#ifndef NEGATIVE
  if (lights[light].flux == vec3(0.0)) gl_Position.x = 3.0;  // outside
#endif
}
