#pragma once
// How much of each cell of a block a triangle covers, counted in the pass along the axis nearest to its normal.
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "voxel/slice_raster_internal.h"

namespace volgi::slicing {

class AreaList {
 public:
  /// Kept from block to block, empty between triangles.
  struct Scratch {
    // By cell: columns of the block fastest, from one cell below the block on.
    std::array<std::uint32_t, (kLeafCells + 2) * kLeafCells * kLeafCells> amount{};
    std::array<float, (kLeafCells + 2) * kLeafCells * kLeafCells> depth;
    std::vector<std::uint16_t> touched;
  };

  AreaList(glm::ivec3 first_cell, Scratch& scratch) : first_cell_(first_cell), scratch_(scratch) {}

  /// Whether layer() asks for the depth: the segment across a cell's lower face alone has a bit of two cells.
  static bool depth_decides(size_t at_segment) { return kFineTable.sub[at_segment] == 1; }
  /// The layer of cells that a fragment's depth lies in, from one below the block on.
  int layer(size_t at_segment, float depth, int axis) const {
    if (depth_decides(at_segment)) return int(depth + 1.0f) - first_cell_[axis];  // floor(depth) + 1: depth >= -1/2
    return at_segment == 0 ? 0 : kFineTable.cell[at_segment - 1] + 1;
  }

  /// One fragment. @param depth  () -> cell units; asked for the first of a cell only.
  template <class Depth>
  void add(int cell_b, int cell_c, int layer, int sub, float stopped, const Depth& depth) {
    const size_t entry = entry_of(cell_b, cell_c, layer);
    std::uint32_t& amount = scratch_.amount[entry];
    if (amount == 0) {
      scratch_.touched.push_back(std::uint16_t(entry));
      scratch_.depth[entry] = depth();
    }
    amount += (std::uint32_t(std::lround(stopped * kStoppedUnit)) << kStoppedShift) + (1u << sub);
  }

  /// All fragments of an opaque triangle in one cell. @param subs  bits of their sub-columns.
  void add_cell(int cell_b, int cell_c, int layer, std::uint32_t subs, float depth) {
    const size_t entry = entry_of(cell_b, cell_c, layer);
    scratch_.touched.push_back(std::uint16_t(entry));
    scratch_.depth[entry] = depth;
    scratch_.amount[entry] = (sub_count(subs) << (kStoppedShift + 16)) + subs;
    static_assert(kStoppedUnit == 1 << 16);
  }

  /// Turns what was counted of a triangle into records.
  void end_triangle(std::uint32_t triangle, int axis) {
    for (std::uint16_t entry : scratch_.touched) {
      glm::ivec3 cell(0);  // from the first
      cell[shared::axis_b(axis)] = entry % kLeafCells;
      cell[shared::axis_c(axis)] = entry / kLeafCells % kLeafCells;
      const int layer = entry / (kLeafCells * kLeafCells);
      cell[axis] = layer - 1;
      below_[size_t(axis)] |= layer == 0;
      records_.push_back({triangle, pack_cell(cell), scratch_.amount[entry], scratch_.depth[entry]});
      scratch_.amount[entry] = 0;
    }
    scratch_.touched.clear();
  }

  void move_to(BlockFaces& faces) {
    faces.areas = std::move(records_);
    faces.areas_below = below_;
  }
  bool empty() const { return records_.empty(); }

 private:
  static size_t entry_of(int cell_b, int cell_c, int layer) {
    return size_t(cell_b) + kLeafCells * (size_t(cell_c) + kLeafCells * size_t(layer));
  }

  glm::ivec3 first_cell_;
  Scratch& scratch_;
  std::vector<AreaRecord> records_;
  std::array<bool, 3> below_{};
};

}  // namespace volgi::slicing
