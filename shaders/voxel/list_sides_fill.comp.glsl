#version 450 core
// The two sides of every covered face of one axis, from the surfaces that its cells see; black ones where the list of
// surfaces had no room in this frame. Areas follow (collect_area), but for axes that are not sliced in this frame.
#include "shared/global_index.shared.h"
#include "voxel/cell_sides.glsl"
#include "voxel/grid_block.glsl"
#include "voxel/groups.shared.h"
#include "voxel/surfaces.glsl"

layout(local_size_x = FACE_LANES) in;
layout(std430, binding = FILL_ENTRIES_SLOT) readonly buffer Entries { uint entries[]; };
layout(std430, binding = FILL_SURFACES_SLOT) readonly buffer Surfaces { Surface surfaces[]; };
layout(std430, binding = FILL_COVERAGE_SLOT) readonly buffer Coverage { float coverage[]; };
layout(std430, binding = SIDES_SLOT) writeonly buffer Sides { Side sides[]; };
uniform int axis;

void write_side(ivec3 cell, int face, Surface s, float covered) {
  if (!cell_inside(grid, cell)) return;
  int offset = cell_index(grid, cell);
  uvec2 own = cell_sides[offset];
  if (!has_side(own, face)) return;  // no room in this frame
  Side side;
  side.normal = s.normal;
  side.coverage = covered;
  side.albedo = s.albedo;
  side.face_m2 = covered * grid.cell_size_m * grid.cell_size_m;
  side.area_m2 = s.area_m2 > 0.0 ? s.area_m2 : side.face_m2 / staircase_factor(s.normal);
  side.radiosity = s.radiosity;
  side.cell = offset;
  side.face = face;
  side.depth = s.depth;
  side.front = s.front;
  sides[side_index(own, face)] = side;
}

void fill_sides(int face) {
  float covered = coverage[face];
  uint entry = entries[face];
  ivec3 upper = face_coord(grid, axis, face);
  ivec3 lower = upper;
  lower[axis] -= 1;
  Surface below, above;
  if (entry != NO_ENTRY) {
    below = surfaces[2u * entry];
    above = surfaces[2u * entry + 1u];
  } else {
    above = Surface(vec3(0.0), float(upper[axis]), vec3(0.0), 1, vec3(0.0), 0.0);
    above.normal[axis] = 1.0;
    below = above;
    below.normal = -above.normal;
  }
  write_side(lower, 2 * axis + 1, below, covered);
  write_side(upper, 2 * axis, above, covered);
}

// Of a group; those with sides are collected and then shared out, so that no lane idles.
const uint FACES = uint(VOXEL_GROUP);
shared uint covered_faces[FACES];
shared uint covered_count;

void main() {
  uint lane = gl_LocalInvocationID.x;
  uint end = min((group_index() + 1u) * FACES, uint(face_count(grid, axis)));
  if (lane == 0u) covered_count = 0u;
  barrier();
  for (uint face = group_index() * FACES + lane; face < end; face += gl_WorkGroupSize.x) {
    if (coverage[face] > 0.0) covered_faces[atomicAdd(covered_count, 1u)] = face;
  }
  barrier();
  for (uint k = lane; k < covered_count; k += gl_WorkGroupSize.x) fill_sides(int(covered_faces[k]));
}
