#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "voxel/side_halo.h"
#include "voxel/voxel_grid.h"

namespace volgi {

/// Which faces of a whole grid stop light, as cells see them, without what sides know of their surface: little enough
/// that every rank has those of all. Rays go from cell to cell through faces without a side.
/// Memory: 4 bytes a block of 8^3 cells, 76 a block with sides, 4 a cell with sides and one a side (some 450 bytes a
/// block of a wall, a twentieth of VoxelGrid's).
class GridFaces {
 public:
  explicit GridFaces(const VoxelGrid& voxels);
  /// All ranks: those of all of them.
  GridFaces(const VoxelGrid& voxels, const RanksOfVolume& ranks);

  /// A side that light meets, in the cell that sees it.
  struct Hit {
    glm::ivec3 cell{-1};
    int face = 0;
    float t = 0.0f;  // way along the ray to the face
  };
  /// From a point, in cell units like the direction: the first face that stops the ray. One that stops a share of the
  /// light stops that share of rays, by hash of `seed`, cell and face. Cost: a step for each cell, of blocks without
  /// sides one.
  /// @return false: the ray leaves the grid, or does not come into it, as where a wall on its rim keeps it out.
  bool meet(glm::vec3 origin, glm::vec3 direction, std::uint32_t seed, Hit& hit) const;
  size_t bytes() const;

 private:
  struct Block {
    std::array<std::uint64_t, 8> cells{};  // a bit for each cell with sides, by leaf_offset()
    std::uint32_t first_cell = 0, first_side = 0;
  };
  struct Cell {
    std::uint16_t first_side;  // of the block's
    std::uint8_t faces;        // a bit for each with a side
  };

  void add(const VoxelGrid& voxels);
  void append(std::span<const std::byte> from);
  std::vector<std::byte> packed() const;
  bool stops(const Block& block, glm::ivec3 cell, int face, std::uint32_t seed) const;

  Grid grid_;
  glm::ivec3 blocks_;
  std::vector<std::int32_t> block_of_;       // by block: index into with_sides_, or -1
  std::vector<std::int32_t> block_numbers_;  // of with_sides_
  std::vector<Block> with_sides_;
  std::vector<Cell> cells_;
  std::vector<std::uint8_t> coverage_;  // of sides: 255 stops everything
};

}  // namespace volgi
