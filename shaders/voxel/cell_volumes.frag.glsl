#version 450 core
// Adds the surface in each cell to the cell's sums (Gaitatzes 2010, section 4.1, with areas for weights). Fixed point: sums
// do not depend on order.
#include "voxel/visit_cells.glsl"
#include "voxel/cell_sums.glsl"

void add_piece(inout Heap heap, vec3 weights, float stopped) {
  heap.albedo += stopped * albedo_alpha_at(weights).rgb;
  heap.radiosity = max(heap.radiosity, 3.14159265 * material_emission(uv0_at(weights), uv1_at(weights)));
}

uint fixed_point(float v) { return uint(int(floor(v * AREA_UNITS + 0.5))); }

void end_cell(Lines lines, Heap heap) {
  int cell = cell_index(grid, heap.cell);
  float area = heap.area * piece_area();
  vec3 albedo = heap.albedo * piece_area();
  vec3 normal = v_normal * area;
  atomicAdd(cell_sums[0].at[cell].x, fixed_point(area));
  atomicMax(cell_sums[0].at[cell].y, floatBitsToUint(heap.stopped));
  atomicAdd(cell_sums[1].at[cell].x, fixed_point(albedo.r));
  atomicAdd(cell_sums[1].at[cell].y, fixed_point(albedo.g));
  atomicAdd(cell_sums[2].at[cell].x, fixed_point(albedo.b));
  atomicAdd(cell_sums[2].at[cell].y, fixed_point(normal.x));
  atomicAdd(cell_sums[3].at[cell].x, fixed_point(normal.y));
  atomicAdd(cell_sums[3].at[cell].y, fixed_point(normal.z));
  if (heap.radiosity == vec3(0.0)) return;
  atomicMax(cell_sums[4].at[cell].x, floatBitsToUint(heap.radiosity.r));
  atomicMax(cell_sums[4].at[cell].y, floatBitsToUint(heap.radiosity.g));
  atomicMax(cell_sums[5].at[cell].x, floatBitsToUint(heap.radiosity.b));
}

void main() { visit_cells(); }
