#version 450 core
// A fragment at a column's centre with depth x blocks the segment between the two cell centres that x lies between.
// First run (mark): coverage of the face, and the surfaces nearest to each of its two cells. Second run (write_sides):
// the nearest surfaces write what the cells see. Keys hold depth, then triangle: results do not depend on order.
#include "shared/grid.shared.h"
#include "shared/side.shared.h"
#include "shared/material.glsl"

in vec2 v_uv0;
in vec2 v_uv1;
in vec4 v_color;
flat in vec3 v_normal;
flat in float v_plane;
flat in float v_moved;
flat in uint v_triangle;

layout(std140, binding = 0) uniform GridBlock { Grid grid; };
uniform int axis;
uniform bool write_sides;
uniform int triangle_bits;  // of a key; the rest is depth

layout(std430, binding = 0) buffer KeyLow { uint key_low[]; };    // nearest to the cell below the face
layout(std430, binding = 1) buffer KeyHigh { uint key_high[]; };  // nearest to the cell above
layout(std430, binding = 2) buffer Opacity { uint opacity[]; };   // bit 31: opaque; else the sum of -ln(1-alpha) 2^16
layout(std430, binding = 3) readonly buffer CellSides { uvec2 cell_sides[]; };
layout(std430, binding = 4) writeonly buffer Sides { Side sides[]; };

// Depth of the triangle's plane at the column's centre.
float depth_at_column(vec2 column) {
  int b = axis_b(axis);
  int c = axis_c(axis);
  return (v_plane - v_normal[b] * column.x - v_normal[c] * column.y) / v_normal[axis];
}

// Whether the centre of cell i of the column lies below the surface. The same numbers whatever the axis: the three passes
// agree on which side of the plane a cell centre lies, and a sloped wall has no holes. Depths would be rounded apart.
bool centre_below(vec2 column, int i) {
  vec3 centre;
  centre[axis_b(axis)] = column.x;
  centre[axis_c(axis)] = column.y;
  centre[axis] = float(i) + 0.5;
  precise float along_normal = v_normal.x * centre.x + v_normal.y * centre.y + v_normal.z * centre.z;
  return (along_normal >= v_plane) != (v_normal[axis] > 0.0);
}

// The face between the last centre below the surface and the first above it.
int blocked_face(vec2 column, float depth) {
  int i = int(floor(clamp(depth, -2.0, float(grid.cells[axis]) + 2.0) + 0.5));
  if (!centre_below(column, i - 1)) return i - 1;
  return centre_below(column, i) ? i + 1 : i;
}

void write_side(ivec3 cell, int face, float depth, vec3 albedo, vec3 emission, float coverage) {
  if (!cell_inside(grid, cell)) return;
  int offset = cell_index(grid, cell);
  Side side;
  bool front = v_normal[axis] * float(face_sign(face)) < 0.0;  // the cell looks along +face at the surface
  side.normal = front ? v_normal : -v_normal;
  side.coverage = coverage;
  side.albedo = albedo;
  side.staircase = staircase_factor(v_normal);
  side.area_m2 = side_area(coverage, grid.cell_size_m, side.staircase);
  side.radiosity = front || material_double_sided != 0 ? 3.14159265 * emission : vec3(0.0);
  side.cell = offset;
  side.face = face;
  side.depth = depth - v_moved / v_normal[axis];
  side.pad = 0.0;
  uint index = side_index(cell_sides[offset], face);
  if (index < uint(sides.length())) sides[index] = side;  // too few: SlicedVoxelization grows the list and runs again
}

void main() {
  vec4 albedo_alpha = material_albedo_alpha(v_uv0, v_uv1, v_color);
  float stopped = material_coverage(albedo_alpha.a);
  if (stopped <= 0.0 || v_normal[axis] == 0.0) discard;
  float depth = depth_at_column(gl_FragCoord.xy);
  int i = blocked_face(gl_FragCoord.xy, depth);
  if (i < 0 || i > grid.cells[axis]) discard;
  ivec3 face_cell = ivec3(0);
  face_cell[axis_b(axis)] = int(gl_FragCoord.x);
  face_cell[axis_c(axis)] = int(gl_FragCoord.y);
  face_cell[axis] = i;
  int face = face_index(grid, axis, face_cell);
  uint depth_max = (1u << (32 - triangle_bits)) - 1u;
  uint quantised = min(uint(clamp(depth - float(i) + 0.5, 0.0, 1.0) * float(depth_max)), depth_max - 1u);
  uint id = v_triangle & ((1u << triangle_bits) - 1u);
  uint low = (quantised << triangle_bits) | id;
  uint high = ((depth_max - 1u - quantised) << triangle_bits) | id;
  if (!write_sides) {
    atomicMin(key_low[face], low);
    atomicMin(key_high[face], high);
    if (stopped >= 0.999) {
      atomicOr(opacity[face], 0x80000000u);
    } else {
      atomicAdd(opacity[face], max(uint(-log(1.0 - stopped) * 65536.0 + 0.5), 1u));  // 0 would be no side
    }
    return;
  }
  vec3 emission = material_emission(v_uv0, v_uv1);
  uint o = opacity[face];
  float coverage = o >= 0x80000000u ? 1.0 : 1.0 - exp(-float(o) / 65536.0);
  ivec3 below = face_cell;
  below[axis] -= 1;
  if (key_low[face] == low) write_side(below, 2 * axis + 1, depth, albedo_alpha.rgb, emission, coverage);
  if (key_high[face] == high) write_side(face_cell, 2 * axis, depth, albedo_alpha.rgb, emission, coverage);
}
