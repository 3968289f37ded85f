#version 450 core
// Starts an order: every side sends its power into the cell that sees it; empty cells start dark.
#include "shared/grid.shared.h"
#include "shared/side.shared.h"
#include "shared/sh.shared.h"

layout(local_size_x = 8, local_size_y = 8, local_size_z = 4) in;
layout(std140, binding = 0) uniform GridBlock { Grid grid; };
layout(binding = 0, rgba32f) uniform restrict writeonly image3D next_lobes;
layout(std430, binding = 3) readonly buffer CellSides { uvec2 cell_sides[]; };
layout(std430, binding = 7) readonly buffer Sent { vec4 sent[]; };  // power per side [W]

void main() {
  ivec3 c = ivec3(gl_GlobalInvocationID);
  if (!cell_inside(grid, c)) return;
  uvec2 own_sides = cell_sides[cell_index(grid, c)];
  vec4 red = vec4(0.0), green = vec4(0.0), blue = vec4(0.0);
  for (int face = 0; face < 6; ++face) {
    if (!has_side(own_sides, face)) continue;
    vec3 power = sent[side_index(own_sides, face)].rgb;
    vec4 lobe = side_lobe(face);
    red += power.r * lobe;
    green += power.g * lobe;
    blue += power.b * lobe;
  }
  imageStore(next_lobes, c, red * clamp_rescale(red));
  imageStore(next_lobes, c + ivec3(0, 0, grid.cells.z), green * clamp_rescale(green));
  imageStore(next_lobes, c + ivec3(0, 0, 2 * grid.cells.z), blue * clamp_rescale(blue));
}
