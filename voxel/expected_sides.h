#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/scene.h"
#include "voxel/grid.h"
#include "voxel/part.h"

namespace volgi {

/// What a voxelization will find, for limits that are checked before any memory is taken.
struct ExpectedSides {
  size_t faces = 0;   // that surfaces cross
  size_t sides = 0;   // of these: two each, one at the grid's rim
  size_t blocks = 0;  // of 8^3 cells, with sides
};

/// Marks the faces that the scene's triangles cross on the lines through the middles of thirds of cells, which is where
/// both voxelizations look. Materials are not looked at: what alpha cuts away is counted.
/// Cost: a step for each crossing, nine a face; memory: half a KiB a block of 8^3 cells with
/// surfaces, 8 bytes a block.
ExpectedSides expected_sides(const Scene& scene, const Grid& grid);
/// Of these blocks alone. @param by_block  not null: what each has, by its index in the box.
ExpectedSides expected_sides(const Scene& scene, const Grid& grid, const BlockBox& blocks,
                             std::vector<std::uint32_t>* by_block = nullptr);

}  // namespace volgi
