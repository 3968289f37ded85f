#pragma once
// Exact scan conversion of a triangle at the fine columns of one block.
#include <algorithm>
#include <array>
#include <bit>

#include "voxel/slice_internal.h"

namespace volgi::slicing {

constexpr int kBlockColumns = kFine * kLeafCells;

/// Cell and sub-cell of the fine columns of a block.
struct FineTable {
  std::uint8_t cell[kBlockColumns], sub[kBlockColumns];
  constexpr FineTable() : cell{}, sub{} {
    for (int i = 0; i < kBlockColumns; ++i) {
      cell[i] = std::uint8_t(i / kFine);
      sub[i] = std::uint8_t(i % kFine);
    }
  }
};
constexpr FineTable kFineTable;

/// Fine columns first ... last of both axes, and the nodes k that may be a fragment's first node above the surface.
struct Window {
  int first_b, last_b, first_c, last_c;
  int first_k, last_k;
  bool covers_all_nodes = false;  // no fragment of the triangle is outside them
};

/// All fragments of a block's faces in the pass along `axis`.
inline Window block_window(const SlicedScene& s, glm::ivec3 first_cell, int axis) {
  const int b = shared::axis_b(axis), c = shared::axis_c(axis);
  const auto last_cell = [&](int a) { return std::min(first_cell[a] + kLeafCells, s.grid.cells[a]) - 1; };
  const int last_face = std::min(first_cell[axis] + kLeafCells - 1, s.grid.cells[axis]);
  // Segment q of a column lies below node q - 1; face i has the segments 3i ... 3i + 2.
  return {kFine * first_cell[b],        kFine * last_cell(b) + kFine - 1,
          kFine * first_cell[c],        kFine * last_cell(c) + kFine - 1,
          kFine * first_cell[axis] - 1, kFine * last_face + 1};
}

/// What of a window the triangle's bounds hold; false when that is nothing.
inline bool cut(Window& w, const FineBox& box, int axis) {
  const int b = shared::axis_b(axis), c = shared::axis_c(axis);
  w.first_b = std::max(w.first_b, box.first[b]);
  w.last_b = std::min(w.last_b, box.last[b]);
  w.first_c = std::max(w.first_c, box.first[c]);
  w.last_c = std::min(w.last_c, box.last[c]);
  // The first node above a point may be that after the last in the bounds.
  w.covers_all_nodes = w.first_k <= box.first[axis] && box.last[axis] + 1 <= w.last_k;
  return w.first_b <= w.last_b && w.first_c <= w.last_c && box.first[axis] <= w.last_k &&
         box.last[axis] + 1 >= w.first_k;
}

/// value + i step_b + j step_c >= 0 at the column (i, j) of the window.
struct HalfPlane {
  std::int64_t value, step_b, step_c;

  std::int64_t least(std::int64_t columns_b, std::int64_t columns_c) const {
    return value + std::min<std::int64_t>(step_b * (columns_b - 1), 0) +
           std::min<std::int64_t>(step_c * (columns_c - 1), 0);
  }
  std::int64_t largest(std::int64_t columns_b, std::int64_t columns_c) const {
    return value + std::max<std::int64_t>(step_b * (columns_b - 1), 0) +
           std::max<std::int64_t>(step_c * (columns_c - 1), 0);
  }
};

/// A triangle in the pass along one axis. Node k of a column lies below the surface when numerator > k * divisor. Nodes
/// count as moved by (e, e^2, e^3), e next to nothing (simulation of simplicity, Edelsbrunner and Muecke 1990): a sign
/// of zero becomes that of the first move that matters, here by taking 1 from integers that must not be zero.
template <int axis_>
class TriangleSlice {
 public:
  TriangleSlice(const SliceTriangle& t, const Long3& n) : t_(t) {
    sign_ = n[axis_] < 0 ? -1 : 1;
    n_axis_ = sign_ * n[axis_];
    n_b_ = sign_ * n[b_];
    n_c_ = sign_ * n[c_];
    const std::int64_t leading = sign_ * (n[0] != 0 ? n[0] : n[1] != 0 ? n[1] : n[2]);
    tie_ = leading > 0 ? 0 : 1;
  }

  /// Depth along the axis, cell units.
  double depth(std::int64_t numerator) const {
    return double(numerator + n_axis_ * kHalfNodeStep - tie_) / (double(n_axis_) * SLICE_STEPS);
  }

  /// Whether the triangle's plane lies across the axis: all fragments have the same k and numerator.
  bool flat() const { return n_axis_ != 0 && n_b_ == 0 && n_c_ == 0; }

  /// Calls visit(fine_b, fine_c, k, numerator) for every fragment in the window, which lies within the triangle's
  /// bounds; k is the first node above the surface.
  template <class Visit>
  void fragments(const Window& w, Visit&& visit) const {
    if (n_axis_ == 0) return;
    const HalfPlane start = numerator_at(w);
    const std::int64_t divisor = kNodeStep * n_axis_;
    const double per_divisor = 1.0 / double(divisor);
    const Quotient step = divide(start.step_b, divisor, per_divisor);
    rows(w, start, [&](int j, int first, int last) {
      std::int64_t numerator = start.value + j * start.step_c + first * start.step_b;
      Quotient q = divide(numerator + divisor - 1, divisor, per_divisor);
      for (int i = first;; ++i) {
        visit(w.first_b + i, w.first_c + j, int(q.whole), numerator);
        if (i == last) break;
        numerator += start.step_b;
        q.whole += step.whole;
        q.rest += step.rest;
        if (q.rest >= divisor) {
          q.rest -= divisor;
          ++q.whole;
        }
      }
    });
  }

  /// Where fragments of a flat triangle lie: calls visit(first_b, last_b, fine_c) for the rows of columns that have
  /// any, and before the first of them begin(k, numerator).
  template <class Begin, class Visit>
  void flat_rows(const Window& w, Begin&& begin, Visit&& visit) const {
    const HalfPlane start = numerator_at(w);
    const std::int64_t divisor = kNodeStep * n_axis_;
    bool begun = false;
    rows(w, start, [&](int j, int first, int last) {
      if (!begun) begin(int(divide(start.value + divisor - 1, divisor, 1.0 / double(divisor)).whole), start.value);
      begun = true;
      visit(w.first_b + first, w.first_b + last, w.first_c + j);
    });
  }

 private:
  struct Quotient {
    std::int64_t whole, rest;
  };

  /// Calls visit(j, first, last) for the rows of the window that have fragments: in their columns first ... last.
  /// @param start  numerator_at(w)
  template <class Visit>
  void rows(const Window& w, const HalfPlane& start, Visit&& visit) const {
    const int columns_b = w.last_b - w.first_b + 1, columns_c = w.last_c - w.first_c + 1;
    const std::int64_t divisor = kNodeStep * n_axis_;
    std::array<HalfPlane, 5> planes;
    size_t count = 0;
    const auto add = [&](const HalfPlane& h) {  // false: nothing of the window is on its inner side
      if (h.largest(columns_b, columns_c) < 0) return false;
      if (h.least(columns_b, columns_c) < 0) planes[count++] = h;
      return true;
    };
    if (!w.covers_all_nodes) {
      if (!add({start.value - divisor * (w.first_k - 1) - 1, start.step_b, start.step_c})) return;
      if (!add({divisor * w.last_k - start.value, -start.step_b, -start.step_c})) return;
    }
    for (size_t edge = 0; edge < 3; ++edge) {
      if (!add(edge_plane(edge, w))) return;
    }
    for (int j = 0; j < columns_c; ++j) {
      int first = 0, last = columns_b - 1;
      for (size_t p = 0; p < count; ++p) narrow(planes[p], first, last);
      if (first <= last) visit(j, first, last);
      for (size_t p = 0; p < count; ++p) planes[p].value += planes[p].step_c;
    }
  }

  /// Floor and remainder. The estimate is at most one off while the quotient is under 2^52.
  static Quotient divide(std::int64_t x, std::int64_t divisor, double per_divisor) {
    Quotient q{std::int64_t(double(x) * per_divisor), 0};
    q.rest = x - q.whole * divisor;
    while (q.rest < 0) q = {q.whole - 1, q.rest + divisor};
    while (q.rest >= divisor) q = {q.whole + 1, q.rest - divisor};
    return q;
  }

  /// The numerator at the window's first column: depth, less half a node step, times the divisor; and what a column
  /// adds.
  HalfPlane numerator_at(const Window& w) const {
    const glm::ivec3 v = t_.vertex[0];
    return {n_axis_ * (v[axis_] - kHalfNodeStep) - n_b_ * (node_position(w.first_b) - v[b_]) -
                n_c_ * (node_position(w.first_c) - v[c_]) + tie_,
            -kNodeStep * n_b_, -kNodeStep * n_c_};
  }

  HalfPlane edge_plane(size_t edge, const Window& w) const {
    const glm::ivec3 p = t_.vertex[(edge + 1) % 3], q = t_.vertex[(edge + 2) % 3];
    const std::int64_t edge_b = sign_ * (q[b_] - p[b_]), edge_c = sign_ * (q[c_] - p[c_]);
    // What moves along b and c add; the lower axis moves more.
    const std::int64_t more = b_ < c_ ? -edge_c : edge_b, less = b_ < c_ ? edge_b : -edge_c;
    const bool zero_is_inside = more != 0 ? more > 0 : less > 0;
    const std::int64_t area = edge_b * (node_position(w.first_c) - p[c_]) - edge_c * (node_position(w.first_b) - p[b_]);
    return {area - (zero_is_inside ? 0 : 1), -kNodeStep * edge_c, kNodeStep * edge_b};
  }

  /// Cuts first ... last to the columns of a row that are on the inner side.
  static void narrow(const HalfPlane& h, int& first, int& last) {
    if (first > last) return;
    const std::int64_t left = h.value + first * h.step_b;
    const std::int64_t right = h.value + last * h.step_b;
    if (left >= 0) {
      if (right < 0) last = first + int(left / -h.step_b);
    } else if (right < 0) {
      last = first - 1;
    } else {
      first += int((-left + h.step_b - 1) / h.step_b);
    }
  }

  static constexpr int b_ = axis_ == 2 ? 0 : axis_ + 1;
  static constexpr int c_ = axis_ == 0 ? 2 : axis_ - 1;

  const SliceTriangle& t_;
  std::int64_t sign_, n_axis_, n_b_, n_c_, tie_;
};

/// The fragments of a flat triangle, a cell's at once. Calls begin(segment of the block, depth), then visit(cell_b,
/// cell_c, bits of its sub-columns) for the cells of the block from `first_cell` on.
template <int axis, class Begin, class Visit>
void flat_cells(const TriangleSlice<axis>& triangle, const Window& window, glm::ivec3 first_cell, Begin&& begin,
                Visit&& visit) {
  constexpr int b = axis == 2 ? 0 : axis + 1, c = axis == 0 ? 2 : axis - 1;
  const int fine_b = kFine * first_cell[b], fine_c = kFine * first_cell[c];
  std::uint32_t columns[kBlockColumns] = {};  // by row: bits of those with fragments
  std::uint32_t rows = 0;
  const auto begin_flat = [&](int k, std::int64_t numerator) {
    begin(size_t(k + 1 - kFine * first_cell[axis]), float(triangle.depth(numerator)));
  };
  triangle.flat_rows(window, begin_flat, [&](int first, int last, int column_c) {
    columns[column_c - fine_c] = (2u << (last - fine_b)) - (1u << (first - fine_b));
    rows |= 1u << (column_c - fine_c);
  });
  for (int cell_c = 0; rows >> (kFine * cell_c) != 0; ++cell_c) {
    const std::uint32_t* of_cell = columns + kFine * cell_c;
    static_assert(kFine == 3);
    for (std::uint32_t rest = of_cell[0] | of_cell[1] | of_cell[2]; rest != 0;) {
      const int cell_b = kFineTable.cell[std::countr_zero(rest)], shift = kFine * cell_b;
      visit(cell_b, cell_c,
            (of_cell[0] >> shift & 7u) | (of_cell[1] >> shift & 7u) << 3 | (of_cell[2] >> shift & 7u) << 6);
      rest &= ~(7u << shift);
    }
  }
}

}  // namespace volgi::slicing
