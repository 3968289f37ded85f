// Surfaces that negative lights may stand on: the middles of equal parts of the screen, or with SIDES the sides of the
// volume. Each has the flux that passes through it as its weight.
#ifndef VOLGI_NEGATIVE_CANDIDATES_GLSL
#define VOLGI_NEGATIVE_CANDIDATES_GLSL
#include "screen/visibility/negative/negative_candidates.shared.h"
#include "screen/visibility/negative/slots.shared.h"

// Flux [W]; then summed from the first on.
layout(std430, binding = PASSED_FLUX_SLOT) buffer Weights { float weights[]; };

#ifdef SIDES
#include "screen/visibility/negative/sides_by_block.glsl"
#include "voxel/side_count.glsl"
#include "voxel/sides.glsl"

int candidate_count() { return min(int(side_count), min(sides.length(), weights.length())); }
#else
int candidate_count() { return CANDIDATES_X * CANDIDATES_Y; }
#endif

float total_weight() { return candidate_count() > 0 ? weights[candidate_count() - 1] : 0.0; }

float weight_of(int candidate) { return weights[candidate] - (candidate > 0 ? weights[candidate - 1] : 0.0); }

// First candidate whose sum exceeds `sum`.
int candidate_at(float sum) {
  int low = 0, high = candidate_count() - 1;
  while (low < high) {
    int middle = (low + high) / 2;
    if (weights[middle] > sum) high = middle;
    else low = middle + 1;
  }
  return low;
}

#endif
