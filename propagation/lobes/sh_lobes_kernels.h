#pragma once
// Vector kernels of `conservative` on one leaf of 8^3 cells. Compiled once for each instruction set; this header and
// the constants are all they include, so that no inline function is compiled for a machine that it will not run on.
#include <cstdint>

namespace volgi {

constexpr int kLobeBands = 3;        // red, green, blue
constexpr int kLobeLeafCells = 512;  // 8^3, z fastest
constexpr int kLobeRows = 64;        // rows of 8 cells along z

/// Offset of a band's block of 512 floats in a leaf: [coefficient][band][512].
constexpr int lobe_block(int coefficient, int band) { return (coefficient * kLobeBands + band) * kLobeLeafCells; }

constexpr std::uint64_t kAllRows = ~std::uint64_t(0);

/// What a pass leaves in a leaf. Rows are of 8 cells along z: bit 8x + y.
struct LeafLight {
  float power[kLobeBands];          // of all its lobes [W]
  std::uint64_t lit_rows;           // rows with a cell that is not dark
  std::uint64_t lit_low, lit_high;  // rows whose cell of the lowest, highest z is not dark
};

/// A pass over one leaf gathers, then rescales, both only `rows`: the others of what is written stay as they are. `own`
/// and `beside[f]` are leaves of the state before the pass (beside[f] that across face f; a leaf of zeros where there
/// is none), 64-byte aligned. `ahead` is a leaf that will be read soon: it is fetched into the cache meanwhile.
/// `stream`: what is written is not read again before it has left the cache.
struct LobeKernels {
  /// What comes in through the open faces. @param closed  per row of 8 cells along z, byte f: a bit for each cell whose
  /// face f lets nothing through here.
  void (*gather)(const float* own, const float* const beside[6], const std::uint64_t* closed, const float* ahead,
                 std::uint64_t rows, float* out);
  /// What a step of half a cell leaves: what comes in through open faces and what stays, `closed` as above. Through
  /// closed faces half of what they show leaves, too. All rows.
  void (*gather_half)(const float* own, const float* const beside[6], const std::uint64_t* closed, float* out);
  /// Scales the lobes so that what passes through their faces sums to their power.
  void (*rescale)(const float* gathered, std::uint64_t rows, float* out, bool stream, LeafLight& light);
  /// Both, where nothing is closed.
  void (*gather_rescale)(const float* own, const float* const beside[6], const float* ahead, std::uint64_t rows,
                         float* out, bool stream, LeafLight& light);
  /// Lobes as they were before they were rescaled: their first number is the power that they carry.
  void (*carried)(const float* lobes, float* out);
  /// Power that passes through face `face` of cells of a row [W]: `count` (1 or 8) cells from offset `cell` on.
  void (*face_powers)(const float* own, int face, int cell, int count, float powers[kLobeBands][8]);
  /// Adds lobes of one shape to these cells. @param lobe  4 or 9 coefficients of power 1.
  void (*add_lobes)(const float* lobe, int cell, int count, const float powers[kLobeBands][8], float* out);
  /// One cell and band: adds `share` of what comes through its face `face` from the cell there. Pointers are to the
  /// cells' first coefficient; the others follow every kLobeBands * kLobeLeafCells floats.
  void (*add_crossing)(const float* from, int face, float share, float* to);
};

/// The best that this machine runs. @param order  1 (4 coefficients) or 2 (9).
const LobeKernels& lobe_kernels(int order);
/// By name, for tests and benchmarks: "baseline", "avx2", "avx512"; null where the machine cannot run it.
const LobeKernels* lobe_kernels(int order, const char* instruction_set);

namespace lobes_baseline {
extern const LobeKernels kOrder1, kOrder2;
}
namespace lobes_avx2 {
extern const LobeKernels kOrder1, kOrder2;
}
namespace lobes_avx512 {
extern const LobeKernels kOrder1, kOrder2;
}

}  // namespace volgi
