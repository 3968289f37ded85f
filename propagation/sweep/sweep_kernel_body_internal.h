// Body of the sweep kernels, included once by each sweep_kernel*.cpp after VOLGI_SWEEP_WIDE says whether registers hold
// 16 floats. No include guard, no inline functions with external names: what is compiled for one instruction set must
// not end up in code for another. Vectors are those of GCC and Clang (vector_size), so that all variants are one text.
#define VOLGI_INLINE inline __attribute__((always_inline))
#include "propagation/sweep/sweep_lanes_internal.h"

namespace volgi::sweep {
namespace {

// Techniques, "ordinates": a cell's power leaves through its downwind faces as |d_x| : |d_y| : |d_z|. What is carried
// on each axis is the power in the cell before.
template <int kLanes>
struct Step {
  using V = Vec<kLanes>;
  static constexpr bool kCarriesCells = true;
  V share[3];

  VOLGI_INLINE Step(const Constants& c, int octet) {
    for (int a = 0; a < 3; ++a) share[a] = load<kLanes>(c.share[0][a] + octet * kOctet);
  }
  VOLGI_INLINE V in(int axis, V carried) const { return share[axis] * carried; }
  VOLGI_INLINE void advance(V& x, V& y, V& z) const {
    const V others = share[1] * y + share[2] * z;
    x = y = z = share[0] * x + others;  // x was known last: a row waits for one multiplication a cell
  }
  // Power in by the three faces; what is carried on, and what leaves.
  VOLGI_INLINE void pass_on(const V* in, V* carried, V* leaves) const {
    const V power = in[0] + in[1] + in[2];
    for (int a = 0; a < 3; ++a) {
      carried[a] = power;
      leaves[a] = share[a] * power;
    }
  }
};

// What comes in through a face leaves by the exact overlap of that face, moved along the direction, with the others.
// What is carried is the power through the face.
template <int kLanes>
struct Characteristic {
  using V = Vec<kLanes>;
  static constexpr bool kCarriesCells = false;
  V share[3][3];  // [in][out]

  VOLGI_INLINE Characteristic(const Constants& c, int octet) {
    for (int in = 0; in < 3; ++in) {
      for (int out = 0; out < 3; ++out) share[in][out] = load<kLanes>(c.share[in][out] + octet * kOctet);
    }
  }
  VOLGI_INLINE V in(int, V carried) const { return carried; }
  VOLGI_INLINE V leaving(int axis, V x, V y, V z) const {
    const V others = share[1][axis] * y + share[2][axis] * z;
    return share[0][axis] * x + others;
  }
  VOLGI_INLINE void advance(V& x, V& y, V& z) const {
    const V from[3] = {x, y, z};
    x = leaving(0, from[0], from[1], from[2]);
    y = leaving(1, from[0], from[1], from[2]);
    z = leaving(2, from[0], from[1], from[2]);
  }
  VOLGI_INLINE void pass_on(const V* in, V* carried, V* leaves) const {
    for (int a = 0; a < 3; ++a) carried[a] = leaves[a] = leaving(a, in[0], in[1], in[2]);
  }
};

// A whole block without sides: the row along x waits in registers.
template <template <int> class Rule, int kOctets, int kLanes>
VOLGI_INLINE void open_block(const Constants& c, const Block& b, int octet) {
  constexpr int n = kBlockCells;
  const Rule<kLanes> rule(c, octet);
  const int row_size = n * kOctets * kOctet;
  const int first = octet * kOctet * n;
  float* x_row = b.x + first;
  float* y_row = b.y + first;
  for (int k = 0; k < n; ++k, x_row += row_size, y_row += row_size) {
    Vec<kLanes> y[n];
    for (int i = 0; i < n; ++i) y[i] = load<kLanes>(y_row + i * kLanes);
    float* z_row = b.z + first;
    for (int j = 0; j < n; ++j, z_row += row_size) {
      Vec<kLanes> x = load<kLanes>(x_row + j * kLanes);
#pragma GCC unroll 8
      for (int i = 0; i < n; ++i) {
        Vec<kLanes> z = load<kLanes>(z_row + i * kLanes);
        rule.advance(x, y[i], z);
        store<kLanes>(z_row + i * kLanes, z);
      }
      store<kLanes>(x_row + j * kLanes, x);
    }
    for (int i = 0; i < n; ++i) store<kLanes>(y_row + i * kLanes, y[i]);
  }
}

// Carried values of one row of cells: eight of an octet (or of two, where registers are wide) lie together.
struct Rows {
  float* x;  // of all rows of one k: by j
  float* y;  // by i
  float* z;  // by i
};

template <int kLanes>
VOLGI_INLINE int place_in_row(int octet, int i) {
  return octet * kOctet * kBlockCells + i * kLanes;
}

// Cells `first` ... `last` - 1 of a row, none of them with sides.
template <template <int> class Rule, int kLanes>
VOLGI_INLINE void open_cells(const Constants& c, Rows rows, int octet, int j, int first, int last) {
  const Rule<kLanes> rule(c, octet);
  float* at_x = rows.x + place_in_row<kLanes>(octet, j);
  Vec<kLanes> x = load<kLanes>(at_x);
  for (int i = first; i < last; ++i) {
    const int place = place_in_row<kLanes>(octet, i);
    Vec<kLanes> y = load<kLanes>(rows.y + place), z = load<kLanes>(rows.z + place);
    rule.advance(x, y, z);
    if constexpr (!Rule<kLanes>::kCarriesCells) store<kLanes>(rows.y + place, y);
    store<kLanes>(rows.z + place, z);
  }
  store<kLanes>(at_x, x);
}

// Faces as one octant meets them.
struct Octant {
  std::uint32_t upwind[3], downwind[3];  // bits of a cell
  float* arrived[3];                     // of the block's first side, in the octant's quad of four
};

VOLGI_INLINE Octant octant_of(const Block& b) {
  Octant o;
  for (int a = 0; a < 3; ++a) {
    const int positive = (b.octant >> a) & 1;
    o.downwind[a] = 1u << (2 * a + positive);
    o.upwind[a] = 1u << (2 * a + 1 - positive);
    // Four octants reach a side: their bits on the two other axes tell them apart.
    const int quad = a == 0 ? b.octant >> 1 : a == 1 ? (b.octant & 1) | ((b.octant >> 1) & 2) : b.octant & 3;
    o.arrived[a] = b.arrived + kQuad * quad;
  }
  return o;
}

// The sides of a cell; null where there is none.
struct Sides {
  const float* upwind[3];  // sent r, g, b, and the share that passes
  float* downwind[3];      // where arrivals go
};

VOLGI_INLINE Sides sides_of(const Block& b, const Octant& octant, std::uint32_t cell) {
  const auto number = [cell](std::uint32_t bit) {
    return (cell >> 6) + std::uint32_t(__builtin_popcount(cell & (bit - 1)));
  };
  Sides s;
  for (int a = 0; a < 3; ++a) {
    const std::uint32_t up = octant.upwind[a], down = octant.downwind[a];
    s.upwind[a] = (cell & up) != 0 ? b.sent + kQuad * number(up) : nullptr;
    s.downwind[a] = (cell & down) != 0 ? octant.arrived[a] + 4 * kQuad * number(down) : nullptr;
  }
  return s;
}

template <template <int> class Rule, int kOctets, int kLanes, bool kRadiance>
VOLGI_INLINE void visit_lanes(const Constants& c, const Sides& s, Rows rows, int octet, int i, int j, Quad* hit,
                              Quad* radiance) {
  const Rule<kLanes> rule(c, octet);
  const int lane = octet * kOctet;
  float* at[3] = {rows.x + place_in_row<kLanes>(octet, j), rows.y + place_in_row<kLanes>(octet, i),
                  rows.z + place_in_row<kLanes>(octet, i)};
  Vec<kLanes> in[3], carried[3], leaves[3];
  for (int a = 0; a < 3; ++a) {
    in[a] = rule.in(a, load<kLanes>(at[a]));
    if (s.upwind[a] == nullptr) continue;
    in[a] = in[a] * s.upwind[a][3] + load<kLanes>(c.emitted[a] + lane) * spread<kOctets, kLanes>(c, octet, s.upwind[a]);
  }
  rule.pass_on(in, carried, leaves);
  store<kLanes>(at[0], carried[0]);
  if constexpr (!Rule<kLanes>::kCarriesCells) store<kLanes>(at[1], carried[1]);
  store<kLanes>(at[2], carried[2]);
  for (int a = 0; a < 3; ++a) {
    if (s.downwind[a] != nullptr) hit[a] += gather<kOctets, kLanes>(c, octet, leaves[a]);
  }
  if constexpr (kRadiance) {
    const Vec<kLanes> mean = load<kLanes>(c.track[0] + lane) * in[0] + load<kLanes>(c.track[1] + lane) * in[1] +
                             load<kLanes>(c.track[2] + lane) * in[2];
    for (int m = 0; m < 4; ++m) radiance[m] += gather<kOctets, kLanes>(c, octet, load<kLanes>(c.sh[m] + lane) * mean);
  }
}

// A cell with sides, or one whose radiance is asked for.
template <template <int> class Rule, int kOctets, bool kRadiance>
VOLGI_INLINE void visit_cell(const Constants& c, const Block& b, const Octant& bits, std::uint32_t cell, Rows rows,
                             int i, int j, int place) {
  const Sides s = sides_of(b, bits, cell);
  Quad hit[3] = {}, radiance[4] = {};
  for_octets<kOctets>([&]<int kLanes>(Width<kLanes>, int octet) {
    visit_lanes<Rule, kOctets, kLanes, kRadiance>(c, s, rows, octet, i, j, hit, radiance);
  });
  for (int a = 0; a < 3; ++a) {
    if (s.downwind[a] != nullptr) store<kQuad>(s.downwind[a], hit[a]);
  }
  if constexpr (kRadiance) {
    constexpr int kAxisOfCoefficient[4] = {-1, 1, 2, 0};
    for (int m = 0; m < 4; ++m) {
      const int axis = kAxisOfCoefficient[m];
      const float sign = axis >= 0 && ((b.octant >> axis) & 1) == 0 ? -1.0f : 1.0f;
      for (int band = 0; band < 3; ++band) b.radiance[m][3 * place + band] += sign * radiance[m][band];
    }
  }
}

template <template <int> class Rule, int kOctets, bool kRadiance>
VOLGI_INLINE void visit_row(const Constants& c, const Block& b, const Octant& bits, int y, int z, Rows rows, int j) {
  const bool up = (b.octant & 1) != 0;
  const int row = z * kBlockCells + y;
  unsigned with_sides = b.sides != nullptr ? b.sides->rows[up ? 0 : 1][row] : 0u;
  if constexpr (kRadiance) with_sides = (1u << b.extent[0]) - 1u;
  for (int i = 0; i < b.extent[0]; ++i) {
    const int end = with_sides == 0 ? b.extent[0] : __builtin_ctz(with_sides);
    if (end > i)
      for_octets<kOctets>(
          [&]<int kLanes>(Width<kLanes>, int octet) { open_cells<Rule, kLanes>(c, rows, octet, j, i, end); });
    if (with_sides == 0) return;
    i = end;
    with_sides &= with_sides - 1;
    const int x = up ? i : b.extent[0] - 1 - i;
    const std::uint32_t cell = b.sides != nullptr ? b.sides->cells[row * kBlockCells + x] : 0u;
    visit_cell<Rule, kOctets, kRadiance>(c, b, bits, cell, rows, i, j, (x * kBlockCells + y) * kBlockCells + z);
  }
}

template <template <int> class Rule, int kOctets, bool kRadiance>
__attribute__((flatten)) void visit_block(const Constants& c, const Block& block) {
  constexpr bool kCarriesCells = Rule<8>::kCarriesCells;
  const Block b = block;  // a copy that no store can change, so that its members need not be read again
  const Octant bits = octant_of(b);
  const int row_size = kBlockCells * kOctets * kOctet;
  for (int k = 0; k < b.extent[2]; ++k) {
    const int z = (b.octant & 4) != 0 ? k : b.extent[2] - 1 - k;
    float* y_carried = b.y + k * row_size;
    for (int j = 0; j < b.extent[1]; ++j) {
      const int y = (b.octant & 2) != 0 ? j : b.extent[1] - 1 - j;
      Rows rows{b.x + k * row_size, y_carried, b.z + j * row_size};
      if (kCarriesCells && j > 0) rows.y = rows.z - row_size;  // what the row before has just left there
      visit_row<Rule, kOctets, kRadiance>(c, b, bits, y, z, rows, j);
    }
    if (!kCarriesCells) continue;
    const float* last_row = b.z + (b.extent[1] - 1) * row_size;
    for (int l = 0; l < row_size; l += kOctet) store<8>(y_carried + l, load<8>(last_row + l));
  }
}

template <template <int> class Rule, int kOctets>
__attribute__((flatten)) void visit_open_block(const Constants& c, const Block& b) {
  for_octets<kOctets>([&]<int kLanes>(Width<kLanes>, int octet) { open_block<Rule, kOctets, kLanes>(c, b, octet); });
}

template <template <int> class Rule, int kOctets>
void visit(const Constants& c, const Block& b) {
  const bool whole = b.extent[0] == kBlockCells && b.extent[1] == kBlockCells && b.extent[2] == kBlockCells;
  if (b.sides == nullptr && whole) {
    visit_open_block<Rule, kOctets>(c, b);
  } else {
    visit_block<Rule, kOctets, false>(c, b);
  }
}

template <template <int> class Rule, int kOctets>
Kernel kernel_of(bool radiance) {
  return radiance ? visit_block<Rule, kOctets, true> : visit<Rule, kOctets>;
}
template <template <int> class Rule>
Kernel kernel_of(int octets, bool radiance) {
  switch (octets) {
    case 1:
      return kernel_of<Rule, 1>(radiance);
    case 2:
      return kernel_of<Rule, 2>(radiance);
    case 3:
      return kernel_of<Rule, 3>(radiance);
    case 4:
      return kernel_of<Rule, 4>(radiance);
    case 6:
      return kernel_of<Rule, 6>(radiance);
    default:
      return nullptr;
  }
}
template <int kOctets>
void fill(const float* lanes, float* face) {
  for (int row = 0; row < kBlockCells; ++row, face += kBlockCells * kOctets * kOctet) {
    for_octets<kOctets>([&]<int kLanes>(Width<kLanes>, int octet) {
      const Vec<kLanes> values = load<kLanes>(lanes + octet * kOctet);
      for (int i = 0; i < kBlockCells; ++i) store<kLanes>(face + place_in_row<kLanes>(octet, i), values);
    });
  }
}
void fill_face(int octets, const float* lanes, float* face) {
  switch (octets) {
    case 1:
      return fill<1>(lanes, face);
    case 2:
      return fill<2>(lanes, face);
    case 3:
      return fill<3>(lanes, face);
    case 4:
      return fill<4>(lanes, face);
    default:
      return fill<6>(lanes, face);
  }
}

// Calls f(octets' template argument) for a number of octets.
template <class F>
void with_octets(int octets, const F& f) {
  switch (octets) {
    case 1:
      return f.template operator()<1>();
    case 2:
      return f.template operator()<2>();
    case 3:
      return f.template operator()<3>();
    case 4:
      return f.template operator()<4>();
    default:
      return f.template operator()<6>();
  }
}

// Calls f.operator()<kLanes>(place in the coarse face, place in the fine face, number of the fine place).
template <int kOctets, class F>
VOLGI_INLINE void for_fine_places(int ratio, const int (&part)[2], const F& f) {
  constexpr int row_size = kBlockCells * kOctets * kOctet;
  for (int row = 0; row < kBlockCells; ++row) {
    const int coarse_row = (kBlockCells * part[1] + row) / ratio;
    for_octets<kOctets>([&]<int kLanes>(Width<kLanes>, int octet) {
      for (int i = 0; i < kBlockCells; ++i) {
        const int coarse_i = (kBlockCells * part[0] + i) / ratio;
        f.template operator()<kLanes>(coarse_row * row_size + place_in_row<kLanes>(octet, coarse_i),
                                      row * row_size + place_in_row<kLanes>(octet, i), row * kBlockCells + i);
      }
    });
  }
}

void refine_face(int octets, int ratio, const int (&part)[2], const float* coarse, float* fine) {
  const float share = 1.0f / float(ratio * ratio);
  with_octets(octets, [&]<int kOctets>() {
    for_fine_places<kOctets>(ratio, part, [&]<int kLanes>(int from, int to, int) {
      store<kLanes>(fine + to, share * load<kLanes>(coarse + from));
    });
  });
}

void coarsen_face(int octets, int ratio, const int (&part)[2], const float* fine, const float* weights, float* coarse) {
  with_octets(octets, [&]<int kOctets>() {
    for_fine_places<kOctets>(ratio, part, [&]<int kLanes>(int to, int from, int place) {
      const float weight = weights != nullptr ? weights[place] : 1.0f;
      store<kLanes>(coarse + to, load<kLanes>(coarse + to) + weight * load<kLanes>(fine + from));
    });
  });
}

Kernel kernel(bool characteristic, int octets, bool radiance) {
  return characteristic ? kernel_of<Characteristic>(octets, radiance) : kernel_of<Step>(octets, radiance);
}

}  // namespace
}  // namespace volgi::sweep
#undef VOLGI_INLINE
