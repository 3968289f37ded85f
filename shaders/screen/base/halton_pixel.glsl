// Pixels that spread evenly over the picture: points of the Halton sequence of bases 2 and 3 (twin: core/halton.h).
#ifndef VOLGI_HALTON_PIXEL_GLSL
#define VOLGI_HALTON_PIXEL_GLSL

float radical_inverse_3(uint i) {
  float sum = 0.0, digit = 1.0 / 3.0;
  for (; i > 0u; i /= 3u, digit /= 3.0) sum += float(i % 3u) * digit;
  return sum;
}

// Pixel of point k + 1, k = 0, 1, ...
ivec2 halton_pixel(uint k, ivec2 size) {
  vec2 point = vec2(float(bitfieldReverse(k + 1u)) / 4294967296.0, radical_inverse_3(k + 1u));
  return min(ivec2(point * vec2(size)), size - 1);
}

#endif
