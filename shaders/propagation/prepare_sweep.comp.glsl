#version 450 core
// Sides as the sweep reads them (sweep.comp.glsl), through textures and in one read each: for every cell its first side
// and which faces have one, for every side what it sends and the share of light that its face lets through.
#include "propagation/slots.shared.h"
#include "shared/global_index.shared.h"
#include "propagation/side_texel.glsl"
#include "shared/group_sizes.shared.h"
#include "voxel/cell_sides.glsl"
#include "voxel/grid_block.glsl"
#include "voxel/side_count.glsl"
#include "voxel/sides.glsl"

layout(local_size_x = LINEAR_GROUP) in;
layout(binding = CELL_WORD_IMAGE, r32ui) uniform restrict writeonly uimage3D cell_word;     // (first side << 6) | faces
layout(binding = SIDE_LIGHT_IMAGE, rgba32f) uniform restrict writeonly image2D side_light;  // rgb [W], a: 1 - tau
layout(std430, binding = SENT_SLOT) readonly buffer Sent { vec4 sent[]; };                  // power per side [W]

void main() {
  int i = int(global_index());
  if (i < grid.cells.x * grid.cells.y * grid.cells.z) {
    uvec2 own_sides = cell_sides[i];
    imageStore(cell_word, cell_coord(grid, i), uvec4((own_sides.x << 6) | (own_sides.y & 63u), 0u, 0u, 0u));
  }
  if (i >= int(side_count)) return;
  imageStore(side_light, side_texel(i), vec4(sent[i].rgb, 1.0 - sides[i].coverage));
}
