#include "voxel/expected_sides.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <vector>

#include "shaders/shared/side.shared.h"
#include "voxel/voxel_grid.h"

namespace volgi {

namespace {

constexpr int kFine = 3;  // lines to a cell, on an edge

/// The faces across one axis. A surface that goes on meets some lines to the side of the face that the line between the
/// centres meets: those faces are no sides' (coverage counts paths that come free to the face), but what is too small
/// for such a line has no other.
class FaceMarks {
 public:
  FaceMarks(const Grid& grid, int axis, const BlockBox& blocks)
      : grid_(grid),
        axis_(axis),
        blocks_(blocks),
        first_cell_(kLeafCells * blocks.first),
        last_cell_(glm::min(kLeafCells * blocks.last, grid.cells)),
        first_(glm::max(first_cell_ - 1, 0)),
        size_(glm::max(glm::min(last_cell_ + 1, grid.cells) - first_, 0)) {
    ++size_[axis];
    of_faces_ = {first_ / kLeafCells, (first_ + size_ - 1) / kLeafCells + 1};
    met_.resize(of_faces_.count());
  }

  /// All lines of the family that meet the triangle (cell coordinates).
  void mark(const std::array<glm::dvec3, 3>& t) {
    const int b = shared::axis_b(axis_), c = shared::axis_c(axis_);
    const glm::dvec3 n = glm::cross(t[1] - t[0], t[2] - t[0]);
    if (n[axis_] == 0.0) return;
    const glm::ivec2 first = fine_line(glm::min(glm::min(t[0], t[1]), t[2]), 1);
    const glm::ivec2 last = fine_line(glm::max(glm::max(t[0], t[1]), t[2]), 0);
    for (int j = first.y; j <= last.y; ++j) {
      const double at_c = (j + 0.5) / kFine;
      const Range inside = span(t, b, c, at_c);
      const int from = std::max(first.x, int(std::ceil(inside.low * kFine - 0.5)));
      const int to = std::min(last.x, int(std::floor(inside.high * kFine - 0.5)));
      for (int i = from; i <= to; ++i) {
        const double at_b = (i + 0.5) / kFine;
        const double depth = t[0][axis_] - (n[b] * (at_b - t[0][b]) + n[c] * (at_c - t[0][c])) / n[axis_];
        mark_face(i, j, depth);
      }
    }
  }
  /// @param blocks  of the marked faces' cells: their sides are added.
  void count(ExpectedSides& sum, std::vector<std::uint32_t>& blocks) const {
    for (size_t block = 0; block < met_.size(); ++block) {
      if (met_[block] == nullptr) continue;
      const glm::ivec3 first = kLeafCells * of_faces_.block(block);
      for (int place = 0; place < int(kLeafVolume); ++place) {
        const char met = (*met_[block])[size_t(place)];
        if (met != 0) count(met, first + glm::ivec3(place >> 6, place >> 3 & 7, place & 7), sum, blocks);
      }
    }
  }

 private:
  using Block = std::array<char, kLeafVolume>;  // by leaf_offset

  void count(char met, glm::ivec3 cell, ExpectedSides& sum, std::vector<std::uint32_t>& blocks) const {
    ++sum.faces;
    if (met != CENTRE && beside_a_centre(cell)) return;
    for (int side = 0; side < 2; ++side, cell[axis_] -= 1) {
      if (glm::any(glm::lessThan(cell, first_cell_)) || glm::any(glm::greaterThanEqual(cell, last_cell_))) continue;
      ++sum.sides;
      ++blocks[blocks_.index(cell / kLeafCells)];
    }
  }
  char met_at(glm::ivec3 place) const {
    const auto& block = met_[of_faces_.index(place / kLeafCells)];
    return block == nullptr ? char(0) : (*block)[size_t(leaf_offset(place))];
  }

  struct Range {
    double low = 1e30, high = -1e30;
  };

  /// First line at or after `p` (round_up), or last one at or before it, on the two other axes; inside the grid.
  glm::ivec2 fine_line(glm::dvec3 p, int round_up) const {
    const glm::dvec2 at = glm::dvec2(p[shared::axis_b(axis_)], p[shared::axis_c(axis_)]) * double(kFine) - 0.5;
    const glm::dvec2 least(kFine * first_[shared::axis_b(axis_)], kFine * first_[shared::axis_c(axis_)]);
    const glm::dvec2 most =
        least + glm::dvec2(kFine * size_[shared::axis_b(axis_)], kFine * size_[shared::axis_c(axis_)]);
    return glm::ivec2(glm::clamp(round_up != 0 ? glm::ceil(at) : glm::floor(at), least - 1.0 + double(round_up),
                                 most - 1.0 + double(round_up)));
  }
  /// Part of the row `at_c` that lies in the triangle, on axis b.
  static Range span(const std::array<glm::dvec3, 3>& t, int b, int c, double at_c) {
    Range range;
    for (size_t i = 0; i < 3; ++i) {
      const glm::dvec3 &p = t[i], &q = t[(i + 1) % 3];
      if ((p[c] <= at_c) == (q[c] <= at_c)) continue;
      const double x = p[b] + (q[b] - p[b]) * (at_c - p[c]) / (q[c] - p[c]);
      range.low = std::min(range.low, x);
      range.high = std::max(range.high, x);
    }
    return range;
  }
  /// @param line_b, line_c  of the fine lattice.
  void mark_face(int line_b, int line_c, double depth) {
    const double face = std::floor(depth + 0.5);  // between the centres of cells face - 1 and face
    if (face < 0.0 || face > grid_.cells[axis_]) return;
    glm::ivec3 place;
    place[axis_] = int(face);
    place[shared::axis_b(axis_)] = line_b / kFine;
    place[shared::axis_c(axis_)] = line_c / kFine;
    if (!has(place)) return;
    auto& block = met_[of_faces_.index(place / kLeafCells)];
    if (block == nullptr) block = std::make_unique<Block>();
    char& met = (*block)[size_t(leaf_offset(place))];
    met = std::max(met, line_b % kFine == kFine / 2 && line_c % kFine == kFine / 2 ? CENTRE : ASIDE);
  }
  /// Whether the line between centres meets a surface at this face's place one face on or back, or beside it.
  bool beside_a_centre(glm::ivec3 place) const {
    const int b = shared::axis_b(axis_), c = shared::axis_c(axis_);
    for (int k = 0; k < 27; ++k) {
      glm::ivec3 at = place;
      at[b] += k % 3 - 1;
      at[c] += k / 3 % 3 - 1;
      at[axis_] += k / 9 - 1;
      if (has(at) && met_at(at) == CENTRE) return true;
    }
    return false;
  }

  bool has(glm::ivec3 face) const {
    return glm::all(glm::greaterThanEqual(face, first_)) && glm::all(glm::lessThan(face, first_ + size_));
  }

  const Grid& grid_;
  int axis_;
  BlockBox blocks_;
  glm::ivec3 first_cell_, last_cell_;           // that are asked for
  glm::ivec3 first_, size_;                     // faces that are looked at: one more all around
  BlockBox of_faces_;                           // which belong to their upper cell
  static constexpr char ASIDE = 1, CENTRE = 2;  // by which lines
  std::vector<std::unique_ptr<Block>> met_;
};

}  // namespace

ExpectedSides expected_sides(const Scene& scene, const Grid& grid) {
  return expected_sides(scene, grid, {glm::ivec3(0), leaf_blocks(grid)});
}

ExpectedSides expected_sides(const Scene& scene, const Grid& grid, const BlockBox& part,
                             std::vector<std::uint32_t>* by_block) {
  ExpectedSides sum;
  if (part.empty()) return sum;
  std::vector<std::uint32_t> blocks(part.count(), 0);
  for (int axis = 0; axis < 3; ++axis) {
    FaceMarks marks(grid, axis, part);
    for (const Mesh& mesh : scene.meshes) {
      std::vector<glm::dvec3> cells;
      cells.reserve(mesh.positions.size());
      for (const glm::vec3& p : mesh.positions) cells.emplace_back(shared::cell_from_world(grid, p));
      for (const glm::uvec3& t : mesh.triangles) marks.mark({cells[t.x], cells[t.y], cells[t.z]});
    }
    marks.count(sum, blocks);
  }
  sum.blocks = blocks.size() - size_t(std::count(blocks.begin(), blocks.end(), 0u));
  if (by_block != nullptr) *by_block = std::move(blocks);
  return sum;
}

}  // namespace volgi
