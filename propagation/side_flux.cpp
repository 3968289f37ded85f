#include "propagation/side_flux.h"

#include <algorithm>

#include "propagation/side_loops.h"
#include "voxel/seeing_cells.h"
#include "voxel/side_search.h"

namespace volgi {

namespace {

/// Where a sample goes: up to three sides, with shares that sum to 1; none when all sides are far.
struct Target {
  glm::ivec3 sides{-1};
  glm::vec3 shares{0.0f};
};

/// The side of the 5^3 cells around a point that is nearest and faces most alike: by the cosine between the normals
/// less the distance in cells; those that face the surface's way, of cells that reach in front of it, before all others
/// (what is smaller than a cell may have no other), and before those the sides of cells to which
/// the point's light comes. -1: there is none, or the surface is the grid's rim and looks out:
/// what a roof there reflects leaves the scene and is not for the room below.
int any_side_near(const VoxelGrid& voxels, glm::vec3 world_position, glm::vec3 normal) {
  const glm::vec3 point = shared::cell_from_world(voxels.grid(), world_position);
  const float reach = DEPOSIT_REACH * shared::staircase_factor(normal);
  if (!shared::cell_inside(voxels.grid(), glm::ivec3(glm::floor(point + reach * normal)))) return -1;
  const glm::ivec3 seeing = seeing_cell(voxels, point, normal);
  // What sees the point is outside: its own surface goes on in the grid, or nothing does.
  const bool at_rim = !shared::cell_inside(voxels.grid(), seeing);
  const glm::ivec3 centre(glm::floor(point));
  const glm::ivec3 first = glm::max(centre - 2, 0);
  const glm::ivec3 last = glm::min(centre + 2, voxels.grid().cells - 1);
  int best = -1;
  float best_score = 0.0f;
  glm::ivec3 c;
  for (c.z = first.z; c.z <= last.z; ++c.z) {
    for (c.y = first.y; c.y <= last.y; ++c.y) {
      for (c.x = first.x; c.x <= last.x; ++c.x) {
        const glm::vec3 to_centre = glm::vec3(c) + 0.5f - point;
        const bool in_front = glm::dot(to_centre, normal) > -reach;
        const glm::uvec2 own = voxels.cell_sides(c);
        const int count = int(shared::count_bits(own.y & 63u));
        if (count == 0) continue;
        const bool hidden = hidden_from_cell(voxels, c, point, normal);
        const bool seen = !hidden && open_way(voxels, seeing, c);
        for (int side = int(own.x); side < int(own.x) + count; ++side) {
          const float cosine = glm::dot(voxels.sides()[size_t(side)].normal, normal);
          if (at_rim && (hidden || cosine < SIMILAR_NORMAL_COSINE)) continue;
          const float score = cosine - glm::length(to_centre) + (in_front && cosine > 0.0f ? DEPOSIT_FIRST : 0.0f) +
                              (seen ? DEPOSIT_SEEN : 0.0f);
          if (best >= 0 && score <= best_score) continue;
          best = side;
          best_score = score;
        }
      }
    }
  }
  return best;
}

Target target_of(const VoxelGrid& voxels, const FluxSample& sample) {
  const SidesOfPoint found = sides_of_point(voxels, sample.position, sample.normal, -1);
  if (found.weights != glm::vec3(0.0f)) return {found.sides, found.weights};
  return {{any_side_near(voxels, sample.position, sample.normal), -1, -1}, {1.0f, 0.0f, 0.0f}};
}

/// Flux that found no side, over all ranks the same for any number of them.
class Lost {
 public:
  void add(glm::dvec3 flux) {
    for (size_t band = 0; band < 3; ++band) sums_[band].add(flux[int(band)]);
  }
  glm::dvec3 value(const Ranks* ranks) { return SideSums::over_ranks(sums_, ranks); }

 private:
  std::array<ExactSum, 3> sums_;
};

/// What a sample gives a side.
struct Given {
  std::uint64_t number;  // of the sample
  int k;                 // of its sides
  int cell, face;
  glm::dvec3 flux;
};

/// All samples in this rank's cells, in order. What lies outside of the grid goes with the cells at its rim.
std::vector<NumberedFluxSample> samples_of_part(const VoxelGrid& voxels, const RanksOfVolume& ranks,
                                                std::span<const NumberedFluxSample> samples) {
  std::vector<std::vector<NumberedFluxSample>> to(size_t(ranks.ranks.count()));
  for (const NumberedFluxSample& s : samples) {
    const glm::vec3 point = shared::cell_from_world(voxels.grid(), s.sample.position);
    const glm::ivec3 cell(glm::clamp(glm::floor(point), glm::vec3(0.0f), glm::vec3(voxels.grid().cells - 1)));
    to[size_t(ranks.decomposition.owner(cell / kLeafCells))].push_back(s);
  }
  std::vector<NumberedFluxSample> here;
  for (const auto& from : exchange_values(ranks.ranks, to)) here.insert(here.end(), from.begin(), from.end());
  std::sort(here.begin(), here.end(), [](const auto& a, const auto& b) { return a.number < b.number; });
  return here;
}

void deposit_in_grid(const VoxelGrid& voxels, std::span<const FluxSample> samples, std::span<glm::vec4> flux,
                     glm::vec3& lost) {
  std::vector<Target> targets(samples.size());
  for_each_side(samples.size(), [&](size_t i) { targets[i] = target_of(voxels, samples[i]); });
  // Sides may get thousands of samples each: sums are double.
  std::vector<glm::dvec3> sums(flux.size(), glm::dvec3(0.0));
  Lost found_none;
  for (size_t i = 0; i < samples.size(); ++i) {
    for (int k = 0; k < 3; ++k) {
      if (targets[i].shares[k] <= 0.0f) continue;
      const int side = targets[i].sides[k];
      const glm::dvec3 given = double(targets[i].shares[k]) * glm::dvec3(samples[i].flux);
      if (side < 0) {
        found_none.add(given);
      } else {
        sums[size_t(side)] += given;
      }
    }
  }
  for_each_side(flux.size(), [&](size_t i) { flux[i] += glm::vec4(sums[i], 0.0f); });
  lost += glm::vec3(found_none.value(nullptr));
}

}  // namespace

void deposit(const VolumeSides& sides, std::span<const FluxSample> samples, std::span<glm::vec4> flux,
             glm::vec3& lost) {
  if (sides.levels() == 1) {
    deposit_in_grid(sides.level(0), samples, flux, lost);
    return;
  }
  std::vector<std::vector<FluxSample>> of_level(sides.levels());
  for (const FluxSample& s : samples) of_level[sides.level_of(s.position, s.normal)].push_back(s);
  for (size_t level = 0; level < sides.levels(); ++level)
    deposit_in_grid(sides.level(level), of_level[level], sides.of_level(flux, level), lost);
}

void deposit(const VoxelGrid& voxels, const RanksOfVolume& ranks, std::span<const NumberedFluxSample> samples,
             std::span<glm::vec4> flux, glm::vec3& lost) {
  const std::vector<NumberedFluxSample> here = samples_of_part(voxels, ranks, samples);
  std::vector<Target> targets(here.size());
  for_each_side(here.size(), [&](size_t i) { targets[i] = target_of(voxels, here[i].sample); });
  std::vector<std::vector<Given>> to(size_t(ranks.ranks.count()));
  Lost found_none;
  for (size_t i = 0; i < here.size(); ++i) {
    for (int k = 0; k < 3; ++k) {
      if (targets[i].shares[k] <= 0.0f) continue;
      const glm::dvec3 given = double(targets[i].shares[k]) * glm::dvec3(here[i].sample.flux);
      if (targets[i].sides[k] < 0) {
        found_none.add(given);
        continue;
      }
      const shared::Side& side = voxels.sides()[size_t(targets[i].sides[k])];
      const glm::ivec3 block = shared::cell_coord(voxels.grid(), side.cell) / kLeafCells;
      to[size_t(ranks.decomposition.owner(block))].push_back({here[i].number, k, side.cell, side.face, given});
    }
  }
  std::vector<Given> all;
  for (const auto& from : exchange_values(ranks.ranks, to)) all.insert(all.end(), from.begin(), from.end());
  std::sort(all.begin(), all.end(),
            [](const Given& a, const Given& b) { return a.number != b.number ? a.number < b.number : a.k < b.k; });
  std::vector<glm::dvec3> sums(flux.size(), glm::dvec3(0.0));
  for (const Given& g : all)
    sums[shared::side_index(voxels.cell_sides(shared::cell_coord(voxels.grid(), g.cell)), g.face)] += g.flux;
  for_each_side(flux.size(), [&](size_t i) { flux[i] += glm::vec4(sums[i], 0.0f); });
  lost += glm::vec3(found_none.value(&ranks.ranks));
}

}  // namespace volgi
