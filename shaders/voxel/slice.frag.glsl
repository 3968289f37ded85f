#version 450 core
// A fragment at a column's centre with depth x blocks the segment between the two cell centres that x lies between.
// First run (mark): coverage of the face, and the surfaces nearest to each of its two cells. Second run (write_sides):
// the nearest surfaces write what the cells see. Keys hold depth, then triangle: results do not depend on order.
#include "shared/grid.shared.h"
#include "shared/side.shared.h"
#include "shared/material.glsl"

flat in ivec3 v_vertex[3];  // slice_vertex
flat in vec2 v_uv0[3];
flat in vec2 v_uv1[3];
flat in vec4 v_color[3];
flat in vec3 v_normal;  // zero for a triangle that had no area before its vertices were rounded
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

// Exact geometry in steps of slice_vertex. Cell centres count as moved by (e, e^2, e^3), e above 0 but next to nothing, so
// that none lies on an edge or a plane (simulation of simplicity, Edelsbrunner and Muecke 1990): signs are never 0.

// On which side of the edge p-q the column lies, times twice the area of the three.
double edge_area(ivec3 p, ivec3 q, ivec3 column, out bool positive) {
  int b = axis_b(axis);
  int c = axis_c(axis);
  double eb = double(q[b] - p[b]);
  double ec = double(q[c] - p[c]);
  double area = eb * double(column[c] - p[c]) - ec * double(column[b] - p[b]);
  double moved_b = -ec;  // what a step along b and along c would add; the lower axis moves more
  double moved_c = eb;
  if (b < c) {
    positive = area != 0.0 ? area > 0.0 : moved_b != 0.0 ? moved_b > 0.0 : moved_c > 0.0;
  } else {
    positive = area != 0.0 ? area > 0.0 : moved_c != 0.0 ? moved_c > 0.0 : moved_b > 0.0;
  }
  return area;
}

dvec3 plane_normal() {
  dvec3 u = dvec3(v_vertex[1] - v_vertex[0]);
  dvec3 v = dvec3(v_vertex[2] - v_vertex[0]);
  return cross(u, v);
}

// Whether the centre of cell i of the column lies below the surface along the axis.
bool centre_below(dvec3 n, ivec3 column, int i) {
  column[axis] = i * SLICE_STEPS + SLICE_STEPS / 2;
  double height = dot(n, dvec3(column - v_vertex[0]));
  bool ahead = height != 0.0 ? height > 0.0 : n.x != 0.0 ? n.x > 0.0 : n.y != 0.0 ? n.y > 0.0 : n.z > 0.0;
  return ahead != (n[axis] > 0.0);
}

// The face between the last centre below the surface and the first above it.
int blocked_face(dvec3 n, ivec3 column, float depth) {
  int i = int(floor(clamp(depth, -2.0, float(grid.cells[axis]) + 2.0) + 0.5));
  if (!centre_below(n, column, i - 1)) return i - 1;
  return centre_below(n, column, i) ? i + 1 : i;
}

void write_side(ivec3 cell, int face, vec3 normal, float depth, vec3 albedo, vec3 emission, float coverage) {
  if (!cell_inside(grid, cell)) return;
  int offset = cell_index(grid, cell);
  Side side;
  bool front = normal[axis] * float(face_sign(face)) < 0.0;  // the cell looks along +face at the surface
  side.normal = front ? normal : -normal;
  side.coverage = coverage;
  side.albedo = albedo;
  side.face_m2 = coverage * grid.cell_size_m * grid.cell_size_m;
  side.area_m2 = side.face_m2 / staircase_factor(normal);  // until collect_area
  side.radiosity = front || material_double_sided != 0 ? 3.14159265 * emission : vec3(0.0);
  side.cell = offset;
  side.face = face;
  side.depth = depth;
  side.front = front ? 1 : 0;
  uint index = side_index(cell_sides[offset], face);
  if (index < uint(sides.length())) sides[index] = side;  // too few: SlicedVoxelization grows the list and runs again
}

void main() {
  int b = axis_b(axis);
  int c = axis_c(axis);
  ivec3 column = ivec3(0);
  column[b] = int(gl_FragCoord.x) * SLICE_STEPS + SLICE_STEPS / 2;
  column[c] = int(gl_FragCoord.y) * SLICE_STEPS + SLICE_STEPS / 2;
  bvec3 positive;
  dvec3 areas = dvec3(edge_area(v_vertex[1], v_vertex[2], column, positive.x),
                      edge_area(v_vertex[2], v_vertex[0], column, positive.y),
                      edge_area(v_vertex[0], v_vertex[1], column, positive.z));
  dvec3 n = plane_normal();
  vec3 weights = n[axis] != 0.0 ? vec3(areas / n[axis]) : vec3(1.0, 0.0, 0.0);
  vec2 uv0 = weights.x * v_uv0[0] + weights.y * v_uv0[1] + weights.z * v_uv0[2];
  vec2 uv1 = weights.x * v_uv1[0] + weights.y * v_uv1[1] + weights.z * v_uv1[2];
  vec4 color = weights.x * v_color[0] + weights.y * v_color[1] + weights.z * v_color[2];
  // Textures first: their mip level comes from neighbouring fragments.
  vec4 albedo_alpha = material_albedo_alpha(uv0, uv1, color);
  vec3 emission = material_emission(uv0, uv1);
  float stopped = material_coverage(albedo_alpha.a);
  if (n[axis] == 0.0 || positive != bvec3(n[axis] > 0.0) || stopped <= 0.0) discard;
  float depth = dot(weights, vec3(v_vertex[0][axis], v_vertex[1][axis], v_vertex[2][axis])) / float(SLICE_STEPS);
  int i = blocked_face(n, column, depth);
  if (i < 0 || i > grid.cells[axis]) discard;
  // Rounding may tilt what the axis runs along to the other side.
  vec3 normal = v_normal[axis] * float(n[axis]) > 0.0 ? v_normal : vec3(normalize(n));
  ivec3 face_cell = ivec3(0);
  face_cell[b] = int(gl_FragCoord.x);
  face_cell[c] = int(gl_FragCoord.y);
  face_cell[axis] = i;
  int face = face_index(grid, axis, face_cell);
  depth = clamp(depth, float(i) - 0.5, float(i) + 0.5);
  uint depth_max = (1u << (32 - triangle_bits)) - 1u;
  uint quantised = min(uint((depth - float(i) + 0.5) * float(depth_max)), depth_max - 1u);
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
  uint o = opacity[face];
  float coverage = o >= 0x80000000u ? 1.0 : 1.0 - exp(-float(o) / 65536.0);
  ivec3 below = face_cell;
  below[axis] -= 1;
  if (key_low[face] == low) write_side(below, 2 * axis + 1, normal, depth, albedo_alpha.rgb, emission, coverage);
  if (key_high[face] == high) write_side(face_cell, 2 * axis, normal, depth, albedo_alpha.rgb, emission, coverage);
}
