// The body of sh_lobes_{baseline,avx2,avx512}.cpp, which name its namespace VOLGI_LOBES and the floats in a vector,
// VOLGI_LOBES_WIDTH: 8, a row of cells along z, or 16, the rows of y = 2n and 2n+1. Formulas and numbers:
// docs/theory.md#conservative, shaders/shared/sh_constants.shared.h.
#ifdef __AVX__
#include <immintrin.h>
#endif

#include "propagation/lobes/sh_lobes_kernels.h"
#include "shaders/shared/sh_constants.shared.h"

namespace volgi::VOLGI_LOBES {
namespace {

using namespace shared;  // NOLINT: only constants

constexpr int kWidth = VOLGI_LOBES_WIDTH;
typedef float Row __attribute__((vector_size(4 * kWidth), may_alias));
typedef float UnalignedRow __attribute__((vector_size(4 * kWidth), may_alias, aligned(4)));
typedef float HalfRow __attribute__((vector_size(32), may_alias));
typedef float UnalignedHalfRow __attribute__((vector_size(32), may_alias, aligned(4)));
typedef std::int32_t Mask __attribute__((vector_size(4 * kWidth)));

#define VOLGI_INLINE inline __attribute__((always_inline))

VOLGI_INLINE Row load(const float* p) { return *reinterpret_cast<const Row*>(p); }
VOLGI_INLINE Row load_unaligned(const float* p) { return *reinterpret_cast<const UnalignedRow*>(p); }
VOLGI_INLINE void store(float* p, Row r) { *reinterpret_cast<Row*>(p) = r; }

/// Past the cache.
VOLGI_INLINE void store_streaming(float* p, Row r) {
#if VOLGI_LOBES_WIDTH == 16
  _mm512_stream_ps(p, __m512(r));
#elif defined(__AVX__)
  _mm256_stream_ps(p, __m256(r));
#else
  store(p, r);
#endif
}
template <bool kStream>
VOLGI_INLINE void store_leaf(float* p, Row r) {
  if constexpr (kStream) {
    store_streaming(p, r);
  } else {
    store(p, r);
  }
}

typedef std::int32_t HalfMask __attribute__((vector_size(32)));
VOLGI_INLINE Row select(Mask m, Row a) { return m ? a : Row{}; }
#if VOLGI_LOBES_WIDTH != 8
VOLGI_INLINE HalfRow select(HalfMask m, HalfRow a) { return m ? a : HalfRow{}; }
#endif
VOLGI_INLINE float select(bool m, float a) { return m ? a : 0.0f; }

/// Where the power through a face is zero, that is not a matter of rounding (FLUX_MIN_SHARE).
template <class T>
VOLGI_INLINE auto passes(T power, const T* l) {
  return power > FLUX_MIN_SHARE * l[0];
}

/// Lobes of order 1: the flux of radiance through the face, projected on four coefficients.
struct Order1 {
  static constexpr int kCoefficients = 4;
  static constexpr int component(int axis) { return axis == 0 ? 3 : axis; }

  template <int kAxis, int kSign, class T>
  static VOLGI_INLINE T power(const T* l) {
    return FLUX_00 * l[0] + (kSign * FLUX_01) * l[component(kAxis)];
  }

  /// Adds the parts of two lobes that travel up (from below) and down (from above) the axis.
  template <int kAxis, class T, class M>
  static VOLGI_INLINE void add_both(const T* below, M open_below, const T* above, M open_above, T* out) {
    const T up = power<kAxis, 1>(below), down = power<kAxis, -1>(above);
    add_open<kAxis, T, M>(below, up, open_below & passes(up, below), above, down, open_above & passes(down, above),
                          out);
  }

  /// The same of what is known to pass: `up` and `down` are the powers.
  template <int kAxis, class T, class M>
  static VOLGI_INLINE void add_open(const T* below, T up, M u, const T* above, T down, M d, T* out) {
    constexpr int a = component(kAxis), b = component((kAxis + 1) % 3), c = component((kAxis + 2) % 3);
    out[0] += select(u, up) + select(d, down);
    out[a] += select(u, FLUX_10 * below[0] + FLUX_11 * below[a]) + select(d, FLUX_11 * above[a] - FLUX_10 * above[0]);
    out[b] += FLUX_ACROSS_11 * (select(u, below[b]) + select(d, above[b]));
    out[c] += FLUX_ACROSS_11 * (select(u, below[c]) + select(d, above[c]));
  }
};

/// Lobes of order 2: the same on nine.
struct Order2 {
  static constexpr int kCoefficients = 9;
  static constexpr int component(int axis) { return axis == 0 ? 3 : axis; }
  /// Of the product of two axes: xy 4, yz 5, xz 7.
  static constexpr int product(int a, int b) { return a + b == 1 ? 4 : a + b == 3 ? 5 : 7; }
  static VOLGI_INLINE float turn(int axis) { return axis == 0 ? SH_HALF_SQRT3 : -SH_HALF_SQRT3; }

  /// Coefficient of 1.5 a^2 - 0.5 out of 20 and 22.
  template <int kAxis, class T>
  static VOLGI_INLINE T about(const T* l) {
    if constexpr (kAxis == 2) {
      return l[6];
    } else {
      return turn(kAxis) * l[8] - 0.5f * l[6];
    }
  }
  /// Coefficient of b^2 - c^2, the next two axes.
  template <int kAxis, class T>
  static VOLGI_INLINE T twin(const T* l) {
    if constexpr (kAxis == 2) {
      return l[8];
    } else {
      return -turn(kAxis) * l[6] - 0.5f * l[8];
    }
  }

  template <int kAxis, int kSign, class T>
  static VOLGI_INLINE T power(const T* l) {
    return FLUX_00 * l[0] + (kSign * FLUX_01) * l[component(kAxis)] + FLUX_02 * about<kAxis>(l);
  }

  /// Even and odd moments about the axis come out of the sums and differences of what travels up and down.
  template <int kAxis, class T, class M>
  static VOLGI_INLINE void add_both(const T* below, M open_below, const T* above, M open_above, T* out) {
    const T up = power<kAxis, 1>(below), down = power<kAxis, -1>(above);
    add_open<kAxis, T, M>(below, up, open_below & passes(up, below), above, down, open_above & passes(down, above),
                          out);
  }

  template <int kAxis, class T, class M>
  static VOLGI_INLINE void add_open(const T* below, T up, M u, const T* above, T down, M d, T* out) {
    constexpr int kB = (kAxis + 1) % 3, kC = (kAxis + 2) % 3;
    constexpr int a = component(kAxis), b = component(kB), c = component(kC);
    constexpr int ab = product(kAxis, kB), ac = product(kAxis, kC), bc = product(kB, kC);
    const T below_0 = select(u, below[0]), above_0 = select(d, above[0]);
    const T below_a = select(u, below[a]), above_a = select(d, above[a]);
    const T below_q = select(u, about<kAxis>(below)), above_q = select(d, about<kAxis>(above));
    out[0] += select(u, up) + select(d, down);
    out[a] += FLUX_10 * (below_0 - above_0) + FLUX_11 * (below_a + above_a) + FLUX_12 * (below_q - above_q);
    const T q = FLUX_20 * (below_0 + above_0) + FLUX_21 * (below_a - above_a) + FLUX_22 * (below_q + above_q);
    const T t = FLUX_TWIN * (select(u, twin<kAxis>(below)) + select(d, twin<kAxis>(above)));
    if constexpr (kAxis == 2) {
      out[6] += q;
      out[8] += t;
    } else {
      out[6] -= 0.5f * q + turn(kAxis) * t;
      out[8] += turn(kAxis) * q - 0.5f * t;
    }
    add_across(select(u, below[b]), select(d, above[b]), select(u, below[ab]), select(d, above[ab]), out[b], out[ab]);
    add_across(select(u, below[c]), select(d, above[c]), select(u, below[ac]), select(d, above[ac]), out[c], out[ac]);
    out[bc] += FLUX_DIAGONAL * (select(u, below[bc]) + select(d, above[bc]));
  }

  template <class T>
  static VOLGI_INLINE void add_across(T below_1, T above_1, T below_2, T above_2, T& out_1, T& out_2) {
    out_1 += FLUX_ACROSS_11 * (below_1 + above_1) + FLUX_ACROSS_12 * (below_2 - above_2);
    out_2 += FLUX_ACROSS_21 * (below_1 - above_1) + FLUX_ACROSS_22 * (below_2 + above_2);
  }
};

/// What really leaves through a face.
template <class Order, int kAxis, int kSign, class T>
VOLGI_INLINE T passed(const T* l) {
  const T power = Order::template power<kAxis, kSign>(l);
  return select(passes(power, l), power);
}

template <class Order, class T>
VOLGI_INLINE T passed_sum(const T* l) {
  return (passed<Order, 0, -1>(l) + passed<Order, 0, 1>(l)) + (passed<Order, 1, -1>(l) + passed<Order, 1, 1>(l)) +
         (passed<Order, 2, -1>(l) + passed<Order, 2, 1>(l));
}

template <class Order>
VOLGI_INLINE void rescale_row(Row* l) {
  const Row sum = passed_sum<Order>(l);
  const Mask lit = sum > 0.0f;
  const Row factor = select(lit, l[0] / (lit ? sum : Row{} + 1.0f));
  for (int k = 0; k < Order::kCoefficients; ++k) l[k] *= factor;
}

/// Bit k: component k is above zero.
VOLGI_INLINE std::uint32_t lit_bits(Row r) {
#if VOLGI_LOBES_WIDTH == 16
  return _mm512_cmp_ps_mask(__m512(r), _mm512_setzero_ps(), _CMP_GT_OQ);
#elif defined(__AVX__)
  return std::uint32_t(_mm256_movemask_ps(_mm256_cmp_ps(__m256(r), _mm256_setzero_ps(), _CMP_GT_OQ)));
#else
  std::uint32_t bits = 0;
  for (int i = 0; i < kWidth; ++i) bits |= std::uint32_t(r[i] > 0.0f) << i;
  return bits;
#endif
}

/// Calls f(offset of a vector's first cell) for the vectors that hold some of the rows.
template <class F>
VOLGI_INLINE void for_rows(std::uint64_t rows, const F& f) {
  if (rows == kAllRows) {
    for (int at = 0; at < kLobeLeafCells; at += kWidth) f(at);
    return;
  }
  if (kWidth == 16) rows = (rows | rows >> 1) & 0x5555555555555555u;
  for (; rows != 0; rows &= rows - 1) f(8 * __builtin_ctzll(rows));
}

/// What rescaling looks at on the way: power (before: that is what the rescaled lobe carries), and which rows are lit.
/// `at` is the offset of a vector's first cell.
struct Tally {
  Row sum{};
  std::uint64_t lit = 0, low = 0, high = 0;

  VOLGI_INLINE void add(int at, Row power) {
    sum += power;
    const std::uint32_t bits = lit_bits(power);
    add_row(at >> 3, bits & 255u);
    if (kWidth == 16) add_row((at >> 3) + 1, bits >> 8);
  }
  VOLGI_INLINE void add_row(int row, std::uint32_t bits) {
    lit |= std::uint64_t(bits != 0) << row;
    low |= std::uint64_t(bits & 1u) << row;
    high |= std::uint64_t(bits >> 7) << row;
  }
  void finish(int band, LeafLight& light) const {
    float along_z[8];
    for (int z = 0; z < 8; ++z) along_z[z] = sum[z] + (kWidth == 16 ? sum[z + kWidth - 8] : 0.0f);
    light.power[band] = ((along_z[0] + along_z[1]) + (along_z[2] + along_z[3])) +
                        ((along_z[4] + along_z[5]) + (along_z[6] + along_z[7]));
    light.lit_rows |= lit;
    light.lit_low |= low;
    light.lit_high |= high;
  }
};

// The cells below and above those at `at`, along x, y and z: in the leaf itself or in the one beside it.
VOLGI_INLINE const float* below_x(const float* own, const float* beside, int at) {
  return at >= 64 ? own + at - 64 : beside + at + 448;
}
VOLGI_INLINE const float* above_x(const float* own, const float* beside, int at) {
  return at < 448 ? own + at + 64 : beside + at - 448;
}
#if VOLGI_LOBES_WIDTH == 8
VOLGI_INLINE Row below_y(const float* own, const float* beside, int at) {
  return load((at & 56) != 0 ? own + at - 8 : beside + at + 56);
}
VOLGI_INLINE Row above_y(const float* own, const float* beside, int at) {
  return load((at & 56) != 56 ? own + at + 8 : beside + at - 56);
}
VOLGI_INLINE Row below_z(Row own, Row beside) { return __builtin_shufflevector(own, beside, 15, 0, 1, 2, 3, 4, 5, 6); }
VOLGI_INLINE Row above_z(Row own, Row beside) { return __builtin_shufflevector(own, beside, 1, 2, 3, 4, 5, 6, 7, 8); }
VOLGI_INLINE std::uint64_t closed_at(const std::uint64_t* closed, int at) { return closed[at >> 3]; }
VOLGI_INLINE Mask open_mask(const std::uint64_t* closed, int at, int face) {
  const auto bits = std::int32_t(closed[at >> 3] >> (8 * face));
  return ((Mask{} + bits) & Mask{1, 2, 4, 8, 16, 32, 64, 128}) == 0;
}
#else
VOLGI_INLINE Row two(const float* low, const float* high) {
  const HalfRow a = *reinterpret_cast<const HalfRow*>(low), b = *reinterpret_cast<const HalfRow*>(high);
  return __builtin_shufflevector(a, b, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
}
VOLGI_INLINE Row below_y(const float* own, const float* beside, int at) {
  return (at & 56) != 0 ? load_unaligned(own + at - 8) : two(beside + at + 56, own + at);
}
VOLGI_INLINE Row above_y(const float* own, const float* beside, int at) {
  return (at & 56) != 48 ? load_unaligned(own + at + 8) : two(own + at + 8, beside + at - 48);
}
VOLGI_INLINE Row below_z(Row own, Row beside) {
  return __builtin_shufflevector(own, beside, 23, 0, 1, 2, 3, 4, 5, 6, 31, 8, 9, 10, 11, 12, 13, 14);
}
VOLGI_INLINE Row above_z(Row own, Row beside) {
  return __builtin_shufflevector(own, beside, 1, 2, 3, 4, 5, 6, 7, 16, 9, 10, 11, 12, 13, 14, 15, 24);
}
VOLGI_INLINE std::uint64_t closed_at(const std::uint64_t* closed, int at) {
  return closed[at >> 3] | closed[(at >> 3) + 1];
}
VOLGI_INLINE Mask open_mask(const std::uint64_t* closed, int at, int face) {
  const auto low = std::uint32_t(closed[at >> 3] >> (8 * face)) & 255u;
  const auto high = std::uint32_t(closed[(at >> 3) + 1] >> (8 * face)) & 255u;
  return ((Mask{} + std::int32_t(low | (high << 8))) &
          Mask{1, 2, 4, 8, 16, 32, 64, 128, 256, 512, 1024, 2048, 4096, 8192, 16384, 32768}) == 0;
}
#endif

constexpr int kStride = kLobeBands * kLobeLeafCells;  // from a coefficient to the next

/// Leaves with the band's offset added.
struct Around {
  const float* own;
  const float* beside[6];
};

template <class Order, class Open>
VOLGI_INLINE void gather_row(const Around& a, int at, const Open& open, Row* out) {
  constexpr int n = Order::kCoefficients;
  Row below[n], above[n];
  for (int k = 0; k < n; ++k) out[k] = Row{};
  for (int k = 0; k < n; ++k) {
    below[k] = load(below_x(a.own, a.beside[0], at) + k * kStride);
    above[k] = load(above_x(a.own, a.beside[1], at) + k * kStride);
  }
  Order::template add_both<0>(below, open(0), above, open(1), out);
  for (int k = 0; k < n; ++k) {
    below[k] = below_y(a.own + k * kStride, a.beside[2] + k * kStride, at);
    above[k] = above_y(a.own + k * kStride, a.beside[3] + k * kStride, at);
  }
  Order::template add_both<1>(below, open(2), above, open(3), out);
  for (int k = 0; k < n; ++k) {
    const Row own = load(a.own + at + k * kStride);
    below[k] = below_z(own, load(a.beside[4] + at + k * kStride));
    above[k] = above_z(own, load(a.beside[5] + at + k * kStride));
  }
  Order::template add_both<2>(below, open(4), above, open(5), out);
}

VOLGI_INLINE Around of_band(const float* own, const float* const* beside, int band) {
  Around a{own + lobe_block(0, band), {}};
  for (int f = 0; f < 6; ++f) a.beside[f] = beside[f] + lobe_block(0, band);
  return a;
}

constexpr auto kAllOpen = [](int) { return Mask{} == 0; };

template <class Order>
VOLGI_INLINE void prefetch(const float* cells) {
  for (int k = 0; k < Order::kCoefficients; ++k) __builtin_prefetch(cells + k * kStride, 0, 2);
}

template <class Order>
void gather(const float* own, const float* const beside[6], const std::uint64_t* closed, const float* ahead,
            std::uint64_t rows, float* out) {
  for (int band = 0; band < kLobeBands; ++band) {
    const Around around = of_band(own, beside, band);
    for_rows(
        rows, [&](int at) __attribute__((always_inline)) {
          prefetch<Order>(ahead + lobe_block(0, band) + at);
          Row l[Order::kCoefficients];
          if (closed_at(closed, at) == 0) {
            gather_row<Order>(around, at, kAllOpen, l);
          } else {
            gather_row<Order>(
                around, at, [=](int face) { return open_mask(closed, at, face); }, l);
          }
          for (int k = 0; k < Order::kCoefficients; ++k) store(out + lobe_block(k, band) + at, l[k]);
        });
  }
}

#include "propagation/lobes/sh_lobes_half_steps.inl"

template <class Order, bool kStream>
void rescale_to(const float* gathered, std::uint64_t rows, float* out, LeafLight& light) {
  light = {};
  for (int band = 0; band < kLobeBands; ++band) {
    Tally tally;
    for_rows(
        rows, [&](int at) __attribute__((always_inline)) {
          Row l[Order::kCoefficients];
          for (int k = 0; k < Order::kCoefficients; ++k) l[k] = load(gathered + lobe_block(k, band) + at);
          tally.add(at, l[0]);
          rescale_row<Order>(l);
          for (int k = 0; k < Order::kCoefficients; ++k) store_leaf<kStream>(out + lobe_block(k, band) + at, l[k]);
        });
    tally.finish(band, light);
  }
}

template <class Order>
void rescale(const float* gathered, std::uint64_t rows, float* out, bool stream, LeafLight& light) {
  stream ? rescale_to<Order, true>(gathered, rows, out, light) : rescale_to<Order, false>(gathered, rows, out, light);
}

template <class Order>
void carried(const float* lobes, float* out) {
  for (int band = 0; band < kLobeBands; ++band) {
    for (int at = 0; at < kLobeLeafCells; at += kWidth) {
      Row l[Order::kCoefficients];
      for (int k = 0; k < Order::kCoefficients; ++k) l[k] = load(lobes + lobe_block(k, band) + at);
      const Mask lit = l[0] > 0.0f;
      const Row factor = select(lit, passed_sum<Order>(l) / (lit ? l[0] : Row{} + 1.0f));
      for (int k = 0; k < Order::kCoefficients; ++k) store(out + lobe_block(k, band) + at, l[k] * factor);
    }
  }
}

template <class Order, bool kStream>
void gather_rescale_to(const float* own, const float* const beside[6], const float* ahead, std::uint64_t rows,
                       float* out, LeafLight& light) {
  light = {};
  for (int band = 0; band < kLobeBands; ++band) {
    const Around around = of_band(own, beside, band);
    Tally tally;
    for_rows(
        rows, [&](int at) __attribute__((always_inline)) {
          prefetch<Order>(ahead + lobe_block(0, band) + at);
          Row l[Order::kCoefficients];
          gather_row<Order>(around, at, kAllOpen, l);
          tally.add(at, l[0]);
          rescale_row<Order>(l);
          for (int k = 0; k < Order::kCoefficients; ++k) store_leaf<kStream>(out + lobe_block(k, band) + at, l[k]);
        });
    tally.finish(band, light);
  }
}

template <class Order>
void gather_rescale(const float* own, const float* const beside[6], const float* ahead, std::uint64_t rows, float* out,
                    bool stream, LeafLight& light) {
  stream ? gather_rescale_to<Order, true>(own, beside, ahead, rows, out, light)
         : gather_rescale_to<Order, false>(own, beside, ahead, rows, out, light);
}

template <class Order, class T>
VOLGI_INLINE T passed_through(const T* l, int face) {
  switch (face) {
    case 0:
      return passed<Order, 0, -1>(l);
    case 1:
      return passed<Order, 0, 1>(l);
    case 2:
      return passed<Order, 1, -1>(l);
    case 3:
      return passed<Order, 1, 1>(l);
    case 4:
      return passed<Order, 2, -1>(l);
    default:
      return passed<Order, 2, 1>(l);
  }
}

/// Of cells from `cells` on, as many as a T holds.
template <class Order, class T>
VOLGI_INLINE T power_of(const float* cells, int face) {
  T l[Order::kCoefficients];
  for (int k = 0; k < Order::kCoefficients; ++k) l[k] = *reinterpret_cast<const T*>(cells + k * kStride);
  return passed_through<Order>(l, face);
}

template <class Order>
void face_powers(const float* own, int face, int cell, int count, float powers[kLobeBands][8]) {
  for (int band = 0; band < kLobeBands; ++band) {
    const float* cells = own + lobe_block(0, band) + cell;
    if (count == 1) {
      powers[band][0] = power_of<Order, float>(cells, face);
    } else {
      *reinterpret_cast<UnalignedHalfRow*>(powers[band]) = power_of<Order, HalfRow>(cells, face);
    }
  }
}

VOLGI_INLINE void add_scaled(float shape, const float powers[8], int count, float* cells) {
  for (int z = 0; z < count; ++z) cells[z] += shape * powers[z];
}

template <class Order>
void add_lobes(const float* lobe, int cell, int count, const float powers[kLobeBands][8], float* out) {
  for (int k = 0; k < Order::kCoefficients; ++k) {
    if (lobe[k] == 0.0f) continue;
    for (int band = 0; band < kLobeBands; ++band) {
      float* cells = out + lobe_block(k, band) + cell;
      count == 1 ? add_scaled(lobe[k], powers[band], 1, cells) : add_scaled(lobe[k], powers[band], 8, cells);
    }
  }
}

template <class Order>
void add_crossing(const float* from, int face, float share, float* to) {
  constexpr int n = Order::kCoefficients;
  float l[n], sum[n] = {};
  for (int k = 0; k < n; ++k) l[k] = from[k * kStride];
  const bool below = (face & 1) == 0, above = !below;
  switch (face >> 1) {
    case 0:
      Order::template add_both<0>(l, below, l, above, sum);
      break;
    case 1:
      Order::template add_both<1>(l, below, l, above, sum);
      break;
    default:
      Order::template add_both<2>(l, below, l, above, sum);
      break;
  }
  for (int k = 0; k < n; ++k) to[k * kStride] += share * sum[k];
}

}  // namespace

const LobeKernels kOrder1 = {gather<Order1>,  gather_half<Order1>, rescale<Order1>,   gather_rescale<Order1>,
                             carried<Order1>, face_powers<Order1>, add_lobes<Order1>, add_crossing<Order1>};
const LobeKernels kOrder2 = {gather<Order2>,  gather_half<Order2>, rescale<Order2>,   gather_rescale<Order2>,
                             carried<Order2>, face_powers<Order2>, add_lobes<Order2>, add_crossing<Order2>};

}  // namespace volgi::VOLGI_LOBES
