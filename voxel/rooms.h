#pragma once
#include <array>
#include <vector>

#include "voxel/voxel_grid.h"

namespace volgi {

/// Cells that light goes between, and the rooms that they make: what is left of the cells after the HALF_WIDTH layers
/// before every wall are taken off falls into cores, those of LEAST_CELLS or more are rooms, and these grow back, wide
/// places first (a watershed), so that two of them meet where the way from one into the other is narrowest. Bodies'
/// insides count as rooms, which nothing joins. Faces that stop half of the light and more are walls. Cost: some visits
/// of every cell, on one thread; one where there is one room. Memory: 6 bytes a cell.
class Rooms {
 public:
  static constexpr int HALF_WIDTH = 4;    // of the widest passage, in cells
  static constexpr int LEAST_CELLS = 64;  // of a room, farther than that from all walls

  /// @param voxels  all of a grid, in one part.
  explicit Rooms(const VoxelGrid& voxels);

  int count() const { return count_; }
  /// Of a cell; below 0: in none.
  int of(int cell) const { return room_of_[size_t(cell)]; }
  /// Steps through free faces to a cell beside a wall, and one: HALF_WIDTH + 1 at most.
  int from_walls(int cell) const { return from_walls_[size_t(cell)]; }
  size_t cells() const { return room_of_.size(); }
  /// The cell beyond a free face, or -1.
  int beyond(int cell, int face) const {
    return ((free_[size_t(cell)] >> face) & 1) != 0 ? cell + step_[size_t(face)] : -1;
  }

 private:
  static constexpr int NONE = -1, TOO_SMALL = -2;

  template <class Visit>
  void for_free_neighbours(int cell, const Visit& visit) const;
  void measure_distances(const VoxelGrid& voxels);
  void find_core(int first);
  void grow();

  std::vector<unsigned char> free_;  // by cell, a bit for each face that lets light on into another cell
  std::array<int, 6> step_{};        // from a cell's number to that beyond a face
  std::vector<unsigned char> from_walls_;
  std::vector<int> room_of_;
  int count_ = 0;
};

}  // namespace volgi
