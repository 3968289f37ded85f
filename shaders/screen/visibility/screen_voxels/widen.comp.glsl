#version 450 core
// Voxels of VOXEL_RUN texels from each on, along one axis: by logical OR.
#include "screen/visibility/screen_voxels/slots.shared.h"
#include "shared/group_sizes.shared.h"

layout(local_size_x = SQUARE_GROUP, local_size_y = SQUARE_GROUP) in;
layout(binding = VOXEL_BITS_UNIT) uniform usampler2DArray narrow;
layout(binding = VOXEL_BITS_IMAGE, r32ui) uniform writeonly uimage2DArray wide;
uniform ivec2 axis;
uniform int from_layer;
uniform int to_layer;

void main() {
  ivec3 at = ivec3(gl_GlobalInvocationID);
  ivec2 last = textureSize(narrow, 0).xy - 1;
  if (any(greaterThan(at.xy, last))) return;
  uint bits = 0u;
  for (int k = 0; k < VOXEL_RUN; ++k) bits |= texelFetch(narrow, ivec3(min(at.xy + k * axis, last), from_layer + at.z), 0).r;
  imageStore(wide, at + ivec3(0, 0, to_layer), uvec4(bits));
}
