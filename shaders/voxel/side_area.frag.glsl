#version 450 core
// Area of the surface that every side stands for: every fine line that meets a triangle stands for a piece of it, which is
// added to the sides that show it, once for the cells in front of the triangle and once for those behind. The pieces in one
// cell belong to the same sides. Fixed point: sums do not depend on order.
#include "voxel/visit_cells.glsl"
#include "voxel/find_side.glsl"

layout(std430, binding = 0) buffer AreaFixed { uint area_fixed[]; };  // 2^-20 h^2

void add_piece(inout Heap heap, vec3 weights, float stopped) {}

void end_cell(Heap heap) {
  float area = heap.area * piece_area();
  for (int front = 1; front >= 0; --front) {
    ivec3 targets;
    vec3 weights;
    sides_of_cell_point(heap.point, front == 1 ? v_normal : -v_normal, front, targets, weights);
    for (int a = 0; a < 3; ++a) {
      if (weights[a] > 0.0) atomicAdd(area_fixed[targets[a]], uint(weights[a] * area * 1048576.0 + 0.5));
    }
  }
}

void main() { visit_cells(); }
