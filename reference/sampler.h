#pragma once
#include <cstdint>
#include <glm/glm.hpp>

#include "core/hash.h"

namespace volgi {

inline std::uint32_t hash(std::uint32_t a, std::uint32_t b) { return hash(hash(a) ^ (b * 0x9e3779b9u + 0x7f4a7c15u)); }

/// Numbers of one path: Owen-scrambled Sobol points, taken two dimensions at a time with the order of the points
/// shuffled anew for every pair. Counter-based: a number depends on (seed, index, dimension) and on nothing else.
/// Source: Burley 2020, "Practical Hash-based Owen Scrambling"; the scramble's constants are Vegdahl's (2021).
class PathSampler {
 public:
  /// @param seed   one per pixel and half; different seeds give independent point sets.
  /// @param index  0, 1, 2 ... within the set; the first 2^k points are stratified.
  PathSampler(std::uint32_t seed, std::uint32_t index) : seed_(seed), index_(index) {}

  /// Later numbers come from dimension pair `pair` on, so that a path's decisions keep their dimensions.
  void seek(std::uint32_t pair) { pair_ = pair; }

  glm::vec2 next2() {
    const std::uint32_t seed = hash(seed_, pair_++);
    const std::uint32_t i = owen_scramble(reverse_bits(index_), seed);  // the shuffled index, bits reversed
    return {to_unit(owen(i, hash(seed, 1))), to_unit(owen(second_dimension(reverse_bits(i)), hash(seed, 2)))};
  }
  float next1() {
    const std::uint32_t seed = hash(seed_, pair_++);
    return to_unit(owen(owen_scramble(reverse_bits(index_), seed), hash(seed, 1)));
  }
  /// Bits for a ray's alpha test; not stratified.
  std::uint32_t next_seed() { return hash(hash(seed_, index_), pair_++); }

 private:
  static std::uint32_t reverse_bits(std::uint32_t x) {
    x = (x >> 16) | (x << 16);
    x = ((x & 0x00ff00ffu) << 8) | ((x >> 8) & 0x00ff00ffu);
    x = ((x & 0x0f0f0f0fu) << 4) | ((x >> 4) & 0x0f0f0f0fu);
    x = ((x & 0x33333333u) << 2) | ((x >> 2) & 0x33333333u);
    return ((x & 0x55555555u) << 1) | ((x >> 1) & 0x55555555u);
  }
  // Flips each bit by a hash of the bits below it.
  static std::uint32_t owen_scramble(std::uint32_t x, std::uint32_t seed) {
    x ^= x * 0x3d20adeau;
    x += seed;
    x *= (seed >> 16) | 1u;
    x ^= x * 0x05526c56u;
    x ^= x * 0x53a22864u;
    return x;
  }
  // Nested uniform scramble of a point whose first binary digit is the top bit.
  static std::uint32_t owen(std::uint32_t point, std::uint32_t seed) {
    return reverse_bits(owen_scramble(reverse_bits(point), seed));
  }
  // Sobol's second dimension; the direction numbers are the rows of Pascal's triangle modulo 2.
  static std::uint32_t second_dimension(std::uint32_t index) {
    std::uint32_t result = 0;
    for (std::uint32_t direction = 1u << 31; index != 0; index >>= 1, direction ^= direction >> 1)
      if ((index & 1u) != 0) result ^= direction;
    return result;
  }
  static float to_unit(std::uint32_t x) { return static_cast<float>(x >> 8) * 0x1p-24f; }  // [0, 1)

  std::uint32_t seed_;
  std::uint32_t index_;
  std::uint32_t pair_ = 0;
};

}  // namespace volgi
