// The bin of a pixel's error estimate.
#ifndef VOLGI_EXACT_PIXELS_GLSL
#define VOLGI_EXACT_PIXELS_GLSL

#include "screen/gather/interleaved/exact_pixels.shared.h"

uint error_bin(float error_estimate) { return floatBitsToUint(max(error_estimate, 0.0)) >> 20; }

#endif
