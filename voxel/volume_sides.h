#pragma once
#include <span>
#include <vector>

#include "voxel/cascade.h"
#include "voxel/voxel_grid.h"

namespace volgi {

/// Own sides of a volume, numbered through: of one grid, or of the grids of a cascade one after another. A view, that
/// the grids must outlive.
class VolumeSides {
 public:
  VolumeSides(const VoxelGrid& voxels);  // NOLINT(google-explicit-constructor): one grid is a volume
  VolumeSides(const Cascade& cascade, std::span<const VoxelGrid> levels);

  size_t count() const { return first_.back(); }
  /// Null: one grid.
  const Cascade* cascade() const { return cascade_; }
  size_t levels() const { return grids_.size(); }
  const VoxelGrid& level(size_t level) const { return *grids_[level]; }
  /// Number of a level's first side; of levels(): count().
  size_t first(size_t level) const { return first_[level]; }
  size_t level_of(size_t side) const {
    size_t level = 0;
    while (side >= first_[level + 1]) ++level;
    return level;
  }
  const shared::Side& operator[](size_t side) const {
    const size_t level = level_of(side);
    return grids_[level]->sides()[side - first_[level]];
  }
  /// Area of a face over that of the first level's.
  float relative_face(size_t side) const { return relative_face_[level_of(side)]; }
  template <class T>
  std::span<T> of_level(std::span<T> values, size_t level) const {
    return values.subspan(first_[level], first_[level + 1] - first_[level]);
  }

  /// Of a point of a surface that faces that way, the level of the cells that see it: half a cell in front of it.
  size_t level_of(glm::vec3 position, glm::vec3 normal) const;
  /// A grid of the whole volume with the innermost level's cells: what light is divided up for.
  Grid finest_grid() const;

 private:
  void add(const VoxelGrid& level);

  const Cascade* cascade_ = nullptr;
  std::vector<const VoxelGrid*> grids_;
  std::vector<size_t> first_{0};
  std::vector<float> relative_face_;
};

}  // namespace volgi
