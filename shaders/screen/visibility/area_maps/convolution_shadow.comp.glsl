#version 450 core
// Basis images of convolution soft shadow maps: cosines in layer 2k, sines in layer 2k + 1, the same times depth, and
// depth itself. Dong et al. 2009, sections 4.1 and 6.
#include "screen/visibility/area_maps/convolution_basis.glsl"
#include "screen/visibility/area_maps/slots.shared.h"
#include "shared/group_sizes.shared.h"
#include "shared/storage.glsl"

layout(local_size_x = SQUARE_GROUP, local_size_y = SQUARE_GROUP) in;
layout(binding = DISTANCE_MAP_UNIT) uniform sampler2DArray distance_map;
layout(binding = FARTHEST_UNIT) uniform sampler2D farthest;
#ifndef BASIS_FORMAT
#define BASIS_FORMAT rgba8
#endif
layout(binding = BASIS_IMAGE, BASIS_FORMAT) writeonly uniform image2DArray basis;  // 1/2 + 1/2 cos or sin
layout(binding = BASIS_DEPTH_IMAGE, STORED_RGBA16) writeonly uniform image2DArray basis_depth;
layout(binding = BASIS_MEAN_IMAGE, r32f) writeonly uniform image2DArray depth;

void main() {
  ivec3 at = ivec3(gl_GlobalInvocationID);
  int resolution = textureSize(distance_map, 0).x;
  if (max(at.x, at.y) >= resolution) return;
  // Outside the disk its inside is mirrored in the rim (in space: in the horizon), so that filters may reach over it.
  ivec2 from = at.xy;
  vec2 disk = (vec2(at.xy) + 0.5) * (2.0 / float(resolution)) - 1.0;
  float squared = dot(disk, disk);
  if (squared > 1.0) {
    from = clamp(ivec2((disk / squared * 0.5 + 0.5) * float(resolution)), ivec2(0), ivec2(resolution - 1));
  }
  float z = step_depth(texelFetch(distance_map, ivec3(from, at.z), 0).r, texelFetch(farthest, ivec2(at.z, 0), 0).r);
  vec4 c = cos(STEP_FREQUENCY * z);
  vec4 s = sin(STEP_FREQUENCY * z);
  imageStore(basis, ivec3(at.xy, 2 * at.z), 0.5 + 0.5 * c);
  imageStore(basis, ivec3(at.xy, 2 * at.z + 1), 0.5 + 0.5 * s);
  imageStore(basis_depth, ivec3(at.xy, 2 * at.z), 0.5 + 0.5 * c * z);
  imageStore(basis_depth, ivec3(at.xy, 2 * at.z + 1), 0.5 + 0.5 * s * z);
  imageStore(depth, at, vec4(z));
}
