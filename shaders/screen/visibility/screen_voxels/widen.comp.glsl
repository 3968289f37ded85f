#version 450 core
// Voxels of VOXEL_RUN texels from each on, along one axis: by logical OR.
#include "screen/visibility/screen_voxels/slots.shared.h"
#include "shared/group_sizes.shared.h"

layout(local_size_x = SQUARE_GROUP, local_size_y = SQUARE_GROUP) in;
layout(binding = VOXEL_BITS_UNIT) uniform usampler2DArray narrow;
layout(binding = VOXEL_BITS_IMAGE, r32ui) uniform writeonly uimage2DArray wide;
uniform ivec2 axis;

void main() {
  ivec3 at = ivec3(gl_GlobalInvocationID), size = textureSize(narrow, 0);
  if (any(greaterThanEqual(at, size))) return;
  uint bits = 0u;
  for (int k = 0; k < VOXEL_RUN; ++k) bits |= texelFetch(narrow, ivec3(min(at.xy + k * axis, size.xy - 1), at.z), 0).r;
  imageStore(wide, at, uvec4(bits));
}
