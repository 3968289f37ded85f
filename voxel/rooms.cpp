#include "voxel/rooms.h"

#include <algorithm>

namespace volgi {

namespace {

constexpr float WALL_COVERAGE = 0.5f;

std::vector<unsigned char> free_faces(const VoxelGrid& voxels) {
  constexpr unsigned all = 63;
  const glm::ivec3 n = voxels.grid().cells;
  std::vector<unsigned char> faces(cell_count(voxels.grid()), static_cast<unsigned char>(all));
  for (int z = 0; z < n.z; ++z) {
    for (int y = 0; y < n.y; ++y) {
      unsigned char* row = &faces[size_t(shared::cell_index(voxels.grid(), {0, y, z}))];
      const unsigned shut =
          (y == 0 ? 4u : 0u) | (y == n.y - 1 ? 8u : 0u) | (z == 0 ? 16u : 0u) | (z == n.z - 1 ? 32u : 0u);
      for (int x = 0; x < n.x && shut != 0; ++x) row[x] &= static_cast<unsigned char>(~shut);
      row[0] &= static_cast<unsigned char>(~1u);
      row[n.x - 1] &= static_cast<unsigned char>(~2u);
    }
  }
  for (const shared::Side& side : voxels.sides()) {
    if (side.coverage >= WALL_COVERAGE) faces[size_t(side.cell)] &= static_cast<unsigned char>(~(1u << side.face));
  }
  return faces;
}

}  // namespace

Rooms::Rooms(const VoxelGrid& voxels) : free_(free_faces(voxels)) {
  const glm::ivec3 n = voxels.grid().cells;
  for (int face = 0; face < 6; ++face)
    step_[size_t(face)] = (face & 1 ? 1 : -1) * (face < 2 ? 1 : face < 4 ? n.x : n.x * n.y);
  measure_distances(voxels);
  room_of_.assign(free_.size(), NONE);
  for (size_t i = 0; i < room_of_.size(); ++i) {
    if (from_walls_[i] > HALF_WIDTH && room_of_[i] == NONE) find_core(int(i));
  }
  if (count_ > 1) grow();
}

template <class Visit>
void Rooms::for_free_neighbours(int cell, const Visit& visit) const {
  for (unsigned faces = free_[size_t(cell)]; faces != 0; faces &= faces - 1)
    visit(cell + step_[size_t(__builtin_ctz(faces))]);
}

void Rooms::measure_distances(const VoxelGrid& voxels) {
  from_walls_.assign(free_.size(), HALF_WIDTH + 1);
  std::vector<int> ring, next_ring;
  for (const shared::Side& side : voxels.sides()) {
    unsigned char& distance = from_walls_[size_t(side.cell)];
    if (side.coverage < WALL_COVERAGE || distance == 1) continue;
    distance = 1;
    ring.push_back(side.cell);
  }
  for (int d = 2; d <= HALF_WIDTH; ++d) {
    next_ring.clear();
    for (const int cell : ring) {
      for_free_neighbours(cell, [&](int next) {
        if (from_walls_[size_t(next)] <= d) return;
        from_walls_[size_t(next)] = static_cast<unsigned char>(d);
        next_ring.push_back(next);
      });
    }
    ring.swap(next_ring);
  }
}

/// What is far from all walls, one piece after the other.
void Rooms::find_core(int first) {
  std::vector<int> cells{first};
  room_of_[size_t(first)] = count_;
  for (size_t k = 0; k < cells.size(); ++k) {
    for_free_neighbours(cells[k], [&](int next) {
      if (from_walls_[size_t(next)] <= HALF_WIDTH || room_of_[size_t(next)] != NONE) return;
      room_of_[size_t(next)] = count_;
      cells.push_back(next);
    });
  }
  if (cells.size() >= size_t(LEAST_CELLS)) {
    ++count_;
  } else {
    for (const int cell : cells) room_of_[size_t(cell)] = TOO_SMALL;
  }
}

/// From the cores on.
void Rooms::grow() {
  std::array<std::vector<int>, HALF_WIDTH + 2> edge;  // by distance from walls
  for (size_t i = 0; i < room_of_.size(); ++i) {
    if (room_of_[i] >= 0) edge[HALF_WIDTH + 1].push_back(int(i));
  }
  for (size_t level = edge.size(); level-- > 1;) {
    for (size_t k = 0; k < edge[level].size(); ++k) {
      const int cell = edge[level][k];
      for_free_neighbours(cell, [&](int next) {
        if (room_of_[size_t(next)] >= 0) return;
        room_of_[size_t(next)] = room_of_[size_t(cell)];
        edge[std::min(size_t(from_walls_[size_t(next)]), level)].push_back(next);
      });
    }
  }
}

}  // namespace volgi
