#include "propagation/pixel_irradiance_cpu.h"

#include <algorithm>
#include <optional>

#include "propagation/reachable_cells_internal.h"
#include "voxel/seeing_cells.h"

namespace volgi {

namespace {

constexpr float LEAST_WEIGHT = 1e-6f;

class Reader {
 public:
  Reader(const VoxelGrid& voxels, const SideIrradiance& irradiance, glm::vec3 point, glm::vec3 normal)
      : voxels_(voxels), irradiance_(irradiance), point_(point), normal_(normal), low_(glm::floor(point - 0.5f)) {}

  /// The eight cells around, of those that see the point.
  void add_seeing(const SeeingCells& seeing) {
    const glm::vec3 t = point_ - 0.5f - glm::vec3(seeing.low);
    for (int k = 0; k < 8; ++k) {
      if ((seeing.joined >> k & 1u) == 0u) continue;
      const glm::vec3 w = glm::mix(1.0f - t, t, glm::vec3(k & 1, (k >> 1) & 1, k >> 2));
      add(seeing.cell(k), SIMILAR_NORMAL_COSINE, true, w.x * w.y * w.z + LEAST_WEIGHT);
    }
  }
  struct Open {
    glm::ivec3 from;
    Around cells;
  };
  /// All cells within `reach` more, or only those that are open to one of them; nothing where there was something.
  void add_around(float min_cosine, bool check_plane, int reach, const std::optional<Open>& open) {
    if (sum_.weight != 0.0f) return;
    const glm::vec3 t = point_ - 0.5f - low_;
    glm::ivec3 d;
    for (d.z = -reach; d.z <= 1 + reach; ++d.z) {
      for (d.y = -reach; d.y <= 1 + reach; ++d.y) {
        for (d.x = -reach; d.x <= 1 + reach; ++d.x) {
          const glm::ivec3 cell = glm::ivec3(low_) + d;
          if (open && !is_open(*open, cell)) continue;
          const glm::vec3 w = glm::max(1.0f + float(reach) - glm::abs(glm::vec3(d) - t), 0.0f);
          add(cell, min_cosine, check_plane, w.x * w.y * w.z + LEAST_WEIGHT);
        }
      }
    }
  }
  /// From what is alike to whatever is near: a surface too small or too tilted for the grid to show takes what is near,
  /// then what faces its way at all, at last (rims of boards, thin rods) whatever surface is near.
  void add_around_in_turn(const std::optional<Open>& open) {
    add_around(SIMILAR_NORMAL_COSINE, true, 1, open);
    add_around(0.0f, true, 1, open);
    add_around(0.0f, false, 1, open);
  }
  const PixelIrradiance& sum() const { return sum_; }

 private:
  static bool is_open(const Open& open, glm::ivec3 cell) {
    const glm::ivec3 d = cell - open.from;
    return glm::all(glm::lessThanEqual(glm::abs(d), glm::ivec3(1))) && open.cells[around_index(d)];
  }
  /// Sides of one cell, where the point lies in front of every surface that it sees.
  void add(glm::ivec3 cell, float min_cosine, bool check_plane, float weight) {
    if (!shared::cell_inside(voxels_.grid(), cell)) return;
    const glm::uvec2 own = voxels_.cell_sides(cell);
    PixelIrradiance here;
    for (size_t s = own.x; s < own.x + shared::count_bits(own.y & 63u); ++s) {
      const shared::Side& side = voxels_.sides()[s];
      if (check_plane && shared::height_over_side(side, cell, point_) < -1e-3f) return;
      if (glm::dot(side.normal, normal_) < min_cosine) continue;
      const float w = weight * side.area_m2;
      here.direct += w * glm::vec3(irradiance_.direct[s]);
      here.indirect += w * glm::vec3(irradiance_.indirect[s]);
      here.weight += w;
    }
    sum_.direct += here.direct;
    sum_.indirect += here.indirect;
    sum_.weight += here.weight;
  }

  const VoxelGrid& voxels_;
  const SideIrradiance& irradiance_;
  glm::vec3 point_, normal_, low_;
  PixelIrradiance sum_;
};

/// Sums of everything that counts; see volume_gather.glsl for why in this order.
PixelIrradiance gathered(const VoxelGrid& voxels, const SideIrradiance& irradiance, glm::vec3 position,
                         glm::vec3 normal, glm::vec4 viewer) {
  const glm::vec3 to_viewer = glm::normalize(glm::vec3(viewer) - viewer.w * position);
  const glm::vec3 point = shared::cell_from_world(voxels.grid(), position) + 0.5f * normal + 0.02f * to_viewer;
  const glm::vec3 end = glm::vec3(voxels.grid().cells) + 0.25f;
  if (glm::any(glm::lessThan(point, glm::vec3(-0.25f))) || glm::any(glm::greaterThan(point, end))) return {};
  Reader reader(voxels, irradiance, point, normal);
  const glm::vec3 beside = point - (0.5f - 2.0f * HIDDEN_DEPTH) * normal;
  const SeeingCells seeing = seeing_cells(voxels, point, beside, normal);
  if (seeing.nearest >= 0) {
    reader.add_seeing(seeing);
    const glm::ivec3 from = seeing.cell(seeing.nearest);
    if (!shared::cell_inside(voxels.grid(), from)) return reader.sum();  // the dark outside
    if (reader.sum().weight == 0.0f) reader.add_around_in_turn(Reader::Open{from, reachable_cells(voxels, from)});
  }
  reader.add_around_in_turn({});
  reader.add_around(-1.0f, true, 2, {});
  return reader.sum();
}

/// How far inside of a level a place is, in its cells, where other cells lie beyond its rim; more than a few: far.
float from_rim(const VolumeSides& sides, size_t level, glm::vec3 place) {
  const Grid &grid = sides.level(level).grid(), &outermost = sides.level(0).grid();
  const glm::vec3 low = shared::cell_from_world(grid, place), high = glm::vec3(grid.cells) - low;
  // Where the outermost grid begins and ends, in the same cells.
  const glm::vec3 first = shared::cell_from_world(grid, outermost.origin);
  const glm::vec3 last =
      first + glm::vec3(sides.finest_grid().cells) * (sides.finest_grid().cell_size_m / grid.cell_size_m);
  float least = 1e3f;
  for (int axis = 0; axis < 3; ++axis) {
    if (first[axis] < -0.5f) least = std::min(least, low[axis]);
    if (last[axis] > float(grid.cells[axis]) + 0.5f) least = std::min(least, high[axis]);
  }
  return least;
}

}  // namespace

PixelIrradiance irradiance_at_pixel(const VolumeSides& sides, std::span<const SideIrradiance> irradiance,
                                    glm::vec3 position, glm::vec3 normal, glm::vec4 viewer) {
  constexpr float FIRST = 0.25f,
                  LAST = 1.0f;  // cells before the rim; beyond half a cell of the level around it has none
  const size_t level = sides.level_of(position, normal);
  const auto of_level = [&](size_t l) {
    return irradiance_at_pixel(sides.level(l), irradiance[l], position, normal, viewer);
  };
  if (level == 0) return of_level(0);
  const glm::vec3 place = position + 0.5f * sides.level(level).grid().cell_size_m * normal;
  const float share = glm::clamp((from_rim(sides, level, place) - FIRST) / (LAST - FIRST), 0.0f, 1.0f);
  const PixelIrradiance inner = share > 0.0f ? of_level(level) : PixelIrradiance{};
  if (share == 1.0f && inner.weight > 0.0f) return inner;
  const PixelIrradiance around = of_level(level - 1);
  if (inner.weight == 0.0f) return around;
  if (around.weight == 0.0f) return inner;
  return {glm::mix(around.direct, inner.direct, share), glm::mix(around.indirect, inner.indirect, share),
          std::max(around.weight, inner.weight)};
}

PixelIrradiance irradiance_at_pixel(const VoxelGrid& voxels, const SideIrradiance& irradiance, glm::vec3 position,
                                    glm::vec3 normal, glm::vec4 viewer) {
  PixelIrradiance sum = gathered(voxels, irradiance, position, normal, viewer);
  if (sum.weight == 0.0f) return {};
  sum.direct /= sum.weight;
  sum.indirect /= sum.weight;
  return sum;
}

}  // namespace volgi
