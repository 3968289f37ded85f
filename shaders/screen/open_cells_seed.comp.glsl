#version 450 core
// The cell in front of each virtual light is open.
#include "screen/open_cells.glsl"
#include "shared/virtual_light.shared.h"

layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer Lights { VirtualLight lights[]; };
uniform int light_count;

void main() {
  int i = int(gl_GlobalInvocationID.x);
  if (i >= light_count || lights[i].flux == vec3(0.0)) return;
  ivec3 cell = ivec3(floor(cell_from_world(grid, lights[i].position) + 0.5 * lights[i].normal));
  if (cell_inside(grid, cell)) open_cells[cell_index(grid, cell)] = 1u;
}
