// Light that leaves a surface at a point goes to the sides that stand for that surface, in fixed point, so that sums do
// not depend on order.
#include "voxel/find_side.glsl"

layout(std430, binding = 12) buffer FluxFixed { uint flux_fixed[]; };  // 3 per side
layout(std430, binding = 13) buffer FluxLost { uint flux_lost[3]; };   // what found no side
uniform float flux_unit;  // [W]; all light of one source is at most 2^30 of them

// The side of the 5^3 cells around that is nearest and faces most alike; those that face the surface's way, of cells that
// reach in front of it, before all others. None where the surface is the grid's rim and looks out.
int find_any_side(vec3 point, vec3 normal) {
  float reach = DEPOSIT_REACH * staircase_factor(normal);
  if (!cell_inside(grid, ivec3(floor(point + reach * normal)))) return -1;
  ivec3 centre = ivec3(floor(point));
  int best = -1;
  float best_score = -1e30;
  for (int k = 0; k < 125; ++k) {
    ivec3 offset = ivec3(k % 5 - 2, (k / 5) % 5 - 2, k / 25 - 2);
    ivec3 cell = centre + offset;
    vec3 to_centre = vec3(cell) + 0.5 - point;
    if (!cell_inside(grid, cell)) continue;
    bool in_front = dot(to_centre, normal) > -reach;
    uvec2 own_sides = cell_sides[cell_index(grid, cell)];
    for (int face = 0; face < 6; ++face) {
      if (!has_side(own_sides, face)) continue;
      int index = int(side_index(own_sides, face));
      float cosine = dot(sides[index].normal, normal);
      float score = cosine - length(to_centre) + (in_front && cosine > 0.0 ? DEPOSIT_FIRST : 0.0);
      if (score > best_score) {
        best_score = score;
        best = index;
      }
    }
  }
  return best;
}

void add_flux(int side, vec3 flux) {
  uvec3 units = uvec3(flux / flux_unit + 0.5);
  if (side < 0) {
    for (int band = 0; band < 3; ++band) atomicAdd(flux_lost[band], units[band]);
    return;
  }
  for (int band = 0; band < 3; ++band) {
    if (units[band] != 0u) atomicAdd(flux_fixed[3 * side + band], units[band]);
  }
}

void deposit(vec3 world_position, vec3 normal, vec3 flux) {
  ivec3 targets;
  vec3 weights;
  sides_of_point(world_position, normal, -1, targets, weights);
  if (weights == vec3(0.0)) {
    add_flux(find_any_side(cell_from_world(grid, world_position), normal), flux);
    return;
  }
  for (int axis = 0; axis < 3; ++axis) {
    if (weights[axis] > 0.0) add_flux(targets[axis], weights[axis] * flux);
  }
}
