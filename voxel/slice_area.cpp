#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <cmath>

#include "voxel/side_search.h"
#include "voxel/slice_internal.h"

namespace volgi::slicing {

namespace {

constexpr float kAreaUnit = 1048576.0f;  // of h^2; sums of integers do not depend on the order of threads

/// Point of the triangle at a fine column, cell units.
glm::vec3 point_at(int axis, glm::ivec3 cell, int sub, float depth) {
  const int b = shared::axis_b(axis), c = shared::axis_c(axis);
  glm::vec3 point;
  point[b] = float(double(node_position(kFine * cell[b] + sub % kFine)) / SLICE_STEPS);
  point[c] = float(double(node_position(kFine * cell[c] + sub / kFine)) / SLICE_STEPS);
  point[axis] = depth;
  return point;
}

class AreaCounter {
 public:
  AreaCounter(const SlicedScene& s, const VoxelGrid& voxels)
      : s_(s), voxels_(voxels), columns_(voxels), fixed_(voxels.side_count()) {}

  void add(const std::vector<AreaRecord>& records) {
    for (size_t first = 0, last = 0; first < records.size(); first = last) {
      const SideSearch search(voxels_, &columns_, s_.triangles[records[first].triangle].normal, 1, true);
      for (; last < records.size() && records[last].triangle == records[first].triangle; ++last) {
        add(records[last], search);
      }
    }
  }

  float area_m2(size_t side) const {
    const float h = s_.grid.cell_size_m;
    return float(fixed_[side].load(std::memory_order_relaxed)) / kAreaUnit * h * h;
  }

 private:
  /// `search` is of the record's triangle.
  void add(const AreaRecord& record, const SideSearch& search) {
    const SliceTriangle& t = s_.triangles[record.triangle];
    const int axis = t.nearest_axis;
    const std::uint32_t subs = record.amount & ((1u << kStoppedShift) - 1);
    const int count = std::popcount(subs);
    const float stopped = float(record.amount >> kStoppedShift) / (kStoppedUnit * float(count));
    const float area = stopped / (float(kFine * kFine) * std::abs(t.normal[axis]));
    const glm::ivec3 cell = unpack_cell(record.cell);
    const SideSearch::Answer found = search.at(point_at(axis, cell, std::countr_zero(subs), record.depth), cell);
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
      const SideSearch::Answer of_sub = search.at(point_at(axis, cell, sub, float(depth)), cell);
      give(of_sub.along, area, 1);
      give(of_sub.against, area, 1);
    }
  }

  void give(const SidesOfPoint& to, float area, int count) {
    for (int axis = 0; axis < 3; ++axis) {
      if (!(to.weights[axis] > 0.0f)) continue;
      const auto units = std::uint32_t(to.weights[axis] * area * kAreaUnit + 0.5f) * std::uint32_t(count);
      fixed_[size_t(to.sides[axis])].fetch_add(units, std::memory_order_relaxed);
    }
  }

  const SlicedScene& s_;
  const VoxelGrid& voxels_;
  SideColumns columns_;
  std::vector<std::atomic<std::uint32_t>> fixed_;
};

}  // namespace

void count_areas(const SlicedScene& s, const BlockTable& table, VoxelGrid& voxels) {
  AreaCounter counter(s, voxels);
  tbb::parallel_for(size_t(0), s.occupied.size(), [&](size_t i) {
    const BlockFaces* block = table[s.occupied[i]].get();
    if (block != nullptr) counter.add(block->areas);
  });
  auto& sides = voxels.mutable_sides();
  tbb::parallel_for(tbb::blocked_range<size_t>(0, sides.size(), 4096), [&](const tbb::blocked_range<size_t>& part) {
    for (size_t i = part.begin(); i != part.end(); ++i) {
      shared::Side& side = sides[i];
      const float least = SIDE_LEAST_FILL * side.face_m2 / shared::staircase_factor(side.normal);
      side.area_m2 = std::max(counter.area_m2(i), least);
    }
  });
}

}  // namespace volgi::slicing
