#include "voxel/white_pockets.h"

#include <algorithm>
#include <cstdint>
#include <vector>

#include "shaders/voxel/white_pockets.shared.h"

namespace volgi {

namespace {

/// Bands in which light leaves each cell in the end, spread from those where it does at once.
class Leaving {
 public:
  explicit Leaving(const VoxelGrid& voxels) : voxels_(voxels), bands_(cell_count(voxels.grid()), 0) {
    for (const shared::Side& side : voxels.sides())
      add(shared::cell_coord(voxels.grid(), side.cell), shared::bands_below_white(side.albedo));
    const glm::ivec3 cells = voxels.grid().cells;
    for (int face = 0; face < 6; ++face) {
      const int axis = shared::face_axis(face), b = shared::axis_b(axis), c = shared::axis_c(axis);
      glm::ivec3 cell(shared::face_sign(face) < 0 ? 0 : cells[axis] - 1);
      for (cell[b] = 0; cell[b] < cells[b]; ++cell[b]) {
        for (cell[c] = 0; cell[c] < cells[c]; ++cell[c]) {
          if (!shared::is_opaque(voxels.cell_sides(cell), face)) add(cell, ALL_BANDS);
        }
      }
    }
    while (!changed_.empty()) spread(pop());
  }
  std::uint32_t bands(int cell) const { return bands_[size_t(cell)]; }
  size_t cells_without_some() const {
    return size_t(std::count_if(bands_.begin(), bands_.end(), [](std::uint8_t b) { return b != ALL_BANDS; }));
  }

 private:
  void add(glm::ivec3 cell, std::uint32_t bands) {
    std::uint8_t& own = bands_[size_t(shared::cell_index(voxels_.grid(), cell))];
    if ((bands & ~own) == 0) return;
    own = std::uint8_t(own | bands);
    changed_.push_back(cell);
  }
  glm::ivec3 pop() {
    const glm::ivec3 last = changed_.back();
    changed_.pop_back();
    return last;
  }
  void spread(glm::ivec3 cell) {
    const glm::uvec2 sides = voxels_.cell_sides(cell);
    const std::uint32_t own = bands(shared::cell_index(voxels_.grid(), cell));
    for (int face = 0; face < 6; ++face) {
      const glm::ivec3 next = cell + shared::face_step(face);
      if (shared::cell_inside(voxels_.grid(), next) && !shared::is_opaque(sides, face)) add(next, own);
    }
  }

  const VoxelGrid& voxels_;
  std::vector<std::uint8_t> bands_;  // of every cell
  std::vector<glm::ivec3> changed_;  // whose neighbours have not been told
};

}  // namespace

size_t bound_white_pockets(VoxelGrid& voxels) {
  const Leaving leaving(voxels);
  for (shared::Side& side : voxels.mutable_sides()) {
    for (int band = 0; band < 3; ++band) {
      if ((leaving.bands(side.cell) >> band & 1u) == 0)
        side.albedo[band] = std::min(side.albedo[band], MAX_POCKET_ALBEDO);
    }
  }
  return leaving.cells_without_some();
}

bool may_have_white_pockets(float largest_albedo) { return largest_albedo >= WHITE_ALBEDO; }

}  // namespace volgi
