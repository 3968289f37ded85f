// Vectors of lanes (Constants), and how a side's power goes into them and out again. Part of
// sweep_kernel_body_internal.h.
#include "propagation/sweep/sweep_kernel.h"

namespace volgi::sweep {
namespace {

template <int kLanes>
struct Vector;
template <>
struct Vector<4> {
  using Type = float __attribute__((vector_size(16), may_alias));
};
template <>
struct Vector<8> {
  using Type = float __attribute__((vector_size(32), may_alias));
};
template <>
struct Vector<16> {
  using Type = float __attribute__((vector_size(64), may_alias));
};
template <int kLanes>
using Vec = typename Vector<kLanes>::Type;
using Quad = Vec<kQuad>;

template <int kLanes>
VOLGI_INLINE Vec<kLanes> load(const float* p) {
  return *reinterpret_cast<const Vec<kLanes>*>(p);
}
template <int kLanes>
VOLGI_INLINE void store(float* p, Vec<kLanes> v) {
  *reinterpret_cast<Vec<kLanes>*>(p) = v;
}

// Whether the fourth lanes of quads hold anything (Constants).
template <int kOctets>
constexpr bool kFourth = kOctets > 3;

// A side's power in the lanes of an octet, or two.
template <int kOctets>
VOLGI_INLINE Vec<8> spread_octet(const Constants& c, int octet, const float* power) {
  Quad q = load<kQuad>(power);
  if constexpr (kFourth<kOctets>) {
    const float fourth = power[c.fourth[octet]];
    q = __builtin_shufflevector(q, Quad{fourth, fourth, fourth, fourth}, 0, 1, 2, 7);
  }
  return __builtin_shufflevector(q, q, 0, 1, 2, 3, 0, 1, 2, 3);
}
template <int kOctets, int kLanes>
VOLGI_INLINE Vec<kLanes> spread(const Constants& c, int octet, const float* power) {
  if constexpr (kLanes == 8) {
    return spread_octet<kOctets>(c, octet, power);
  } else {  // halves first: GCC 12 takes four quads through memory
    return __builtin_shufflevector(spread_octet<kOctets>(c, octet, power), spread_octet<kOctets>(c, octet + 1, power),
                                   0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
  }
}

// The other way round: sums of the lanes of each band. The fourth number is of no use.
template <int kOctets>
VOLGI_INLINE Quad gather_octet(const Constants& c, int octet, Vec<8> v) {
  const Quad q = __builtin_shufflevector(v, v, 0, 1, 2, 3) + __builtin_shufflevector(v, v, 4, 5, 6, 7);
  if constexpr (!kFourth<kOctets>) return q;
  return q + __builtin_shufflevector(q, q, 3, 3, 3, 3) * load<kQuad>(c.fold[octet]);
}
template <int kOctets, int kLanes>
VOLGI_INLINE Quad gather(const Constants& c, int octet, Vec<kLanes> v) {
  if constexpr (kLanes == 8) {
    return gather_octet<kOctets>(c, octet, v);
  } else {
    const Vec<8> low = __builtin_shufflevector(v, v, 0, 1, 2, 3, 4, 5, 6, 7);
    const Vec<8> high = __builtin_shufflevector(v, v, 8, 9, 10, 11, 12, 13, 14, 15);
    if constexpr (!kFourth<kOctets>) return gather_octet<kOctets>(c, octet, low + high);
    return gather_octet<kOctets>(c, octet, low) + gather_octet<kOctets>(c, octet + 1, high);
  }
}

// Calls f(Width<lanes>(), octet) for all octets, two at a time where registers are wide.
template <int kLanes>
struct Width {};
template <int kOctets, class F>
VOLGI_INLINE void for_octets(const F& f) {
#if VOLGI_SWEEP_WIDE
  for (int o = 0; o + 1 < kOctets; o += 2) f(Width<16>(), o);
  if constexpr (kOctets % 2 != 0) f(Width<8>(), kOctets - 1);
#else
  for (int o = 0; o < kOctets; ++o) f(Width<8>(), o);
#endif
}

}  // namespace
}  // namespace volgi::sweep
