#include <tbb/parallel_for.h>

#include <cmath>
#include <limits>

#include "voxel/slice_internal.h"

namespace volgi::slicing {

namespace {

constexpr std::uint32_t kAllNodes = 0x1ff;

/// Nodes u + 3v of a cell's mid-plane that can be reached from its centre (node 4) where the steps of `blocked` are
/// closed: bits 0-2 (0,v)-(1,v), 3-5 (1,v)-(2,v), 6-8 (u,0)-(u,1), 9-11 (u,1)-(u,2).
constexpr std::uint16_t flood(std::uint32_t blocked) {
  std::uint32_t reached = 1u << 4;
  for (std::uint32_t before = 0; before != reached;) {
    before = reached;
    for (int k = 0; k < 12; ++k) {
      if (((blocked >> k) & 1u) != 0) continue;
      const int line = k % 3, from = k / 3 % 2;
      const int a = k < 6 ? from + 3 * line : line + 3 * from;
      const int b = k < 6 ? a + 1 : a + 3;
      if (((reached >> a) & 1u) != 0) reached |= 1u << b;
      if (((reached >> b) & 1u) != 0) reached |= 1u << a;
    }
  }
  return std::uint16_t(reached);
}

const std::array<std::uint16_t, 4096>& reached_nodes() {
  static const std::array<std::uint16_t, 4096> table = [] {
    std::array<std::uint16_t, 4096> t{};
    for (std::uint32_t i = 0; i < t.size(); ++i) t[i] = flood(i);
    return t;
  }();
  return table;
}

class Reach {
 public:
  Reach(const SlicedScene& s, const BlockTable& table) : s_(s), table_(table), reached_(reached_nodes()) {}

  std::uint32_t operator()(int axis, glm::ivec3 cell) const {
    if (!shared::cell_inside(s_.grid, cell)) return kAllNodes;
    const int b = shared::axis_b(axis), c = shared::axis_c(axis);
    glm::ivec3 above_b = cell, above_c = cell;
    ++above_b[b];
    ++above_c[c];
    // Steps along b are parts of faces of family b, whose own b is c and whose c is the axis: their sub-columns are
    // (v, 1). Those of family c are (1, u). Part 2 lies on the far side of a lower face, part 0 on the near side of an
    // upper one.
    const std::uint32_t blocked = (blocked_parts(b, cell) >> 21 & 7u) | (blocked_parts(b, above_b) >> 3 & 7u) << 3 |
                                  every_third(blocked_parts(c, cell) >> 19) << 6 |
                                  every_third(blocked_parts(c, above_c) >> 1) << 9;
    return reached_[blocked];
  }

 private:
  static std::uint32_t every_third(std::uint32_t bits) { return (bits & 1u) | (bits >> 2 & 2u) | (bits >> 4 & 4u); }

  std::uint32_t blocked_parts(int axis, glm::ivec3 face_cell) const {
    const glm::ivec3 at = face_cell / kLeafCells;
    const BlockFaces* block = s_.window.contains(at) ? table_[s_.window.index(at)].get() : nullptr;
    if (block == nullptr) return 0;
    const int face = block->face(axis, leaf_offset(face_cell));
    return face < 0 ? 0 : block->faces[size_t(face)].fine_blocked;
  }

  const SlicedScene& s_;
  const BlockTable& table_;
  const std::array<std::uint16_t, 4096>& reached_;
};

/// Share of the reached pairs of nodes between which a surface lies.
float opaque_share(const Reach& reach, std::uint32_t fine_blocked, int axis, glm::ivec3 face_cell) {
  const std::uint32_t blocked = (fine_blocked | fine_blocked >> 9 | fine_blocked >> 18) & kAllNodes;
  if (blocked == 0 || blocked == kAllNodes) return blocked == 0 ? 0.0f : 1.0f;
  glm::ivec3 below = face_cell;
  --below[axis];
  const std::uint32_t reached = reach(axis, below) & reach(axis, face_cell);
  return float(std::popcount(reached & blocked)) / float(std::popcount(reached));
}

}  // namespace

void cover_faces(const SlicedScene& s, BlockTable& table) {
  const Reach reach(s, table);
  tbb::parallel_for(size_t(0), s.occupied.size(), [&](size_t i) {
    BlockFaces* block = table[s.occupied[i]].get();
    if (block == nullptr) return;
    const glm::ivec3 first_cell = s.block_cell(s.occupied[i]);
    block->coverage.resize(block->faces.size());
    size_t face = 0;
    for (size_t axis = 0; axis < 3; ++axis) {
      for (size_t word = 0; word < 8; ++word) {
        for (std::uint64_t rest = block->active[axis][word]; rest != 0; rest &= rest - 1, ++face) {
          const int bit = std::countr_zero(rest);
          const glm::ivec3 face_cell = first_cell + glm::ivec3(int(word), bit >> 3, bit & 7);
          const FaceRecord& record = block->faces[face];
          float coverage = opaque_share(reach, record.fine_blocked, int(axis), face_cell);
          const bool opaque = coverage == 1.0f;
          if (!opaque && record.alpha_sum != 0) {
            coverage = 1.0f - (1.0f - coverage) * std::exp(-float(record.alpha_sum) / 65536.0f);
            coverage = std::min(coverage, std::nextafter(1.0f, 0.0f));  // 1 is for what is opaque
          }
          block->coverage[face] = coverage;
          const std::uint64_t mask = std::uint64_t(1) << bit;
          if (coverage > 0.0f) block->sided[axis][word] |= mask;
          if (opaque) block->opaque[axis][word] |= mask;
        }
      }
    }
  });
}

}  // namespace volgi::slicing
