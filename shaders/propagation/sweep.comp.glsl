#version 450 core
// One transport order of the `ordinates` scheme: discrete ordinates, step scheme (docs/theory.md#ordinates). The flow of the
// directions of one octant is ordered, so one sweep over the cells, upwind cells first, solves void, blocked and partly
// transmitting faces to rounding. A dispatch takes one diagonal plane i+j+k of all eight octants: its cells do not depend on
// each other, and only the plane before is kept.
// Set by the program: PER_OCTANT = 3
#include "shared/grid.shared.h"
#include "shared/side.shared.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(std140, binding = 0) uniform GridBlock { Grid grid; };
layout(std430, binding = 3) readonly buffer CellSides { uvec2 cell_sides[]; };
layout(std430, binding = 4) readonly buffer Sides { Side sides[]; };
layout(std430, binding = 7) readonly buffer Sent { vec4 sent[]; };  // power per side [W]
// Four entries a side, one for each octant that can reach it; the entry's number is the octant's on the two other axes.
layout(std430, binding = 10) writeonly buffer Arrived { vec4 arrived[]; };
// The plane before and this one: column (i,j) of its cells, a layer for every octant and direction.
layout(binding = 0) uniform sampler2DArray before_plane;
layout(binding = 0, rgba32f) uniform restrict writeonly image2DArray this_plane;
uniform vec3 emitted_share[PER_OCTANT];   // of a side's power on each axis: w |d| / t (ordinates.h)
uniform vec3 downwind_share[PER_OCTANT];  // of a cell's power through each downwind face: |d| / (|d_x| + |d_y| + |d_z|)
uniform int plane;
uniform ivec2 first_column;

int entry_of_octant(int octant, int axis) {
  return axis == 0 ? octant >> 1 : axis == 1 ? (octant & 1) | ((octant >> 1) & 2) : octant & 3;
}

// Adds what enters the cell through its upwind face of `axis`: the neighbour's light, and what a side there sends.
void enter(inout vec3 power[PER_OCTANT], uvec2 own_sides, int axis, int face, bool neighbour, ivec2 column, int first_layer) {
  float pass = neighbour ? 1.0 : 0.0;
  if (has_side(own_sides, face)) {
    uint side = side_index(own_sides, face);
    pass *= is_opaque(own_sides, face) ? 0.0 : 1.0 - sides[side].coverage;
    vec3 e = sent[side].rgb;
    for (int d = 0; d < PER_OCTANT; ++d) power[d] += emitted_share[d][axis] * e;
  }
  if (pass == 0.0) return;
  for (int d = 0; d < PER_OCTANT; ++d) {
    power[d] += pass * downwind_share[d][axis] * texelFetch(before_plane, ivec3(column, first_layer + d), 0).rgb;
  }
}

// What sides on the downwind faces receive.
void leave(vec3 power[PER_OCTANT], uvec2 own_sides, int axis, int face, int octant) {
  if (!has_side(own_sides, face)) return;
  uint side = side_index(own_sides, face);
  vec3 hit = vec3(0.0);
  for (int d = 0; d < PER_OCTANT; ++d) hit += downwind_share[d][axis] * power[d];
  float tau = is_opaque(own_sides, face) ? 1.0 : sides[side].coverage;
  arrived[4 * side + entry_of_octant(octant, axis)] = vec4(tau * hit, 0.0);
}

void main() {
  ivec3 flow = ivec3(first_column + ivec2(gl_GlobalInvocationID.xy), 0);
  flow.z = plane - flow.x - flow.y;
  if (!cell_inside(grid, flow)) return;
  int octant = int(gl_WorkGroupID.z);
  ivec3 positive = ivec3(octant & 1, (octant >> 1) & 1, octant >> 2);
  ivec3 cell = positive * flow + (1 - positive) * (grid.cells - 1 - flow);
  uvec2 own_sides = cell_sides[cell_index(grid, cell)];
  int first_layer = octant * PER_OCTANT;
  vec3 power[PER_OCTANT];
  for (int d = 0; d < PER_OCTANT; ++d) power[d] = vec3(0.0);
  enter(power, own_sides, 0, 1 - positive.x, flow.x > 0, flow.xy - ivec2(1, 0), first_layer);
  enter(power, own_sides, 1, 3 - positive.y, flow.y > 0, flow.xy - ivec2(0, 1), first_layer);
  enter(power, own_sides, 2, 5 - positive.z, flow.z > 0, flow.xy, first_layer);
  if ((own_sides.y & 63u) != 0u) {
    leave(power, own_sides, 0, positive.x, octant);
    leave(power, own_sides, 1, 2 + positive.y, octant);
    leave(power, own_sides, 2, 4 + positive.z, octant);
  }
  for (int d = 0; d < PER_OCTANT; ++d) imageStore(this_plane, ivec3(flow.xy, first_layer + d), vec4(power[d], 0.0));
}
