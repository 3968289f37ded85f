#version 450 core
// Sides of cells that light does not leave in a band are not white in it.
#include "shared/global_index.shared.h"
#include "shared/group_sizes.shared.h"
#include "shared/side.shared.h"
#include "voxel/side_count.glsl"
#include "voxel/white_pockets.glsl"

layout(local_size_x = LINEAR_GROUP) in;
layout(std430, binding = SIDES_SLOT) buffer Sides { Side sides[]; };

void main() {
  uint i = global_index();
  if (i >= side_count || i >= uint(sides.length())) return;
  uint leaves = leaving[sides[i].cell];
  for (int band = 0; band < 3; ++band) {
    if ((leaves >> band & 1u) == 0u) sides[i].albedo[band] = min(sides[i].albedo[band], MAX_POCKET_ALBEDO);
  }
}
