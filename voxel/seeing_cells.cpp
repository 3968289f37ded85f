#include "voxel/seeing_cells.h"

#include <algorithm>
#include <limits>

namespace volgi {

namespace {

constexpr int kOpenWaySteps = 16;  // OPEN_WAY_STEPS
constexpr std::array<unsigned, 3> kLowCorners{0x55u, 0x33u, 0x0fu};

/// Which sides a cell has; none outside of the grid.
glm::uvec2 sides_in(const VoxelGrid& voxels, glm::ivec3 cell) {
  return shared::cell_inside(voxels.grid(), cell) ? voxels.cell_sides(cell) : glm::uvec2(0u);
}

/// What the sides of a cell say of the point: -1 that one hides it; 1 that it is in front of one towards another of the
/// eight; 0 nothing.
int corner_sees(const VoxelGrid& voxels, glm::ivec3 cell, glm::uvec2 own, int corner, glm::vec3 point,
                glm::vec3 normal) {
  int sees = 0;
  const std::uint32_t last = own.x + shared::count_bits(own.y & 63u);
  for (std::uint32_t s = own.x; s < last; ++s) {
    const shared::Side& side = voxels.sides()[s];
    if (shared::side_hides(side, cell, point, normal)) return -1;
    const bool inner = (side.face & 1) != ((corner >> (side.face >> 1)) & 1);
    if (inner && side.coverage == 1.0f && glm::dot(side.normal, normal) < SIMILAR_NORMAL_COSINE &&
        shared::height_over_side(side, cell, point) > 0.0f)
      sees = 1;
  }
  return sees;
}

}  // namespace

SeeingCells seeing_cells(const VoxelGrid& voxels, glm::vec3 around, glm::vec3 point, glm::vec3 normal) {
  SeeingCells c{glm::ivec3(glm::floor(around - 0.5f))};
  std::array<unsigned, 3> closed{};  // bits of the two corners on either side of a closed face
  std::array<float, 8> squared{};
  unsigned unhidden = 0;
  float best = std::numeric_limits<float>::max();
  for (int k = 0; k < 8; ++k) {
    const glm::ivec3 cell = c.cell(k);
    const glm::uvec2 own = sides_in(voxels, cell);
    for (int axis = 0; axis < 3; ++axis) {
      if (shared::is_opaque(own, 2 * axis + 1 - ((k >> axis) & 1)))
        closed[size_t(axis)] |= 1u << k | 1u << (k ^ (1 << axis));
    }
    const glm::vec3 centre = glm::vec3(cell) + 0.5f, d = centre - around;
    squared[size_t(k)] = glm::dot(d, d);
    if (glm::dot(centre - point, normal) < -SEEING_BEHIND) continue;
    const int sees = corner_sees(voxels, cell, own, k, point, normal);
    if (sees < 0) continue;
    unhidden |= 1u << k;
    const float score = squared[size_t(k)] - SEEING_FIRST * float(sees);
    if (score >= best) continue;
    best = score;
    c.nearest = k;
  }
  if (c.nearest < 0) return c;
  c.joined = 1u << c.nearest;
  for (int step = 0; step < 3; ++step) {
    for (int axis = 0; axis < 3; ++axis) {
      const unsigned crossing = c.joined & ~closed[size_t(axis)], low = kLowCorners[size_t(axis)];
      c.joined |= ((crossing & low) << (1 << axis)) | ((crossing & ~low) >> (1 << axis));
    }
  }
  best = std::numeric_limits<float>::max();
  for (int k = 0; k < 8; ++k) {
    if (((c.joined & unhidden) >> k & 1u) == 0 || squared[size_t(k)] >= best) continue;
    best = squared[size_t(k)];
    c.nearest = k;
  }
  return c;
}

glm::ivec3 seeing_cell(const VoxelGrid& voxels, glm::vec3 point, glm::vec3 normal) {
  const SeeingCells c = seeing_cells(voxels, point + 0.5f * normal, point + 2.0f * HIDDEN_DEPTH * normal, normal);
  return c.nearest >= 0 ? c.cell(c.nearest) : glm::ivec3(glm::floor(point));
}

bool hidden_from_cell(const VoxelGrid& voxels, glm::ivec3 cell, glm::vec3 point, glm::vec3 normal) {
  const glm::uvec2 own = voxels.cell_sides(cell);
  const auto first = voxels.sides().begin() + own.x;
  return std::any_of(first, first + shared::count_bits(own.y & 63u),
                     [&](const shared::Side& side) { return shared::side_hides(side, cell, point, normal); });
}

bool open_way(const VoxelGrid& voxels, glm::ivec3 from, glm::ivec3 to) {
  if (!shared::cell_inside(voxels.grid(), from)) return false;
  for (int step = 0; step < kOpenWaySteps && from != to; ++step) {
    const glm::ivec3 left = to - from;
    const glm::uvec2 faces = voxels.cell_sides(from);
    int best = -1;
    for (int axis = 0; axis < 3; ++axis) {
      const bool longer = left[axis] != 0 && (best < 0 || std::abs(left[axis]) > std::abs(left[best]));
      if (longer && !shared::is_opaque(faces, shared::face_of(axis, left[axis] > 0))) best = axis;
    }
    if (best < 0) return false;
    from[best] += left[best] > 0 ? 1 : -1;
  }
  return true;
}

}  // namespace volgi
