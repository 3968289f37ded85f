#include "voxel/cascade_voxels.h"

#include <algorithm>
#include <map>
#include <optional>
#include <tuple>

#include "voxel/voxelize_cpu.h"
#include "voxel/white_pockets.h"

namespace volgi {

namespace {

using shared::Side;

// Cells: each grid rounds vertices by 1/768 of its own cells, so what lies so near to a surface may be behind it.
constexpr float BEHIND = 3e-3f;

/// A grid of a cascade, and where it lies in the larger one that was voxelized for it, so that faces at its rim and
/// surfaces near it are as they would be inside of a grid.
struct WithSurroundings {
  VoxelGrid voxels;
  glm::ivec3 offset{0};  // cells
};

float plane_area(const Side& side) { return side.face_m2 / shared::staircase_factor(side.normal); }

/// Of some cells and faces what becomes of their side; none: it goes.
using Edits = std::map<std::pair<int, int>, std::optional<Side>>;  // by cell and face

const Side* side_of(const VoxelGrid& voxels, glm::ivec3 cell, int face) {
  const glm::uvec2 own = voxels.cell_sides(cell);
  return shared::has_side(own, face) ? &voxels.sides()[shared::side_index(own, face)] : nullptr;
}

/// The same surface as seen from its other side.
Side turned_over(Side side) {
  side.normal = -side.normal;
  side.front = 1 - side.front;
  return side;
}

/// A surface that another grid shows as a side of a cell's face. @param on_surface  a point of it [m].
Side on_face(Side surface, glm::vec3 on_surface, const Grid& grid, glm::ivec3 cell, int face) {
  const int axis = shared::face_axis(face);
  const float at_face = float(cell[axis] + (face & 1));
  glm::vec3 middle = glm::vec3(cell) + 0.5f;
  middle[axis] = at_face;
  const glm::vec3 from = shared::cell_from_world(grid, on_surface) - middle;
  const float along = surface.normal[axis];
  const float depth = std::abs(along) > 1e-3f ? glm::dot(from, surface.normal) / along : 0.0f;
  surface.depth = at_face + std::clamp(depth, -0.5f, 0.5f);
  surface.cell = shared::cell_index(grid, cell);
  surface.face = face;
  surface.radiosity = glm::vec3(0.0f);  // emission is where the surface is
  return surface;
}

glm::vec3 point_of(const VoxelGrid& voxels, const Side& side) {
  glm::vec3 at = glm::vec3(shared::cell_coord(voxels.grid(), side.cell)) + 0.5f;
  at[shared::face_axis(side.face)] = side.depth;
  return shared::world_from_cell(voxels.grid(), at);
}

/// @param before  the coverage that its area goes with; 0: it has none yet.
void set_coverage(Side& side, float coverage, float cell_size_m, float before) {
  side.coverage = coverage;
  side.face_m2 = coverage * cell_size_m * cell_size_m;
  side.area_m2 = before > 0.0f ? side.area_m2 * coverage / before : plane_area(side);
  side.area_m2 = std::max(side.area_m2, SIDE_MIN_FILL * plane_area(side));
}

/// The opaque side of a cell that has the point farthest behind it, or null. All in cells of the grid.
const Side* hiding(const VoxelGrid& voxels, glm::ivec3 cell, glm::vec3 point) {
  const glm::uvec2 own = voxels.cell_sides(cell);
  const Side* found = nullptr;
  float least = BEHIND;
  for (std::uint32_t s = own.x; s < own.x + shared::count_bits(own.y & 63u); ++s) {
    const Side& side = voxels.sides()[s];
    const float height = shared::height_over_side(side, cell, point);
    if (side.coverage < 1.0f || height >= least) continue;
    least = height;
    found = &side;
  }
  return found;
}

/// What the cell beyond a side's face sees of the same surface.
Side from_behind(const VoxelGrid& voxels, const Side& side) {
  const glm::ivec3 beyond = shared::cell_coord(voxels.grid(), side.cell) + shared::face_step(side.face);
  const bool inside = shared::cell_inside(voxels.grid(), beyond);
  const Side* there = inside ? side_of(voxels, beyond, shared::opposite_face(side.face)) : nullptr;
  return there != nullptr ? *there : turned_over(side);
}

/// One cell outside a grid, and the faces of those inside that it meets.
class Rim {
 public:
  Rim(const Cascade& cascade, size_t level, const std::vector<WithSurroundings>& grids, std::vector<Edits>& edits)
      : ratio_(cascade.ratio),
        outer_(grids[level].voxels),
        inner_(grids[level + 1].voxels),
        outer_offset_(grids[level].offset),
        inner_offset_(grids[level + 1].offset),
        outer_edits_(edits[level]),
        inner_edits_(edits[level + 1]) {}

  /// @param cell, first  of for_each_cell_at_rim.
  void join(glm::ivec3 cell, int face, glm::ivec3 first) {
    const int axis = shared::face_axis(face), b = shared::axis_b(axis), c = shared::axis_c(axis);
    cell_ = cell + outer_offset_;
    face_ = face;
    seen_.reset();
    float stopped = 0.0f;
    for (int k = 0; k < ratio_ * ratio_; ++k) {
      glm::ivec3 fine = first + inner_offset_;
      fine[b] += k % ratio_;
      fine[c] += k / ratio_;
      stopped += join_fine(fine);
    }
    const float coverage = stopped / float(ratio_ * ratio_);
    const Side* own = side_of(outer_, cell_, face);
    if (coverage == 0.0f) {
      if (own != nullptr) outer_edits_[{own->cell, face}] = std::nullopt;
      return;
    }
    Side side = own != nullptr ? *own : *seen_;
    set_coverage(side, coverage, outer_.grid().cell_size_m, own != nullptr ? own->coverage : 0.0f);
    outer_edits_[{side.cell, face}] = side;
  }

 private:
  /// @return  what the fine cell's face stops.
  float join_fine(glm::ivec3 fine) {
    const int back = shared::opposite_face(face_);
    const glm::ivec3 beyond = fine + shared::face_step(back);  // in the outer cell
    const Side* own = side_of(inner_, fine, back);
    const glm::vec3 middle = in_other(inner_.grid(), outer_.grid(), glm::vec3(beyond) + 0.5f);
    const glm::vec3 outer_middle = in_other(outer_.grid(), inner_.grid(), glm::vec3(cell_) + 0.5f);
    const Side* near_outer = hiding(outer_, cell_, middle);
    const Side* near_inner = near_outer == nullptr ? hiding(inner_, beyond, outer_middle) : nullptr;
    if (near_outer == nullptr && near_inner == nullptr) {
      if (own == nullptr) return 0.0f;
      if (!seen_) see(from_behind(inner_, *own), inner_, *own);
      return std::min(own->coverage, 1.0f);
    }
    if (near_outer != nullptr) {
      see(*near_outer, outer_, *near_outer);
    } else {
      see(from_behind(inner_, *near_inner), inner_, *near_inner);
    }
    if (own != nullptr && own->coverage >= 1.0f) return 1.0f;
    Side side =
        own != nullptr ? *own
        : near_outer != nullptr
            ? on_face(from_behind(outer_, *near_outer), point_of(outer_, *near_outer), inner_.grid(), fine, back)
            : on_face(*near_inner, point_of(inner_, *near_inner), inner_.grid(), fine, back);
    set_coverage(side, 1.0f, inner_.grid().cell_size_m, own != nullptr ? own->coverage : 0.0f);
    inner_edits_[{side.cell, back}] = side;
    return 1.0f;
  }

  /// The outer cell sees this surface through its face. @param place  a side that shows where it is, of `grid`.
  void see(const Side& surface, const VoxelGrid& grid, const Side& place) {
    seen_ = on_face(surface, point_of(grid, place), outer_.grid(), cell_, face_);
  }
  static glm::vec3 in_other(const Grid& from, const Grid& to, glm::vec3 point) {
    return shared::cell_from_world(to, shared::world_from_cell(from, point));
  }

  int ratio_;
  const VoxelGrid &outer_, &inner_;
  glm::ivec3 outer_offset_, inner_offset_;
  Edits &outer_edits_, &inner_edits_;
  glm::ivec3 cell_{0};  // the outer one
  int face_ = 0;
  std::optional<Side> seen_;  // a surface that it looks at through the face
};

/// A grid of a cascade with its sides after all of that, in the order of its blocks.
VoxelGrid cut_out(const WithSurroundings& from, const Grid& grid, const Edits& edits, const BlockBox& covered) {
  const Grid& around = from.voxels.grid();
  struct Placed {
    int block, cell;
    Side side;
  };
  std::vector<Placed> placed;
  placed.reserve(from.voxels.side_count());
  const auto place = [&](Side side) {
    const glm::ivec3 cell = shared::cell_coord(around, side.cell) - from.offset;
    const glm::ivec3 block = cell >> kLeafShift;
    if (!shared::cell_inside(grid, cell) || covered.contains(block)) return;
    side.cell = shared::cell_index(grid, cell);
    side.depth -= float(from.offset[shared::face_axis(side.face)]);
    placed.push_back({block_index(leaf_blocks(grid), block), leaf_offset(cell), side});
  };
  for (const Side& side : from.voxels.sides()) {
    if (edits.find({side.cell, side.face}) == edits.end()) place(side);
  }
  for (const auto& [where, side] : edits) {
    if (side) place(*side);
  }
  std::sort(placed.begin(), placed.end(), [](const Placed& a, const Placed& b) {
    return std::tie(a.block, a.cell, a.side.face) < std::tie(b.block, b.cell, b.side.face);
  });
  std::vector<Side> sides;
  sides.reserve(placed.size());
  for (const Placed& p : placed) sides.push_back(p.side);
  return VoxelGrid(grid, std::move(sides));
}

/// A level's grid with a block more on every side where it does not end with the outermost one.
Grid with_surroundings(const Cascade& cascade, size_t level, glm::ivec3& offset) {
  Grid grid = cascade.grids[level];
  if (level == 0) return grid;
  const Grid& outermost = cascade.grids.front();
  const glm::vec3 first = shared::cell_from_world(outermost, grid.origin);
  const glm::vec3 last = first + glm::vec3(grid.cells) * (grid.cell_size_m / outermost.cell_size_m);
  constexpr float ROUNDING = 0.01f;
  for (int axis = 0; axis < 3; ++axis) {
    if (first[axis] > ROUNDING) offset[axis] = kLeafCells;
    grid.cells[axis] += offset[axis] + (last[axis] < float(outermost.cells[axis]) - ROUNDING ? kLeafCells : 0);
  }
  grid.origin -= glm::vec3(offset) * grid.cell_size_m;
  return grid;
}

}  // namespace

std::vector<VoxelGrid> voxelize_cascade(const Scene& scene, const Cascade& cascade, const Mipmaps& mipmaps,
                                        size_t* pocket_cells) {
  std::vector<WithSurroundings> grids(cascade.levels());
  for (size_t level = 0; level < cascade.levels(); ++level) {
    const Grid grid = with_surroundings(cascade, level, grids[level].offset);
    grids[level].voxels = voxelize_cpu(scene, grid, mipmaps);
    if (pocket_cells != nullptr) *pocket_cells += bound_white_pockets(grids[level].voxels);
  }
  std::vector<Edits> edits(cascade.levels());
  for (size_t level = 0; level + 1 < cascade.levels(); ++level) {
    Rim rim(cascade, level, grids, edits);
    for_each_cell_at_rim(cascade, level,
                         [&](glm::ivec3 cell, int face, glm::ivec3 fine) { rim.join(cell, face, fine); });
  }
  std::vector<VoxelGrid> levels;
  for (size_t level = 0; level < cascade.levels(); ++level) {
    if (cascade.levels() == 1) {
      levels.push_back(std::move(grids[level].voxels));
    } else {
      levels.push_back(cut_out(grids[level], cascade.grids[level], edits[level], cascade.inside[level]));
    }
  }
  return levels;
}

}  // namespace volgi
