#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <cmath>

#include "voxel/side_search.h"
#include "voxel/slice_internal.h"

namespace volgi::slicing {

namespace {

// Above, columns of bits of all cells that are held (SideColumns) take more than sides do, and searches go without.
constexpr size_t kManyCells = size_t(1) << 24;

constexpr float kAreaUnit = 1048576.0f;  // of h^2; sums of integers do not depend on the order of threads

// How far from their block records count, in cells: they may be a cell outside, and a search reaches three to the
// plane, one to the cell at its face and one beside.
constexpr int kReach = 1 + 3 + 1 + 1;
static_assert(2 * kReach <= 2 * kLeafCells);  // two blocks apart

/// Where fine columns are, cell units: node_position(k) / SLICE_STEPS.
inline float fine_position(int k) { return float(2 * k + 1) / float(2 * kFine); }

/// Point of the triangle at a fine column, cell units.
inline void set_point(glm::vec3& point, int axis, const glm::ivec3& cell, int sub, float depth) {
  const int b = shared::axis_b(axis), c = shared::axis_c(axis);
  point[b] = fine_position(kFine * cell[b] + sub % kFine);
  point[c] = fine_position(kFine * cell[c] + sub / kFine);
  point[axis] = depth;
}

class AreaCounter {
 public:
  AreaCounter(const SlicedScene& s, const VoxelGrid& voxels) : s_(s), voxels_(voxels), fixed_(voxels.sides().size()) {
    if (kLeafVolume * voxels.held().count() <= kManyCells) columns_.emplace(voxels);
  }

  /// Never at the same time for blocks that may count for the same sides: between the others are two blocks.
  /// @param first_cell  of the records' block.
  void add(const std::vector<AreaRecord>& records, glm::ivec3 first_cell) {
    for (size_t first = 0, last = 0; first < records.size(); first = last) {
      const SliceTriangle& t = s_.triangles[records[first].triangle];
      const SideSearch search(voxels_, columns_ ? &*columns_ : nullptr, t.normal, 1, true);
      for (; last < records.size() && records[last].triangle == records[first].triangle; ++last) {
        add(records[last], first_cell + unpack_cell(records[last].cell), t, search);
      }
    }
  }

  std::vector<std::uint32_t> counted() && { return std::move(fixed_); }

 private:
  /// `search` is of the record's triangle.
  void add(const AreaRecord& record, const glm::ivec3& cell, const SliceTriangle& t, const SideSearch& search) {
    const int axis = t.nearest_axis;
    const std::uint32_t subs = sub_columns(record);
    const int count = int(sub_count(subs));
    const float stopped = float(record.amount >> kStoppedShift) / (kStoppedUnit * float(count));
    const float area = stopped / (float(kFine * kFine) * std::abs(t.normal[axis]));
    glm::vec3 point;
    set_point(point, axis, cell, std::countr_zero(subs), record.depth);
    const SideSearch::Answer found = search.at(point, cell);
    if (!found.place_matters || count == 1) {
      give(found.along, area, count);
      give(found.against, area, count);
      return;
    }
    const Long3 n = plane_normal(t);
    const int b = shared::axis_b(axis), c = shared::axis_c(axis);
    for (std::uint32_t rest = subs; rest != 0; rest &= rest - 1) {
      const int sub = std::countr_zero(rest);
      const double depth = plane_depth(t, n, axis, node_position(kFine * cell[b] + sub % kFine),
                                       node_position(kFine * cell[c] + sub / kFine));
      set_point(point, axis, cell, sub, float(depth));
      const SideSearch::Answer of_sub = search.at(point, cell);
      give(of_sub.along, area, 1);
      give(of_sub.against, area, 1);
    }
  }

  inline void give(const SidesOfPoint& to, float area, int count) {
    for (int axis = 0; axis < 3; ++axis) {
      if (!(to.weights[axis] > 0.0f)) continue;
      fixed_[size_t(to.sides[axis])] +=
          std::uint32_t(to.weights[axis] * area * kAreaUnit + 0.5f) * std::uint32_t(count);
    }
  }

  const SlicedScene& s_;
  const VoxelGrid& voxels_;
  std::optional<SideColumns> columns_;
  std::vector<std::uint32_t> fixed_;
};

/// Calls visit(block) for all occupied blocks: rows of them along x in parallel, at any time only rows that have two
/// others between them.
template <class Visit>
void for_each_block_apart(const SlicedScene& s, const Visit& visit) {
  struct Row {
    size_t first, last;  // of `occupied`, which is in the order of rows
  };
  const glm::ivec3 blocks = s.window.size();
  std::array<std::vector<Row>, 9> phases;
  const auto row_of = [&](size_t i) { return int(s.occupied[i]) / blocks.x; };
  for (size_t first = 0, last = 0; first < s.occupied.size(); first = last) {
    const int row = row_of(first);
    while (last < s.occupied.size() && row_of(last) == row) ++last;
    const int y = row % blocks.y, z = row / blocks.y;
    phases[size_t(y % 3 + 3 * (z % 3))].push_back({first, last});
  }
  for (const std::vector<Row>& rows : phases) {
    tbb::parallel_for(size_t(0), rows.size(), [&](size_t r) {
      for (size_t i = rows[r].first; i < rows[r].last; ++i) visit(s.occupied[i]);
    });
  }
}

}  // namespace

std::vector<std::uint32_t> count_areas(const SlicedScene& s, const BlockTable& table, const VoxelGrid& voxels) {
  AreaCounter counter(s, voxels);
  for_each_block_apart(s, [&](std::uint32_t at) {
    const BlockFaces* block = table[at].get();
    // What lies on the grid's upper rim goes with the last blocks.
    const glm::ivec3 of = glm::min(s.window.block(at), leaf_blocks(s.grid) - 1);
    if (block != nullptr && s.part.contains(of)) counter.add(block->areas, s.block_cell(at));
  });
  return std::move(counter).counted();
}

void set_areas(const std::vector<std::uint32_t>& counted, VoxelGrid& voxels) {
  const float h = voxels.grid().cell_size_m;
  auto& sides = voxels.mutable_sides();
  tbb::parallel_for(tbb::blocked_range<size_t>(0, sides.size(), 4096), [&](const tbb::blocked_range<size_t>& part) {
    for (size_t i = part.begin(); i != part.end(); ++i) {
      shared::Side& side = sides[i];
      const float min_area_m2 = SIDE_MIN_FILL * side.face_m2 / shared::staircase_factor(side.normal);
      side.area_m2 = std::max(float(counted[i]) / kAreaUnit * h * h, min_area_m2);
    }
  });
}

}  // namespace volgi::slicing
