// Surfaces that negative lights may stand on: the middles of equal parts of the screen, or with SIDES the sides of the
// volume. Each has the flux that passes through it as its weight.
#ifndef VOLGI_NEGATIVE_CANDIDATES_GLSL
#define VOLGI_NEGATIVE_CANDIDATES_GLSL

layout(std430, binding = 2) buffer Weights { float weights[]; };  // flux [W]; then summed from the first on

#ifdef SIDES
#include "screen/visibility/negative/sides_by_block.glsl"
layout(std430, binding = 4) readonly buffer Sides { Side sides[]; };
layout(std430, binding = 5) readonly buffer SideCount { uint side_count; };

int candidate_count() { return min(int(side_count), min(sides.length(), weights.length())); }
#else
#define CANDIDATES_X 64
#define CANDIDATES_Y 64
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
