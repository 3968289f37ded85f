#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <numeric>

#include "voxel/slice_internal.h"

namespace volgi::slicing {

namespace {

// Vertices farther than this from the grid's origin, 1365 cells, are pulled in: 64-bit integers hold all products then.
// Scenes lie inside their grid, unless it has a box of its own.
constexpr int kFarthest = 1 << 19;
constexpr int kFarthestCells = kFarthest / SLICE_STEPS;

/// Where the triangles of each mesh start in the GPU's numbering.
struct MeshRange {
  std::uint32_t first;
  std::uint32_t mesh;
};

std::vector<MeshRange> number_triangles(const Scene& scene, std::uint32_t& count) {
  std::vector<std::uint32_t> order(scene.meshes.size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(),
                   [&](auto a, auto b) { return scene.meshes[a].material < scene.meshes[b].material; });
  std::vector<MeshRange> ranges;
  count = 0;
  for (std::uint32_t mesh : order) {
    if (scene.meshes[mesh].triangles.empty()) continue;
    ranges.push_back({count, mesh});
    count += std::uint32_t(scene.meshes[mesh].triangles.size());
  }
  return ranges;
}

glm::vec3 front_normal(glm::dvec3 a, glm::dvec3 b, glm::dvec3 c) {
  const glm::dvec3 n = glm::cross(b - a, c - a);
  const double length = glm::length(n);
  return length > 0.0 ? glm::vec3(n / length) : glm::vec3(0.0f);
}

/// Finds the blocks that may hold fragments; none for the many triangles that no fine column meets.
void place_in_blocks(const SlicedScene& s, SliceTriangle& t) {
  t.first_block = {1, 0, 0};
  t.last_block = {0, 0, 0};
  const FineBox fine = fine_box(t);
  int axes_met = 0;
  for (int axis = 0; axis < 3; ++axis) axes_met += fine.first[axis] <= fine.last[axis];
  if (axes_met < 2) return;
  // Fragments lie between the nodes around: a depth just above the last of them belongs to the next.
  auto first_block = t.first_block, last_block = t.last_block;
  for (int axis = 0; axis < 3; ++axis) {
    const auto block_of = [](int node) { return node >= 0 ? node / (kFine * kLeafCells) : -1; };
    // Node 3i - 1 is the last one below face i, whose block is that of cell i. What lies on the grid's upper rim also
    // counts for the cells below it (slice_cells.cpp).
    const int first = std::min(block_of(fine.first[axis] - 1), (s.grid.cells[axis] - 1) / kLeafCells);
    const int last = block_of(fine.last[axis] + 2);
    const int first_here = std::max(first, s.window.first[axis]), last_here = std::min(last, s.window.last[axis] - 1);
    if (first_here > last_here) return;
    first_block[size_t(axis)] = std::uint8_t(first_here);
    last_block[size_t(axis)] = std::uint8_t(last_here);
  }
  t.first_block = first_block;
  t.last_block = last_block;
}

/// Calls visit(block) for every block of the triangle's box that its plane passes (all, for a few).
template <class Visit>
void for_each_block(const SlicedScene& s, const SliceTriangle& t, Visit&& visit) {
  const glm::ivec3 first(t.first_block[0], t.first_block[1], t.first_block[2]);
  const glm::ivec3 last(t.last_block[0], t.last_block[1], t.last_block[2]);
  if (first.x > last.x) return;
  if (first == last) {
    visit(s.window.index(first));
    return;
  }
  const bool ask_plane = first.x < last.x && first.y < last.y && first.z < last.z;
  const Long3 n = plane_normal(t);
  const glm::dvec3 normal{double(n[0]), double(n[1]), double(n[2])};
  constexpr double kEdge = kLeafCells * SLICE_STEPS;
  // Faces reach half a cell below the block; a little more, for rounding.
  const double reach = (0.5 * kEdge + SLICE_STEPS) * (std::abs(normal.x) + std::abs(normal.y) + std::abs(normal.z));
  for (int z = first.z; z <= last.z; ++z) {
    for (int y = first.y; y <= last.y; ++y) {
      for (int x = first.x; x <= last.x; ++x) {
        const glm::ivec3 block(x, y, z);
        const glm::dvec3 centre = (glm::dvec3(block) + 0.5) * kEdge - glm::dvec3(t.vertex[0]);
        if (ask_plane && std::abs(glm::dot(normal, centre)) > reach) continue;
        visit(s.window.index(block));
      }
    }
  }
}

void place_triangles(SlicedScene& s, const std::vector<MeshRange>& ranges) {
  const auto place = [&](const tbb::blocked_range<std::uint32_t>& part) {
    auto range = std::upper_bound(ranges.begin(), ranges.end(), part.begin(),
                                  [](std::uint32_t i, const MeshRange& r) { return i < r.first; });
    --range;
    for (std::uint32_t i = part.begin(); i != part.end(); ++i) {
      while (range + 1 != ranges.end() && i >= (range + 1)->first) ++range;
      const Mesh& mesh = s.scene->meshes[range->mesh];
      SliceTriangle& t = s.triangles[i];
      t.mesh = range->mesh;
      t.triangle = i - range->first;
      const glm::uvec3 corners = mesh.triangles[t.triangle];
      for (int k = 0; k < 3; ++k) {
        const glm::vec3 cell = shared::cell_from_world(s.grid, mesh.positions[corners[k]]);
        const glm::vec3 bound(static_cast<float>(kFarthestCells));
        t.vertex[size_t(k)] = shared::slice_vertex(glm::clamp(cell, -bound, bound));
      }
      t.normal = front_normal(mesh.positions[corners.x], mesh.positions[corners.y], mesh.positions[corners.z]);
      const glm::vec3 a = glm::abs(t.normal);
      t.nearest_axis = a.x >= a.y && a.x >= a.z ? 0 : a.y >= a.z ? 1 : 2;
      t.may_pass = s.material(t).alpha_mode != AlphaMode::opaque;
      place_in_blocks(s, t);
    }
  };
  tbb::parallel_for(tbb::blocked_range<std::uint32_t>(0, std::uint32_t(s.triangles.size()), 1024), place);
}

/// Fills `first` and `binned`. The order within a block depends on the threads; nothing made of it does.
void bin_triangles(SlicedScene& s) {
  const size_t blocks = s.window.count();
  std::vector<std::atomic<std::uint32_t>> next(blocks);
  const tbb::blocked_range<size_t> all(0, s.triangles.size(), 1024);
  tbb::parallel_for(all, [&](const tbb::blocked_range<size_t>& part) {
    for (size_t i = part.begin(); i != part.end(); ++i) {
      for_each_block(s, s.triangles[i], [&](size_t block) { next[block].fetch_add(1, std::memory_order_relaxed); });
    }
  });
  s.first.resize(blocks + 1);
  std::uint32_t sum = 0;
  for (size_t block = 0; block < blocks; ++block) {
    s.first[block] = sum;
    const std::uint32_t count = next[block].exchange(sum, std::memory_order_relaxed);
    if (count > 0) s.occupied.push_back(std::uint32_t(block));
    sum += count;
  }
  s.first[blocks] = sum;
  s.binned.resize(sum);
  tbb::parallel_for(all, [&](const tbb::blocked_range<size_t>& part) {
    for (size_t i = part.begin(); i != part.end(); ++i) {
      for_each_block(s, s.triangles[i], [&](size_t block) {
        s.binned[next[block].fetch_add(1, std::memory_order_relaxed)] = std::uint32_t(i);
      });
    }
  });
}

void set_window(SlicedScene& s, const BlockBox& part) {
  const glm::ivec3 all = leaf_blocks(s.grid), with_rim = s.grid.cells / kLeafCells + 1;
  const glm::ivec3 around_y_and_z(0, 1, 1);
  s.part = part;
  s.held = {glm::max(part.first - around_y_and_z, 0), glm::min(part.last + around_y_and_z, all)};
  s.window = {s.held.first, glm::min(part.last + 1, with_rim)};
  const glm::ivec3 known = kSidesKnownAround * around_y_and_z;
  s.first_cell = glm::max(kLeafCells * part.first - known, 0);
  s.last_cell = glm::min(kLeafCells * part.last + known, s.grid.cells);
  if (part.empty()) s.held = s.window = {part.first, part.first}, s.last_cell = s.first_cell;
}

/// Leaves out those that meet no block of the window. The others keep their order, and so do ties between them.
void drop_triangles_elsewhere(SlicedScene& s) {
  std::erase_if(s.triangles, [](const SliceTriangle& t) { return t.first_block[0] > t.last_block[0]; });
  s.triangles.shrink_to_fit();
}

}  // namespace

SlicedScene slice_scene(const Scene& scene, const Grid& grid, const Mipmaps& mipmaps, const BlockBox& part) {
  SlicedScene s;
  s.scene = &scene;
  s.mipmaps = &mipmaps;
  s.grid = grid;
  set_window(s, part);
  std::uint32_t count = 0;
  const std::vector<MeshRange> ranges = number_triangles(scene, count);
  s.triangle_count = count;
  s.triangles.resize(count);
  if (count > 0) place_triangles(s, ranges);
  if (part.count() < BlockBox{glm::ivec3(0), leaf_blocks(grid)}.count()) drop_triangles_elsewhere(s);
  s.constant = constant_materials(scene);
  bin_triangles(s);
  return s;
}

SlicedScene slice_scene(const Scene& scene, const Grid& grid, const Mipmaps& mipmaps) {
  return slice_scene(scene, grid, mipmaps, {glm::ivec3(0), leaf_blocks(grid)});
}

}  // namespace volgi::slicing
