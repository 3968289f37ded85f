// Light that leaves a surface at a point goes to the sides that stand for that surface, in fixed point, so that sums do
// not depend on order: 64 bits, for a texel of a narrow spot's large map may bring 1e-13 of what the light could send.
#include "voxel/find_side.glsl"

#include "propagation/fixed_flux.glsl"

// The side of the 5^3 cells around that is nearest and faces most alike; those that face the surface's way, of cells that
// reach in front of it, before all others, and before those the sides of cells to which the point's light comes. None where the surface is the grid's rim and looks out.
int find_any_side(vec3 point, vec3 normal) {
  float reach = DEPOSIT_REACH * staircase_factor(normal);
  ivec3 centre = ivec3(floor(point)), own = seeing_cell(point, normal);
  if (!cell_inside(grid, ivec3(floor(point + reach * normal)))) return -1;
  bool at_rim = !cell_inside(grid, own);  // what sees the point is outside: its own surface goes on in the grid, or nothing does
  int best = -1;
  float best_score = -1e30;
  for (int k = 0; k < 125; ++k) {
    ivec3 offset = ivec3(k % 5 - 2, (k / 5) % 5 - 2, k / 25 - 2);
    ivec3 cell = centre + offset;
    vec3 to_centre = vec3(cell) + 0.5 - point;
    if (!cell_inside(grid, cell)) continue;
    bool in_front = dot(to_centre, normal) > -reach;
    uvec2 own_sides = cell_sides[cell_index(grid, cell)];
    if ((own_sides.y & 63u) == 0u) continue;
    bool hidden = hidden_from_cell(cell, own_sides, point, normal);
    bool seen = !hidden && open_way(own, cell);
    for (int face = 0; face < 6; ++face) {
      if (!has_side(own_sides, face)) continue;
      int index = int(side_index(own_sides, face));
      float cosine = dot(sides[index].normal, normal);
      if (at_rim && (hidden || cosine < SIMILAR_NORMAL_COSINE)) continue;
      float score = cosine - length(to_centre) + (in_front && cosine > 0.0 ? DEPOSIT_FIRST : 0.0) + (seen ? DEPOSIT_SEEN : 0.0);
      if (score > best_score) {
        best_score = score;
        best = index;
      }
    }
  }
  return best;
}

// 64-bit sums by 32-bit atomics: a low word that wraps carries one. Every addition sees the low word that it met, so
// that all wraps are counted, in any order of threads.
#define ADD_FIXED(sum, units)                                         \
  {                                                                   \
    uint low_before = atomicAdd(sum.x, units.x);                      \
    uint carried = units.y + (low_before > ~units.x ? 1u : 0u);       \
    if (carried != 0u) atomicAdd(sum.y, carried);                     \
  }

void add_flux(int side, vec3 flux) {
  for (int band = 0; band < 3; ++band) {
    if (flux[band] <= 0.0) continue;
    uvec2 units = fixed_from_share(flux[band] / source_power);
    if (side < 0) ADD_FIXED(flux_lost[band], units)
    else ADD_FIXED(flux_fixed[3 * side + band], units)
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
