// Places that no light leaves: voxel/white_pockets.h.
#ifndef VOLGI_WHITE_POCKETS_SHARED_H
#define VOLGI_WHITE_POCKETS_SHARED_H
#include "shared/base.shared.h"
SHARED_BEGIN

// From here on an albedo counts as white. In a closed place a light of 1 W makes sides send 1 / (1 - albedo) W: 200
// here, for which conjugate gradients need 81 passes at most: sqrt(200) / 2 ln(2 / 2e-5), as BounceRules has it.
#define WHITE_ALBEDO 0.995f
// What white is instead where light would stay for ever.
#define MAX_POCKET_ALBEDO 0.95f

// Bands in which a side takes light away.
SHARED_FUNCTION uint bands_below_white(vec3 albedo) {
  return (albedo.x < WHITE_ALBEDO ? 1u : 0u) | (albedo.y < WHITE_ALBEDO ? 2u : 0u) |
         (albedo.z < WHITE_ALBEDO ? 4u : 0u);
}
#define ALL_BANDS 7u

SHARED_END
#endif
