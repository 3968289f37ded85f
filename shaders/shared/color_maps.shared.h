// Numbers as display values, for pictures of what is inside a frame or a file and for errors.
#ifndef VOLGI_COLOR_MAPS_SHARED_H
#define VOLGI_COLOR_MAPS_SHARED_H
#include "shared/base.shared.h"
SHARED_BEGIN

const vec3 NAN_COLOR = vec3(1.0f, 0.0f, 1.0f);
const vec3 INFINITY_COLOR = vec3(0.0f, 1.0f, 1.0f);
const vec3 NOTHING_COLOR = vec3(0.1f, 0.1f, 0.1f);  // where there is nothing to show

// For t in [0,1]. Fit of the map of Smith and van der Walt (matplotlib, CC0) by M. Zucker, shadertoy.com/view/WlfXRN
// (CC0).
SHARED_FUNCTION vec3 viridis(float t) {
  float x = clamp(t, 0.0f, 1.0f);
  vec3 color = vec3(-5.4354558559f, 4.6458526122f, 26.3124352496f);
  color = color * x + vec3(4.7763849977f, -13.7451453777f, -65.3530326334f);
  color = color * x + vec3(6.2282699363f, 14.1799333668f, 56.6905526007f);
  color = color * x + vec3(-4.6342304990f, -5.7991009734f, -19.3324409563f);
  color = color * x + vec3(-0.3308618287f, 0.2148475595f, 0.0950951630f);
  color = color * x + vec3(0.1050930431f, 1.4046135299f, 1.3845901626f);
  color = color * x + vec3(0.2777273272f, 0.0054073445f, 0.3340998053f);
  return clamp(color, 0.0f, 1.0f);
}

// For s in [-1,1]: white where two things are equal, red where the one in question is greater, blue where it is less.
SHARED_FUNCTION vec3 difference_color(float s) {
  float e = clamp(s, -1.0f, 1.0f);
  return vec3(1.0f + min(e, 0.0f), 1.0f - abs(e), 1.0f - max(e, 0.0f));
}

// A hue for every number, those of numbers in a row far apart (multiples of the golden ratio).
SHARED_FUNCTION vec3 hashed_color(uint number) {
  uint bits = (number + 1u) * 2654435769u;
  vec3 wheel = vec3(0.0f, 2.0f, 1.0f) / 3.0f + float(bits >> 8) / 16777216.0f;
  vec3 hue = clamp(abs((wheel - floor(wheel)) * 6.0f - vec3(3.0f)) - 1.0f, 0.0f, 1.0f);
  return vec3(0.25f) + (0.45f + 0.3f * float((bits >> 4) & 1u)) * hue;
}

SHARED_END
#endif
