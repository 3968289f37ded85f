#pragma once
#include <cstdint>

namespace volgi {

/// lowbias32 (Ellis 2018): a 32-bit permutation with bias below 0.2 %.
inline std::uint32_t hash(std::uint32_t x) {
  x ^= x >> 16;
  x *= 0x7feb352du;
  x ^= x >> 15;
  x *= 0x846ca68bu;
  return x ^ (x >> 16);
}

}  // namespace volgi
