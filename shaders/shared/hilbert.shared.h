// Hilbert's curve through 2^16 x 2^16 cells of the unit square: what follows on it is near, so that pieces of equal
// length are compact and of equal area. The way back is core/hilbert.h.
#ifndef VOLGI_HILBERT_SHARED_H
#define VOLGI_HILBERT_SHARED_H
#include "shared/base.shared.h"
SHARED_BEGIN

// Middle of the cell, in the unit square.
SHARED_FUNCTION vec2 hilbert_point(uint index) {
  uint x = 0u, y = 0u;
  for (uint side = 1u; side < 65536u; side *= 2u) {
    uint right = (index >> 1) & 1u;
    uint upper = (index ^ right) & 1u;
    if (upper == 0u) {
      if (right == 1u) {
        x = side - 1u - x;
        y = side - 1u - y;
      }
      uint swap = x;
      x = y;
      y = swap;
    }
    x += side * right;
    y += side * upper;
    index >>= 2;
  }
  return (vec2(float(x), float(y)) + 0.5f) / 65536.0f;
}

SHARED_END
#endif
