// Which of the 27 cells around a cell can be reached from it without crossing a face that stops everything, in at most
// three steps: light on them lies on the same side of the surfaces.
#include "voxel/cell_sides.glsl"
#include "voxel/grid_block.glsl"

// 3 x 3 x 3 bits, bit (dx+1) + 3 (dy+1) + 9 (dz+1).
uint reachable_cells(ivec3 centre) {
  uint reached = 1u << 13;
  for (int round = 0; round < 3; ++round) {
    uint before = reached;
    for (int k = 0; k < 27; ++k) {
      if (((before >> k) & 1u) == 0u) continue;
      ivec3 d = ivec3(k % 3 - 1, (k / 3) % 3 - 1, k / 9 - 1);
      if (abs(d.x) + abs(d.y) + abs(d.z) != round) continue;
      uvec2 own_sides = cell_sides[cell_index(grid, centre + d)];
      for (int face = 0; face < 6; ++face) {
        ivec3 next = d + face_step(face);
        if (any(greaterThan(abs(next), ivec3(1))) || is_opaque(own_sides, face)) continue;
        if (cell_inside(grid, centre + next)) reached |= 1u << (next.x + 1 + 3 * (next.y + 1) + 9 * (next.z + 1));
      }
    }
  }
  return reached;
}
