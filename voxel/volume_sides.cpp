#include "voxel/volume_sides.h"

namespace volgi {

VolumeSides::VolumeSides(const VoxelGrid& voxels) { add(voxels); }

VolumeSides::VolumeSides(const Cascade& cascade, std::span<const VoxelGrid> levels)
    : cascade_(levels.size() > 1 ? &cascade : nullptr) {
  for (const VoxelGrid& level : levels) add(level);
}

void VolumeSides::add(const VoxelGrid& level) {
  grids_.push_back(&level);
  first_.push_back(first_.back() + level.side_count());
  const float edge = level.grid().cell_size_m / grids_.front()->grid().cell_size_m;
  relative_face_.push_back(edge * edge);
}

size_t VolumeSides::level_of(glm::vec3 position, glm::vec3 normal) const {
  for (size_t level = levels(); level-- > 1;) {
    const Grid& grid = grids_[level]->grid();
    const glm::vec3 seen_from = shared::cell_from_world(grid, position) + 0.5f * normal;
    if (shared::cell_inside(grid, glm::ivec3(glm::floor(seen_from)))) return level;
  }
  return 0;
}

Grid VolumeSides::finest_grid() const {
  Grid grid = grids_.front()->grid();
  if (cascade_ == nullptr) return grid;
  grid.cells = cascade_->finest_cells();
  grid.cell_size_m = grids_.back()->grid().cell_size_m;
  return grid;
}

}  // namespace volgi
