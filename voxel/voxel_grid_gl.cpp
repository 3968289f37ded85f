#include "voxel/voxel_grid_gl.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "shaders/voxel/slots.shared.h"

namespace volgi {
namespace {

/// The tree of cells with sides as one dense array, x fastest.
std::vector<glm::uvec2> dense_cell_sides(const VoxelGrid& voxels) {
  const Grid& grid = voxels.grid();
  std::vector<glm::uvec2> dense(cell_count(grid), glm::uvec2(0));
  const glm::ivec3 blocks = voxels.blocks();
  tbb::parallel_for(tbb::blocked_range<int>(0, blocks.x * blocks.y * blocks.z), [&](const auto& range) {
    for (int b = range.begin(); b < range.end(); ++b) {
      const int row = b / blocks.x;
      const glm::ivec3 block(b - row * blocks.x, row % blocks.y, row / blocks.y);
      if (voxels.leaf(block) == nullptr) continue;
      const glm::ivec3 first = block * kLeafCells;
      const glm::ivec3 end = glm::min(first + kLeafCells, grid.cells);
      for (int z = first.z; z < end.z; ++z) {
        for (int y = first.y; y < end.y; ++y) {
          for (int x = first.x; x < end.x; ++x) {
            dense[size_t(shared::cell_index(grid, {x, y, z}))] = voxels.cell_sides({x, y, z});
          }
        }
      }
    }
  });
  return dense;
}

}  // namespace

void VoxelGridGl::bind() const {
  grid_block.bind_uniform(GRID_BLOCK);
  cell_sides.bind_storage(CELL_SIDES_SLOT);
  sides.bind_storage(SIDES_SLOT);
  side_count.bind_storage(SIDE_COUNT_SLOT);
}

std::vector<shared::Side> VoxelGridGl::download_sides() const {
  const auto count = side_count.download<std::uint32_t>(1)[0];
  return sides.download<shared::Side>(count);
}

VoxelGridGl upload(const VoxelGrid& voxels) {
  VoxelGridGl gpu;
  upload(voxels, gpu);
  return gpu;
}

void upload(const VoxelGrid& voxels, VoxelGridGl& into) {
  const Grid& grid = voxels.grid();
  const size_t cell_bytes = sizeof(glm::uvec2) * cell_count(grid);
  into.grid = grid;
  if (into.grid_block.bytes() == 0) into.grid_block = gl::Buffer(sizeof(Grid));
  into.grid_block.upload(&grid, sizeof(Grid));
  if (into.cell_sides.bytes() < cell_bytes) into.cell_sides = gl::Buffer(cell_bytes);
  if (into.side_count.bytes() == 0) into.side_count = gl::Buffer(sizeof(std::uint32_t));
  const auto count = std::uint32_t(voxels.side_count());
  if (into.sides.bytes() == 0 || count > into.side_capacity) {
    into.side_capacity = into.side_capacity == 0 ? count : count + count / 5;
    into.sides = gl::Buffer(sizeof(shared::Side) * size_t(into.side_capacity));
  }
  into.cell_sides.upload(dense_cell_sides(voxels).data(), cell_bytes);
  into.sides.upload(voxels.sides().data(), sizeof(shared::Side) * size_t(count));
  into.side_count.upload(&count, sizeof count);
}

VoxelGrid download(const VoxelGridGl& voxels) { return {voxels.grid, voxels.download_sides()}; }

}  // namespace volgi
