// Sums of one source's deposits, as shares of the source's power in units of 2^-60: what all deposits round away is
// below 2^-33 of it even for 2^28 of them, and 16 times the power fits.
#include "propagation/slots.shared.h"

layout(std430, binding = FLUX_FIXED_SLOT) buffer FluxFixed { uvec2 flux_fixed[]; };  // 3 per side: low and high word
layout(std430, binding = FLUX_LOST_SLOT) buffer FluxLost { uvec2 flux_lost[3]; };    // what found no side
uniform float source_power;  // [W], per band no more is deposited

const float HIGH_WORDS = 268435456.0;  // 2^28 in a share of 1
const float WORD = 4294967296.0;       // 2^32

uvec2 fixed_from_share(float share) {
  float high = floor(share * HIGH_WORDS);
  return uvec2(uint((share * HIGH_WORDS - high) * WORD + 0.5), uint(high));
}

float share_from_fixed(uvec2 units) { return (float(units.y) + float(units.x) / WORD) / HIGH_WORDS; }
