#include "propagation/light_in/final_gather_cpu.h"

#include <algorithm>
#include <cstring>
#include <numeric>

#include "core/hash.h"
#include "core/level.h"
#include "propagation/light_in/contact_light_cpu.h"
#include "propagation/light_in/gather_steadied.h"
#include "propagation/light_in/side_start_internal.h"
#include "propagation/reachable_cells_internal.h"
#include "propagation/side_loops.h"

namespace volgi {

namespace {

constexpr int MOST_ITERATIONS = 64;
constexpr double SETTLED = 1e-3;  // change of an iteration over what there is, mean over surfaces

int affordable_rays(size_t sides, int wanted) {
  return std::min(wanted, int(FinalGatherCpu::MOST_RAYS / std::max(sides, size_t(1))));
}

int rays_of_all(size_t sides) { return std::max(affordable_rays(sides, FinalGatherCpu::RAYS_OF_ALL), 1); }

/// All together at most two for each side there is.
int rays_beside(size_t sides, size_t beside) {
  return std::min(FinalGatherCpu::RAYS_BESIDE, int(2 * sides / std::max(beside, size_t(1))));
}

/// Cells that are at most `reach` from one of these along an axis.
std::vector<bool> spread(const Grid& grid, const std::vector<bool>& cells, int axis, int reach) {
  std::vector<bool> out(cells.size(), false);
  const int step = shared::cell_index(grid, glm::ivec3(axis == 0, axis == 1, axis == 2));
  for (size_t i = 0; i < cells.size(); ++i) {
    if (!cells[i]) continue;
    const int at = shared::cell_coord(grid, int(i))[axis];
    const int last = std::min(reach, grid.cells[axis] - 1 - at);
    for (int d = -std::min(reach, at); d <= last; ++d) out[size_t(std::ptrdiff_t(i) + std::ptrdiff_t(d) * step)] = true;
  }
  return out;
}

}  // namespace

void FinalGatherCpu::follow(const VoxelGrid& voxels, const EmbreeScene& embree, std::span<const PassageFace> passages,
                            const std::vector<bool>& seen, int rays) {
  const size_t count = voxels.side_count();
  const bool same =
      count == sides_.size() && std::memcmp(sides_.data(), voxels.sides().data(), count * sizeof(shared::Side)) == 0;
  if (same && seen == seen_ && rays == rays_of_seen_) return;
  const PassageAim aim(passages);
  if (!same) {
    sides_.assign(voxels.sides().begin(), voxels.sides().begin() + std::ptrdiff_t(count));
    std::vector<std::uint32_t> every(count);
    std::iota(every.begin(), every.end(), 0u);
    all_.trace(voxels, embree, aim, every, 0, rays_of_all(count));
    follow_passages(voxels, embree, aim);
  }
  lit_.clear();
  seen_ = seen;
  rays_of_seen_ = rays;
  seen_sides_.clear();
  for (size_t s = 0; s < count; ++s) {
    if (seen[size_t(sides_[s].cell)]) seen_sides_.push_back(std::uint32_t(s));
  }
  const int more = affordable_rays(seen_sides_.size(), rays) - all_.rays();
  more_.trace(voxels, embree, aim, seen_sides_, all_.rays(), std::max(more, 0));
}

void FinalGatherCpu::follow_passages(const VoxelGrid& voxels, const EmbreeScene& embree, const PassageAim& passages) {
  beside_.clear();
  row_beside_.assign(passages.empty() ? 0 : sides_.size(), -1);
  for (size_t s = 0; s < row_beside_.size(); ++s) {
    const glm::vec3 cell(shared::cell_coord(voxels.grid(), sides_[s].cell));
    if (!passages.is_beside(cell + 0.5f)) continue;
    row_beside_[s] = std::int32_t(beside_.size());
    beside_.push_back(std::uint32_t(s));
  }
  constexpr int OTHERS = 1 << 16;  // than those of all sides and of seen ones
  of_beside_.trace(voxels, embree, passages, beside_, OTHERS, rays_beside(sides_.size(), beside_.size()));
}

/// What rays of all sides, and those beside passages, know of one.
Gathered FinalGatherCpu::gathered(size_t side, std::span<const glm::vec3> radiosity) const {
  Gathered g;
  g.add(all_.row(side), radiosity);
  if (!row_beside_.empty() && row_beside_[side] >= 0) g.add(of_beside_.row(size_t(row_beside_[side])), radiosity);
  return g;
}

/// Of all sides, until their light is that of each other's.
void FinalGatherCpu::iterate(const VoxelGrid& voxels, std::span<const glm::vec3> own) {
  const std::vector<shared::Side>& sides = voxels.sides();
  const size_t count = voxels.side_count();
  std::vector<glm::vec3> change(count);
  const auto radiate = [&] {
    for_each_side(count, [&](size_t s) { radiosity_[s] = own[s] + sides[s].albedo * received_[s]; });
  };
  SideSums sums;
  sums.set(voxels, nullptr);
  const glm::dvec3 area = sums([&](size_t s) { return glm::dvec3(double(sides[s].area_m2)); });
  radiate();
  for (report_.iterations = 1;; ++report_.iterations) {
    for_each_side(count, [&](size_t s) {
      const Gathered g = gathered(s, radiosity_);
      const glm::vec3 fresh = g.rays > 0 ? g.mean() : received_[s];
      change[s] = fresh - received_[s];
      received_[s] = fresh;
    });
    radiate();
    // Dark rooms count as bright ones: their light comes last, through gaps.
    const glm::dvec3 changed = sums([&](size_t s) {
      return double(sides[s].area_m2) * glm::dvec3(glm::abs(change[s]) / glm::max(received_[s], 1e-30f));
    });
    if (report_.iterations == MOST_ITERATIONS || glm::all(glm::lessThanEqual(changed, SETTLED * area))) break;
  }
}

/// Of all sides, but for what comes round. Emission's arrival is by rays as well: of tilted surfaces the volume has a
/// part of it in later orders, and only the sum of all is right. Emitters fill sides as they come: flux and area are
/// means.
std::vector<glm::vec3> FinalGatherCpu::radiosity_of(const VoxelGrid& voxels, const Sent& sent) const {
  const std::vector<shared::Side>& sides = voxels.sides();
  const float least_m2 = LEAST_SIDE_AREA * voxels.grid().cell_size_m * voxels.grid().cell_size_m;
  std::vector<glm::vec3> own(voxels.side_count()), emitted(sent.emitted.size());
  for_each_side(emitted.size(), [&](size_t i) {
    float area_m2 = 0.0f;
    for_sides_alike(voxels, i, [&](size_t s) {
      emitted[i] += sent.emitted[s];
      area_m2 += sides[s].area_m2;
    });
    emitted[i] /= std::max(area_m2, least_m2);
  });
  for_each_side(own.size(), [&](size_t s) {
    Gathered arrival;
    if (!emitted.empty()) arrival = gathered(s, emitted);
    own[s] = sent.reflected[s] / std::max(sides[s].area_m2, least_m2) + sides[s].albedo * arrival.mean();
  });
  return own;
}

const std::vector<glm::vec4>& FinalGatherCpu::run(const VoxelGrid& voxels, const EmbreeScene& embree,
                                                  std::span<const PassageFace> passages, const Sent& sent,
                                                  std::span<const glm::vec4> volume, const std::vector<bool>& seen,
                                                  int rays) {
  follow(voxels, embree, passages, seen, rays);
  const size_t count = voxels.side_count();
  radiosity_.resize(count);
  received_.resize(count);
  const std::vector<glm::vec3> own = radiosity_of(voxels, sent);
  for_each_side(count, [&](size_t s) { received_[s] = glm::vec3(volume[s]); });
  iterate(voxels, own);
  std::vector<Gathered> seen_light(count);
  for_each_side(seen_sides_.size(), [&](size_t i) {
    Gathered& g = seen_light[seen_sides_[i]];
    g = gathered(seen_sides_[i], radiosity_);
    if (more_.rays() > 0) g.add(more_.row(i), radiosity_);
  });
  irradiance_ = steadied(voxels, seen_light, volume);
  report_.seen_sides = seen_sides_.size();
  report_.rays = all_.traced() + more_.traced() + of_beside_.traced();
  return irradiance_;
}

void FinalGatherCpu::light_by_lamps(const VoxelGrid& voxels, const EmbreeScene& embree) {
  std::vector<shared::PunctualLight> lamps;
  for (const Light& lamp : embree.scene().lights) lamps.push_back(to_shared(lamp));
  const bool same = !lit_.empty() && lamps.size() == lamps_.size() &&
                    std::memcmp(lamps.data(), lamps_.data(), lamps.size() * sizeof(shared::PunctualLight)) == 0;
  if (same) return;
  lamps_ = std::move(lamps);
  lit_.assign(voxels.side_count(), glm::vec3(0.0f));
  if (lamps_.empty()) return;
  for_each_side(lit_.size(), [&](size_t s) {
    const shared::Side& side = voxels.sides()[s];
    const SideStart start = start_of_side(voxels, embree, side);
    lit_[s] = radiosity_by_lamps(embree, start.origin, side.normal, side.albedo, hash(std::uint32_t(s)));
  });
}

FinalGatherCpu::Near FinalGatherCpu::near_light(const VoxelGrid& voxels, const EmbreeScene& embree) {
  light_by_lamps(voxels, embree);
  const size_t count = voxels.side_count();
  Near near{std::vector<float>(count, 0.0f), std::vector<glm::vec3>(count, glm::vec3(0.0f))};
  std::vector<glm::ivec3> places(count);
  std::vector<glm::vec3> sent(count);
  for_each_side(count, [&](size_t s) {
    places[s] = shared::cell_coord(voxels.grid(), sides_[s].cell);
    sent[s] = radiosity_[s] + lit_[s];
  });
  /// Of one side, by these rays of its.
  struct Parts {
    Gathered close, far;
    glm::vec3 emitted{0.0f}, emitted_through{0.0f};  // far, and behind passages

    int rays() const { return std::max(close.rays + far.rays, 1); }
    glm::vec3 through(glm::vec3 sum) const { return sum / float(std::max(far.rays_through, 1)); }
  };
  const auto add = [&](size_t s, const GatherRows::Row& row, Parts& parts) {
    parts.far.add({{}, row.through}, sent);
    for (const GatherRows::Through& t : row.through) {
      if (t.met.side >= 0) parts.emitted_through += t.weight * sides_[size_t(t.met.side)].radiosity;
    }
    for (const GatherRows::Met& met : row.met) {
      const glm::vec3 away(met.side < 0 ? glm::ivec3(0) : places[size_t(met.side)] - places[s]);
      const bool is_near = met.side >= 0 && glm::dot(away, away) <= float(NEAR_CELLS * NEAR_CELLS);
      (is_near ? parts.close : parts.far).add({{&met, 1}, {}}, sent);
      if (!is_near && met.side >= 0) parts.emitted += sides_[size_t(met.side)].radiosity;
    }
  };
  const auto keep_far = [&](size_t s, const Parts& parts) {
    near.from_far[s] = (parts.far.sum + parts.emitted) / float(parts.rays()) +
                       parts.through(parts.far.sum_through + parts.emitted_through);
  };
  // Paths go on from surfaces beside those that are seen.
  for_each_side(count, [&](size_t s) {
    if (seen_[size_t(sides_[s].cell)]) return;
    Parts parts;
    add(s, all_.row(s), parts);
    keep_far(s, parts);
  });
  std::vector<float> all(seen_sides_.size(), 0.0f);
  for_each_side(seen_sides_.size(), [&](size_t i) {
    const std::uint32_t s = seen_sides_[i];
    Parts parts;
    add(s, all_.row(s), parts);
    if (more_.rays() > 0) add(s, more_.row(i), parts);
    keep_far(s, parts);
    const auto rays = float(parts.rays());
    near.irradiance[s] = level(parts.close.sum) / rays;
    all[i] = sides_[s].area_m2 *
             (level(parts.close.sum + parts.far.sum) / rays + level(parts.through(parts.far.sum_through)));
  });
  double sum = 0.0, area = 0.0;
  for (size_t i = 0; i < all.size(); ++i) {
    sum += double(all[i]);
    area += double(sides_[seen_sides_[i]].area_m2);
  }
  near.mean = area > 0.0 ? float(sum / area) : 0.0f;
  return near;
}

size_t FinalGatherCpu::bytes() const {
  return all_.bytes() + more_.bytes() + of_beside_.bytes() + beside_.capacity() * sizeof(std::uint32_t) +
         row_beside_.capacity() * sizeof(std::int32_t) + lit_.capacity() * sizeof(glm::vec3) +
         sides_.capacity() * sizeof(shared::Side) + seen_.size() / 8 + seen_sides_.capacity() * sizeof(std::uint32_t) +
         (radiosity_.capacity() + received_.capacity()) * sizeof(glm::vec3) +
         irradiance_.capacity() * sizeof(glm::vec4);
}

size_t FinalGatherCpu::bytes_for(const Grid& grid, size_t sides, int rays) {
  if (cell_count(grid) > MOST_CELLS) return 0;
  const int all = rays_of_all(sides), more = std::max(affordable_rays(sides, rays) - all, 0);
  const size_t a_side = sizeof(shared::Side) + 2 * sizeof(std::uint32_t) + sizeof(std::int32_t) +
                        3 * sizeof(glm::vec3) + 3 * sizeof(glm::vec4);
  return sides * a_side + cell_count(grid) / 8 + GatherRows::most_bytes(sides, all) +
         GatherRows::most_bytes(sides, more) + GatherRows::most_bytes(sides, 2);
}

std::vector<bool> cells_seen(const Grid& grid, std::span<const glm::vec4> positions) {
  constexpr int REACH = 3;  // pixels read cells beside their own, or beside those; a mean is over one more
  std::vector<bool> cells(cell_count(grid), false);
  const glm::vec3 last(grid.cells - 1);
  for (const glm::vec4& p : positions) {
    if (p.w == 0.0f) continue;
    const glm::vec3 at = glm::clamp(shared::cell_from_world(grid, glm::vec3(p)), glm::vec3(0.0f), last);
    cells[size_t(shared::cell_index(grid, glm::ivec3(at)))] = true;
  }
  for (int axis = 0; axis < 3; ++axis) cells = spread(grid, cells, axis, REACH);
  return cells;
}

}  // namespace volgi
