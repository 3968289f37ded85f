#version 450 core
// For every cell: which faces have sides, and the number of sides of the cells before it in its group (a scan).
#include "shared/grid.shared.h"

layout(local_size_x = 256) in;
layout(std140, binding = 0) uniform GridBlock { Grid grid; };
layout(std430, binding = 0) readonly buffer OpacityX { uint opacity_x[]; };
layout(std430, binding = 1) readonly buffer OpacityY { uint opacity_y[]; };
layout(std430, binding = 2) readonly buffer OpacityZ { uint opacity_z[]; };
layout(std430, binding = 3) writeonly buffer CellSides { uvec2 cell_sides[]; };
layout(std430, binding = 4) writeonly buffer GroupTotals { uint group_totals[]; };

shared uint running[256];

uint face_opacity(int axis, int face) { return axis == 0 ? opacity_x[face] : axis == 1 ? opacity_y[face] : opacity_z[face]; }

void main() {
  int cell = int(gl_GlobalInvocationID.x);
  uint lane = gl_LocalInvocationID.x;
  bool inside = cell < grid.cells.x * grid.cells.y * grid.cells.z;
  uint bits = 0u;
  if (inside) {
    ivec3 c = cell_coord(grid, cell);
    for (int face = 0; face < 6; ++face) {
      ivec3 face_cell = c;
      face_cell[face >> 1] += face & 1;
      uint o = face_opacity(face >> 1, face_index(grid, face >> 1, face_cell));
      if (o != 0u) bits |= 1u << face;
      if (o >= 0x80000000u) bits |= 256u << face;
    }
  }
  uint count = bitCount(bits & 63u);
  running[lane] = count;
  barrier();
  for (uint step = 1u; step < 256u; step <<= 1) {
    uint before = lane >= step ? running[lane - step] : 0u;
    barrier();
    running[lane] += before;
    barrier();
  }
  if (inside) cell_sides[cell] = uvec2(running[lane] - count, bits);
  if (lane == 255u) group_totals[gl_WorkGroupID.x] = running[lane];
}
