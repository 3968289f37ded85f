// Values per side kept in 2D textures.
#include "propagation/sweep.shared.h"

ivec2 side_texel(int side) { return ivec2(side & ((1 << SIDE_ROW_BITS) - 1), side >> SIDE_ROW_BITS); }

// What reaches a side in parts: four entries, one for each octant that can reach it, of `lanes` parts each.
ivec2 arrived_texel(int side, int entry, int lane, int lanes) {
  return ivec2(((side & ((1 << ARRIVED_ROW_BITS) - 1)) * 4 + entry) * lanes + lane, side >> ARRIVED_ROW_BITS);
}
// The entry's number is the octant's on the two other axes.
int entry_of_octant(int octant, int axis) {
  return axis == 0 ? octant >> 1 : axis == 1 ? (octant & 1) | ((octant >> 1) & 2) : octant & 3;
}
