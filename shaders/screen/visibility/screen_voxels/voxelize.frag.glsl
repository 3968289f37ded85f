#version 450 core
// Bits of the voxels that a fragment covers.
#include "screen/visibility/screen_voxels/slots.shared.h"
#include "shared/material.glsl"

layout(binding = VOXEL_BITS_IMAGE, r32ui) uniform uimage2DArray voxels;
uniform vec4 slice_from_world;

in vec3 position;
in vec2 uv0;
in vec2 uv1;
in vec4 color;
flat in vec3 geometric_normal;
flat in uint object_id;

void main() {
  float alpha = material_base(uv0, uv1, color).a;
  float slice = dot(slice_from_world.xyz, position) + slice_from_world.w;
  float half_spread = 0.5 * (abs(dFdx(slice)) + abs(dFdy(slice)));
  if (!material_keeps(alpha, uvec3(gl_FragCoord.xy, object_id * 65599u + uint(gl_PrimitiveID)))) discard;
  int last_slice = 16 * imageSize(voxels).z - 1;
  int first = clamp(int(floor(slice - half_spread)), 0, last_slice);
  int last = clamp(int(floor(slice + half_spread)), 0, last_slice);
  for (int word = first >> 5; word <= last >> 5; ++word) {
    int low = max(first - 32 * word, 0), high = min(last - 32 * word, 31);
    uint bits = (0xffffffffu >> uint(31 - high)) & (0xffffffffu << uint(low));
    imageAtomicOr(voxels, ivec3(gl_FragCoord.xy, word), bits);
  }
}
