#pragma once
// Blocked faces and sides on the CPU, to look at and to turn.
#include <glm/glm.hpp>
#include <vector>

#include "core/gl/context.h"
#include "core/gl/pass_timer.h"
#include "core/gl/scene_buffers.h"
#include "voxel/sliced_voxelization.h"

namespace volgi::test {

using shared::Side;

struct Voxels {
  Grid grid{};
  std::vector<glm::uvec2> cells;
  std::vector<Side> sides;

  const glm::uvec2& cell(glm::ivec3 c) const { return cells[size_t(shared::cell_index(grid, c))]; }
  const Side* side(glm::ivec3 c, int face) const {
    return shared::has_side(cell(c), face) ? &sides[shared::side_index(cell(c), face)] : nullptr;
  }
  glm::vec3 centre(glm::ivec3 c) const { return shared::world_from_cell(grid, glm::vec3(c) + 0.5f); }

  /// Cells that light from the marked cells can reach, through faces that do not stop everything.
  std::vector<char> flood(std::vector<char> reached) const {
    std::vector<int> open;
    for (size_t i = 0; i < reached.size(); ++i) {
      if (reached[i] != 0) open.push_back(int(i));
    }
    while (!open.empty()) {
      const glm::ivec3 c = shared::cell_coord(grid, open.back());
      open.pop_back();
      for (int face = 0; face < 6; ++face) {
        const glm::ivec3 next = c + shared::face_step(face);
        if (!shared::cell_inside(grid, next) || shared::is_opaque(cell(c), face)) continue;
        char& mark = reached[size_t(shared::cell_index(grid, next))];
        if (mark == 0) open.push_back(shared::cell_index(grid, next));
        mark = 1;
      }
    }
    return reached;
  }
};

inline Voxels downloaded(const VoxelGridGl& gpu) {
  return {gpu.grid, gpu.cell_sides.download<glm::uvec2>(cell_count(gpu.grid)), gpu.download_sides()};
}

inline Voxels voxelize(const gl::Context& context, SlicedVoxelization& voxelization, const Scene& scene) {
  gl::PassTimer timer(context.software(), false);
  const gl::SceneBuffers buffers(scene);
  // The list of sides grows a run late: the second run has room for what the first one counted.
  for (int run = 0; run < 3; ++run) voxelization.run(buffers, timer);
  return downloaded(voxelization.voxels());
}

/// Blocked faces only: these are right from the first run on.
inline Voxels blocked_faces(const gl::Context& context, SlicedVoxelization& voxelization, const Scene& scene) {
  gl::PassTimer timer(context.software(), false);
  voxelization.run(gl::SceneBuffers(scene), timer);
  const VoxelGridGl& gpu = voxelization.voxels();
  return {gpu.grid, gpu.cell_sides.download<glm::uvec2>(cell_count(gpu.grid)), {}};
}

inline Voxels voxelize(const gl::Context& context, const Scene& scene, const Grid& grid) {
  SlicedVoxelization voxelization(grid);
  return voxelize(context, voxelization, scene);
}

/// The other way round, for transport through voxels that no scene made.
inline VoxelGridGl upload(const Voxels& v) {
  VoxelGridGl gpu;
  gpu.grid = v.grid;
  gpu.grid_block = gl::Buffer(sizeof(Grid), &v.grid);
  gpu.cell_sides = gl::Buffer(v.cells);
  gpu.sides = gl::Buffer(v.sides);
  const auto count = std::uint32_t(v.sides.size());
  gpu.side_count = gl::Buffer(sizeof count, &count);
  gpu.side_capacity = count;
  return gpu;
}

}  // namespace volgi::test
