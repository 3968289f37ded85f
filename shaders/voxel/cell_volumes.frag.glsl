#version 450 core
// Adds the surface in each cell to the cell's sums (Gaitatzes 2010, section 4.1, with areas for weights). Fixed point: sums
// do not depend on order.
// Where alpha varies, colours count as it does; what is opaque has one of the whole cell (end_cell).
#define FOOTPRINT (material_alpha_mode == MATERIAL_OPAQUE ? 1.0 : 1.0 / 3.0)
#include "shared/constants.glsl"
#include "voxel/visit_cells.glsl"
#include "voxel/cell_sums.glsl"

void add_piece(inout Heap heap, vec3 weights, float stopped) {
  if (material_alpha_mode == MATERIAL_OPAQUE) return;
  heap.albedo += stopped * albedo_alpha_at(weights).rgb;
  heap.radiosity = max(heap.radiosity, PI * material_emission(uv0_at(weights), uv1_at(weights)));
}

// At the middle line of a cell's column, or where the triangle is nearest to it by its weights.
vec3 weights_at_cell(Lines lines, ivec3 cell) {
  ivec2 middle = 3 * in_family(cell, v_axis).yz + 1;
  vec3 inside = clamp(weights_at(lines, edges_at(lines, middle)), 0.0, 1.0);
  return inside / (inside.x + inside.y + inside.z);
}

uint fixed_point(float v) { return uint(int(floor(v * AREA_UNITS + 0.5))); }

void end_cell(Lines lines, Heap heap) {
  if (material_alpha_mode == MATERIAL_OPAQUE) {
    vec3 weights = weights_at_cell(lines, heap.cell);
    heap.albedo = heap.area * albedo_alpha_at(weights).rgb;
    heap.radiosity = 3.14159265 * material_emission(uv0_at(weights), uv1_at(weights));
  }
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
