#version 450 core
// Single pass: the columns that the triangle touches along the longest axis of its normal. A line meets the triangle only
// where it runs through two sides of its box.
#include "voxel/rectangle.glsl"

void main() {
  ivec3 some = ivec3(lessThanEqual(max(first_line(lowest()), 0), min(last_line(highest()), 3 * grid.cells - 1)));
  if (some.x + some.y + some.z < 2) return;
  int axis = longest_axis(vec3(cross(dvec3(c_vertex[1] - c_vertex[0]), dvec3(c_vertex[2] - c_vertex[0]))));
  // A step more on both sides: a crossing on the rim of a column may be rounded into the next one.
  ivec2 low = in_family(max(lowest() - 1, 0) / SLICE_STEPS, axis).yz;
  ivec2 high = in_family(max(highest() + 1, 0) / SLICE_STEPS, axis).yz;
  ivec2 last = in_family(grid.cells, axis).yz - 1;
  emit_columns(axis, min(low, last), min(high, last));
}
