#version 450 core
// One transport order of the `ordinates` scheme: discrete ordinates, step scheme (docs/theory.md#ordinates). The flow of the
// directions of one octant is ordered, so one sweep over the cells, upwind cells first, solves void, blocked and partly
// transmitting faces to rounding. A dispatch takes one diagonal plane i+j+k of all eight octants: its cells do not depend on
// each other, and only the plane before is kept.
#include "shared/grid.shared.h"
#include "shared/side.shared.h"

layout(local_size_x = 16, local_size_y = 4) in;
layout(std140, binding = 0) uniform GridBlock { Grid grid; };
layout(std430, binding = 3) readonly buffer CellSides { uvec2 cell_sides[]; };
layout(std430, binding = 4) readonly buffer Sides { Side sides[]; };
layout(std430, binding = 7) readonly buffer Sent { vec4 sent[]; };  // power per side [W]
// Four entries a side, one for each octant that can reach it; the entry's number is the octant's on the two other axes.
layout(std430, binding = 10) writeonly buffer Arrived { vec4 arrived[]; };
layout(std430, binding = 11) buffer Planes { float planes[]; };  // [octant][2][direction][band][column]
// Directions of the octant (+,+,+), each with its weight over t in w (ordinates.h).
uniform vec4 directions[PER_OCTANT];
uniform int plane;

// Planes are stored by their columns (i,j).
int plane_offset(int octant, int p) { return ((octant * 2 + (p & 1)) * PER_OCTANT * 3) * grid.cells.x * grid.cells.y; }

int entry_of_octant(int octant, int axis) {
  return axis == 0 ? octant >> 1 : axis == 1 ? (octant & 1) | ((octant >> 1) & 2) : octant & 3;
}

// Adds what enters the cell through its upwind face of `axis`: the neighbour's light, and what a side there sends.
void enter(inout vec3 power[PER_OCTANT], uvec2 own_sides, int axis, int face, bool neighbour, int offset) {
  float pass = neighbour ? 1.0 : 0.0;
  if (has_side(own_sides, face)) {
    uint side = side_index(own_sides, face);
    pass *= is_opaque(own_sides, face) ? 0.0 : 1.0 - sides[side].coverage;
    vec3 e = sent[side].rgb;
    for (int d = 0; d < PER_OCTANT; ++d) power[d] += e * (directions[d][axis] * directions[d].w);
  }
  if (pass == 0.0) return;
  int columns = grid.cells.x * grid.cells.y;
  for (int d = 0; d < PER_OCTANT; ++d) {
    float share = pass * directions[d][axis] / (directions[d].x + directions[d].y + directions[d].z);
    int at = offset + 3 * d * columns;
    power[d] += share * vec3(planes[at], planes[at + columns], planes[at + 2 * columns]);
  }
}

// What sides on the downwind faces receive.
void leave(vec3 power[PER_OCTANT], uvec2 own_sides, int axis, int face, int octant) {
  if (!has_side(own_sides, face)) return;
  uint side = side_index(own_sides, face);
  vec3 hit = vec3(0.0);
  for (int d = 0; d < PER_OCTANT; ++d) hit += power[d] * (directions[d][axis] / (directions[d].x + directions[d].y + directions[d].z));
  float tau = is_opaque(own_sides, face) ? 1.0 : sides[side].coverage;
  arrived[4 * side + entry_of_octant(octant, axis)] = vec4(tau * hit, 0.0);
}

void main() {
  ivec3 flow = ivec3(gl_GlobalInvocationID.xy, 0);
  flow.z = plane - flow.x - flow.y;
  if (!cell_inside(grid, flow)) return;
  int octant = int(gl_WorkGroupID.z);
  ivec3 positive = ivec3(octant & 1, (octant >> 1) & 1, octant >> 2);
  ivec3 cell = positive * flow + (1 - positive) * (grid.cells - 1 - flow);
  uvec2 own_sides = cell_sides[cell_index(grid, cell)];
  int column = flow.x + grid.cells.x * flow.y;
  int before = plane_offset(octant, plane - 1) + column;
  vec3 power[PER_OCTANT];
  for (int d = 0; d < PER_OCTANT; ++d) power[d] = vec3(0.0);
  enter(power, own_sides, 0, 1 - positive.x, flow.x > 0, before - 1);
  enter(power, own_sides, 1, 3 - positive.y, flow.y > 0, before - grid.cells.x);
  enter(power, own_sides, 2, 5 - positive.z, flow.z > 0, before);
  if ((own_sides.y & 63u) != 0u) {
    leave(power, own_sides, 0, positive.x, octant);
    leave(power, own_sides, 1, 2 + positive.y, octant);
    leave(power, own_sides, 2, 4 + positive.z, octant);
  }
  int columns = grid.cells.x * grid.cells.y;
  int at = plane_offset(octant, plane) + column;
  for (int d = 0; d < PER_OCTANT; ++d) {
    planes[at + 3 * d * columns] = power[d].r;
    planes[at + (3 * d + 1) * columns] = power[d].g;
    planes[at + (3 * d + 2) * columns] = power[d].b;
  }
}
