// Sums over a light's shadow map, of every group by itself: whoever needs them adds the groups in their order.
#include "screen/lights/lattice/lattice.shared.h"
#include "screen/lights/lattice/slots.shared.h"

layout(std430, binding = LATTICE_SUMS_SLOT) buffer Sums { LatticeSums sums[LATTICE_GROUPS]; };

float farthest_surface_m() {
  float farthest = 0.0;
  for (int g = 0; g < LATTICE_GROUPS; ++g) farthest = max(farthest, sums[g].farthest_m);
  return farthest;
}
