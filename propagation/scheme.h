#pragma once
#include <optional>

namespace volgi {

/// How the volume propagates light (--scheme; docs/theory.md).
enum class Scheme {
  ordinates,      // discrete ordinates: sides, orders exact, linear
  conservative,   // spherical harmonics, power kept: sides, orders exact
  gaitatzes2010,  // as printed: a pulse, cones, axis mirror
  lpv2009,        // as printed: a pulse, no occlusion, first order only
};

/// Step: a cell's power of a direction leaves through its downwind faces as |d_x| : |d_y| : |d_z|. Characteristic
/// (SC1): by the exact overlap of what came in through each upwind face with each downwind face.
enum class Ordinates { step, characteristic };

struct SchemeOptions {
  Scheme scheme = Scheme::ordinates;
  std::optional<int> directions;       // of ordinates: 8, 24, 48, 80, 128, 512; none: what goes with the grid
  std::optional<Ordinates> ordinates;  // none: what goes with the grid
  /// of ordinates, where `directions` says nothing and the grid has 128: 512 carry what sources send, which is
  /// concentrated, by the characteristic rule; what surfaces then pass on is smooth, and 128 do.
  bool many_for_sources = false;
  int sh_order = 1;              // of the three SH schemes: 1 or 2
  bool constant_albedo = false;  // gaitatzes2010: 0.5 after the first bounce, as the paper has it
  /// gaitatzes2010, what the pulse starts from. flux: what sides send, each into the cell that sees it, power kept as
  /// in all schemes. max: as the paper has it (section 4.1, Algorithm 1), a light of a cell's face and of the largest
  /// radiosity of the surfaces in each occupied cell; no power is kept (docs/theory.md#papers).
  enum class Injection { flux, max } injection = Injection::flux;
  /// conservative: the end of every pulse is carried on a grid of twice the cells' edge. None: where the backend has
  /// that, which is the CPU; asked for on the GPU it is refused.
  std::optional<bool> coarse_start;
};

/// Whether the scheme carries power from sides to sides order by order (warm start, --bounces); the papers' two do not.
inline bool carries_sides(Scheme s) { return s == Scheme::ordinates || s == Scheme::conservative; }

}  // namespace volgi
