// Bins of a histogram of positive floats: an eighth of an octave each, at any scale.
#ifndef VOLGI_EXACT_PIXELS_GLSL
#define VOLGI_EXACT_PIXELS_GLSL

#define ERROR_BINS 2048u  // screen/gather/interleaved/area_light_gather.cpp has the same
uint error_bin(float error_estimate) { return floatBitsToUint(max(error_estimate, 0.0)) >> 20; }

#endif
