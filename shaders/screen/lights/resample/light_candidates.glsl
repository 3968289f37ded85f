// Candidates of one source, and what they are worth to the picture.
#ifndef VOLGI_LIGHT_CANDIDATES_GLSL
#define VOLGI_LIGHT_CANDIDATES_GLSL
#include "screen/lights/resample/resample.shared.h"
#include "screen/lights/resample/slots.shared.h"
#include "shared/virtual_light.shared.h"

struct Receiver {
  vec4 position;  // w = 0: none, the background
  vec4 normal;
};
layout(std430, binding = CANDIDATES_SLOT) readonly buffer Candidates { VirtualLight candidate_lights[]; };
layout(std430, binding = RECEIVERS_SLOT) buffer Receivers { Receiver receivers[RESAMPLE_RECEIVERS]; };
// (light sent to the receivers, flux) of a candidate, luminance; then both summed from the source's first on.
layout(std430, binding = CANDIDATE_WEIGHTS_SLOT) buffer Weights { vec2 weights[]; };
uniform int first_candidate;
uniform int candidate_count;
uniform float flux_share;

// Share of all that is chosen, that the candidates up to this one have: from 0 to 1.
float summed_probability(int candidate) {
  vec2 total = weights[first_candidate + candidate_count - 1];
  vec2 sum = candidate < 0 ? vec2(0.0) : weights[first_candidate + candidate];
  float by_flux = total.y > 0.0 ? sum.y / total.y : 0.0;
  return total.x > 0.0 ? mix(sum.x / total.x, by_flux, flux_share) : by_flux;
}

#endif
