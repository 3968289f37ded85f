#include "voxel/passages.h"

#include <algorithm>
#include <map>

#include "voxel/voxelize_cpu.h"

namespace volgi {

namespace {

constexpr float OPEN_COVERAGE = 0.5f;
constexpr int SMALLEST_PLACE = 50;     // as a part of all cells
constexpr size_t FEWEST_POINTS = 100;  // as a part of all
constexpr double STAYS_JOINED = 0.97;  // of a place
constexpr size_t LOOKED_AT_MORE = 2;   // cells of the finest grid that is looked at, over those of the answer

/// Numbers places as they are met.
class Places {
 public:
  explicit Places(const VoxelGrid& voxels) : voxels_(voxels), place_of_(cell_count(voxels.grid()), -1) {
    for (size_t i = 0; i < place_of_.size(); ++i) {
      if (place_of_[i] >= 0) continue;
      has_front_.push_back(false);
      has_back_.push_back(false);
      enter(int(i));
      while (!entered_.empty()) spread();
    }
    for (int& place : place_of_) {
      if (has_back_[size_t(place)] && !has_front_[size_t(place)]) place = -1;
    }
  }
  std::vector<int> take() { return std::move(place_of_); }

 private:
  void enter(int cell) {
    place_of_[size_t(cell)] = int(has_front_.size()) - 1;
    entered_.push_back(cell);
  }
  void spread() {
    const glm::ivec3 cell = shared::cell_coord(voxels_.grid(), entered_.back());
    entered_.pop_back();
    const glm::uvec2 own = voxels_.cell_sides(cell);
    for (int face = 0; face < 6; ++face) {
      if (shared::has_side(own, face)) {
        const shared::Side& side = voxels_.sides()[shared::side_index(own, face)];
        (side.front != 0 ? has_front_ : has_back_).back() = true;
        if (side.coverage >= OPEN_COVERAGE) continue;
      }
      const glm::ivec3 next = cell + shared::face_step(face);
      if (!shared::cell_inside(voxels_.grid(), next)) continue;
      const int index = shared::cell_index(voxels_.grid(), next);
      if (place_of_[size_t(index)] < 0) enter(index);
    }
  }

  const VoxelGrid& voxels_;
  std::vector<int> place_of_;
  std::vector<bool> has_front_, has_back_;  // by place
  std::vector<int> entered_;                // whose neighbours have not been looked at
};

std::map<int, size_t> sizes_of(const std::vector<int>& places) {
  std::map<int, size_t> sizes;
  for (const int place : places) {
    if (place >= 0) ++sizes[place];
  }
  std::erase_if(sizes, [&](const auto& s) { return s.second * SMALLEST_PLACE < places.size(); });
  return sizes;
}

/// Of cells `factor` times as large, from the same corner on.
Grid coarser(const Grid& fine, int factor) {
  Grid grid = fine;
  grid.cell_size_m = fine.cell_size_m * float(factor);
  grid.cells = (fine.cells + (factor - 1)) / factor;
  return grid;
}

/// The one place of all fine cells in a coarse one; -1: there are several, or none.
int place_in(const Grid& fine, const std::vector<int>& places, glm::ivec3 coarse_cell, int factor) {
  const glm::ivec3 first = coarse_cell * factor, end = glm::min(first + factor, fine.cells);
  const int place = places[size_t(shared::cell_index(fine, first))];
  glm::ivec3 c;
  for (c.z = first.z; c.z < end.z; ++c.z) {
    for (c.y = first.y; c.y < end.y; ++c.y) {
      for (c.x = first.x; c.x < end.x; ++c.x) {
        if (places[size_t(shared::cell_index(fine, c))] != place) return -1;
      }
    }
  }
  return place;
}

/// Whether places of the fine grid are places of one `factor` times coarser too, as far as its cells lie in one.
bool stay_joined(const Scene& scene, const Grid& fine, const std::vector<int>& places, int factor) {
  const Grid grid = coarser(fine, factor);
  const std::vector<int> coarse = places_of(voxelize_cpu(scene, grid));
  std::map<int, std::map<int, size_t>> parts;  // of each fine place
  for (size_t i = 0; i < coarse.size(); ++i) {
    const int place = place_in(fine, places, shared::cell_coord(grid, int(i)), factor);
    if (place >= 0) ++parts[place][coarse[i]];
  }
  const std::map<int, size_t> counted = sizes_of(places);
  return std::all_of(counted.begin(), counted.end(), [&](const auto& place) {
    size_t all = 0, largest = 0;
    for (const auto& [coarse_place, cells] : parts[place.first]) {
      all += cells;
      largest = std::max(largest, cells);
    }
    return double(largest) >= STAYS_JOINED * double(all);
  });
}

/// Places that no light comes from count as none: bodies that stand on a floor.
void keep_lit(const Grid& grid, std::span<const LitPoint> lit, std::vector<int>& places) {
  if (lit.empty()) return;
  std::map<int, size_t> points;
  for (const LitPoint& p : lit) {
    const glm::ivec3 cell(glm::floor(shared::cell_from_world(grid, p.position) + 0.6f * p.normal));
    if (shared::cell_inside(grid, cell)) ++points[places[size_t(shared::cell_index(grid, cell))]];
  }
  for (int& place : places) {
    if (points[place] * FEWEST_POINTS < lit.size()) place = -1;
  }
}

}  // namespace

std::vector<int> places_of(const VoxelGrid& voxels) { return Places(voxels).take(); }

int cells_that_keep_passages(const Scene& scene, int cells, size_t most_cells, std::span<const LitPoint> lit,
                             const std::optional<GridBox>& box) {
  const auto grid_of = [&](int n) { return make_grid(scene, n, glm::vec3(0.0f), box); };
  if (sizes_of(places_of(voxelize_cpu(scene, grid_of(std::max(cells / 2, 1))))).size() <= 1) return cells;
  const Grid fine = grid_of(2 * cells);
  if (cell_count(fine) > LOOKED_AT_MORE * most_cells) return cells;
  std::vector<int> places = places_of(voxelize_cpu(scene, fine));
  keep_lit(fine, lit, places);
  int needed = 8 * cells / 3;
  for (const int factor : {2, 3, 4}) {
    if (!stay_joined(scene, fine, places, factor)) break;
    needed = 4 * cells / factor;
  }
  while (needed > cells && cell_count(grid_of(needed)) > most_cells) --needed;
  return needed;
}

}  // namespace volgi
