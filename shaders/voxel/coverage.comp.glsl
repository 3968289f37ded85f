#version 450 core
// Coverage of every face of one axis, from the fine lattice (docs/theory.md#voxelization): of the paths from the centre of
// the lower cell to that of the upper one that go in the mid-plane of the lower cell to one of nine nodes, straight across
// and back in the mid-plane of the upper cell, the share that is blocked on the way across.
#include "shared/global_index.shared.h"
#include "shared/grid.shared.h"
#include "voxel/families.glsl"
#include "voxel/groups.shared.h"
#include "voxel/slots.shared.h"

layout(local_size_x = FACE_LANES) in;
layout(std430, binding = COVERAGE_BLOCKED_SLOT) readonly buffer Blocked { uint at[]; } blocked[3];
// Of this axis; empty without glass.
layout(std430, binding = COVERAGE_HAZE_SLOT) readonly buffer Haze { uint haze[]; };
layout(std430, binding = COVERAGE_KEY_LOW_SLOT) readonly buffer KeyLow { uint key_low[]; };  // of this axis
layout(std430, binding = COVERAGE_SLOT) writeonly buffer Coverage { float coverage[]; };
uniform int axis;
uniform int has_haze;

const uint ALL = 511u;  // nodes: bit u + 3v, u along axis_b, v along axis_c

uint blocked_on(int family, ivec3 cell) {
  int face = face_index(grid, family, cell);
  return family == 0 ? blocked[0].at[face] : family == 1 ? blocked[1].at[face] : blocked[2].at[face];
}
uint blocked_on_upper(int family, ivec3 cell) {
  cell[family] += 1;
  return blocked_on(family, cell);
}

uint blocked_of_axis(uint face) {
  return axis == 0 ? blocked[0].at[face] : axis == 1 ? blocked[1].at[face] : blocked[2].at[face];
}

// Nodes that the middle one reaches. The steps along b lie on lines of b's family, whose own b is c and whose c is the
// axis: bits part * 9 + v + 3; those along c on lines whose b is the axis and whose c is b: bits part * 9 + 1 + 3u.
uint reach(ivec3 cell) {
  if (!cell_inside(grid, cell)) return ALL;
  int b = axis_b(axis);
  int c = axis_c(axis);
  uint b_low = blocked_on(b, cell) >> 21;
  uint b_high = blocked_on_upper(b, cell) >> 3;
  uint c_low = blocked_on(c, cell) >> 18;
  uint c_high = blocked_on_upper(c, cell);
  uint open_b = 0u;  // bit of (u,v): the step to (u+1,v)
  uint open_c = 0u;  // to (u,v+1)
  for (int k = 0; k < 3; ++k) {
    open_b |= (~b_low >> k & 1u) << (3 * k) | (~b_high >> k & 1u) << (3 * k + 1);
    open_c |= (~c_low >> (3 * k + 1) & 1u) << k | (~c_high >> (3 * k + 1) & 1u) << (3 + k);
  }
  uint reached = 1u << 4;
  for (int step = 0; step < 8; ++step) {  // the longest way through nine nodes
    reached |= (reached & open_b) << 1 | (reached >> 1 & open_b) | (reached & open_c) << 3 | (reached >> 3 & open_c);
  }
  return reached;
}

// Most faces are decided at once; the others of a group are collected and then shared out, so that no lane idles.
const uint FACES = uint(VOXEL_GROUP);  // of a group
shared uint partly[FACES];
shared uint partly_count;

uint nodes_blocked(uint face) {
  uint parts = blocked_of_axis(face);
  return (parts | parts >> 9 | parts >> 18) & ALL;
}

void cover(uint face, bool opaque, float share) {
  float clear = has_haze == 0 ? 1.0 : exp(-float(haze[face]) / 65536.0);
  coverage[face] = opaque ? 1.0 : min(1.0 - (1.0 - share) * clear, 0.99999994);  // only what is opaque covers all
}

void main() {
  uint lane = gl_LocalInvocationID.x;
  uint end = min((group_index() + 1u) * FACES, uint(face_count(grid, axis)));
  if (lane == 0u) partly_count = 0u;
  barrier();
  for (uint face = group_index() * FACES + lane; face < end; face += gl_WorkGroupSize.x) {
    if (key_low[face] == 0xffffffffu) {
      coverage[face] = 0.0;
      continue;
    }
    uint nodes = nodes_blocked(face);
    if (nodes == 0u || nodes == ALL) {
      cover(face, nodes == ALL, 0.0);
    } else {
      partly[atomicAdd(partly_count, 1u)] = face;
    }
  }
  barrier();
  for (uint k = lane; k < partly_count; k += gl_WorkGroupSize.x) {
    uint face = partly[k];
    ivec3 upper = face_coord(grid, axis, int(face));
    ivec3 lower = upper;
    lower[axis] -= 1;
    uint nodes = nodes_blocked(face);
    uint reached = reach(lower) & reach(upper);
    cover(face, (reached & ~nodes) == 0u, float(bitCount(reached & nodes)) / float(bitCount(reached)));
  }
}
