// The fine lattice: three lines for each column of cells and axis, cut at three nodes a cell, the middle ones through the
// cells' centres. Node k of an axis lies at (2k+1) SLICE_STEPS/6; lines are numbered as the nodes that they run through.
#ifndef VOLGI_FAMILIES_GLSL
#define VOLGI_FAMILIES_GLSL
#include "voxel/grid_block.glsl"

const int NODE_STEPS = SLICE_STEPS / 3;  // 128: divided by shifts, which round down for negative numbers too
const int NODE_SHIFT = 7;

ivec3 first_line(ivec3 steps) { return (steps - NODE_STEPS / 2 + NODE_STEPS - 1) >> NODE_SHIFT; }  // at or above
ivec3 last_line(ivec3 steps) { return (steps - NODE_STEPS / 2) >> NODE_SHIFT; }                    // at or below

// Coordinates as the family of `axis` counts them, x along it, y along axis_b and z along axis_c; and back.
ivec3 in_family(ivec3 v, int axis) { return axis == 0 ? v : axis == 1 ? v.yzx : v.zxy; }
dvec3 in_family(dvec3 v, int axis) { return axis == 0 ? v : axis == 1 ? v.yzx : v.zxy; }
vec3 in_family(vec3 v, int axis) { return axis == 0 ? v : axis == 1 ? v.yzx : v.zxy; }
ivec3 from_family(ivec3 v, int axis) { return axis == 0 ? v : axis == 1 ? v.zxy : v.yzx; }
dvec3 from_family(dvec3 v, int axis) { return axis == 0 ? v : axis == 1 ? v.zxy : v.yzx; }
vec3 from_family(vec3 v, int axis) { return axis == 0 ? v : axis == 1 ? v.zxy : v.yzx; }

int longest_axis(vec3 v) {
  vec3 a = abs(v);
  return a.x >= a.y && a.x >= a.z ? 0 : a.y >= a.z ? 1 : 2;
}

#endif
