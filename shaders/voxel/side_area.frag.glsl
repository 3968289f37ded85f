#version 450 core
// Area of the surface that every side stands for: every fine line that meets a triangle stands for a piece of it, which is
// added to the sides that show it, once for the cells in front of the triangle and once for those behind. The pieces in one
// cell belong to the same sides, but for a few. Fixed point: sums do not depend on order.
#include "voxel/slots.shared.h"
#include "voxel/visit_cells.glsl"
#include "voxel/find_side.glsl"

layout(std430, binding = AREA_FIXED_SLOT) buffer AreaFixed { uint area_fixed[]; };  // 2^-20 h^2
uniform int first_axis, last_axis;  // of the faces whose sides' areas are counted

void add_piece(inout Heap heap, vec3 weights, float stopped) {}

void end_cell(Lines lines, Heap heap) {
  float each = heap.area * piece_area() / float(bitCount(heap.pieces));
  uint rest = heap.pieces;
  while (rest != 0u) {
    bool place_matters = false;
    ivec3 targets[2];
    vec3 weights[2];
    vec3 point = first_point(lines, rest);
    for (int way = 0; way < 2; ++way) {
      sides_of_cell_point(point, way == 0 ? v_normal : -v_normal, 1 - way, targets[way], weights[way], place_matters);
    }
    int count = place_matters ? 1 : bitCount(rest);
    for (int way = 0; way < 2; ++way) {
      for (int a = first_axis; a <= last_axis; ++a) {
        if (weights[way][a] <= 0.0) continue;
        atomicAdd(area_fixed[targets[way][a]], uint(weights[way][a] * each * 1048576.0 + 0.5) * uint(count));
      }
    }
    rest = place_matters ? rest & (rest - 1u) : 0u;
  }
}

void main() { visit_cells(); }
