#include "propagation/light_in/narrow_passages.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <map>

#include "core/hash.h"
#include "core/visibility/diffuse_path_internal.h"
#include "core/visibility/even_direction_internal.h"
#include "voxel/rooms.h"

namespace volgi {

namespace {

constexpr int WAY = 6;                          // cells from a passage to where paths end, at least
constexpr size_t MOST_CELLS = size_t(1) << 23;  // 6 bytes each while it looks; gaps of large grids are many cells wide
constexpr int NEAR = 4;                         // cells between parts of one passage, at most
constexpr size_t PATHS = 1 << 15, PATHS_AT_ONCE = 1 << 11;
constexpr size_t FEWEST_PASS = 64;  // paths, for a factor to mean anything
// What passages add must be lost elsewhere, or bounces have no end: a room gets back at most this part of what its
// walls take; and light that goes to and fro in a gap passes it at each turn.
constexpr double GAINED = 0.25;
constexpr float LARGEST_FACTOR = 1.75f;

float mean(glm::vec3 v) { return (v.x + v.y + v.z) / 3.0f; }

/// A free face: the cell below it, and its axis.
using Face = std::pair<int, int>;

struct Passage {
  std::pair<int, int> rooms;
  std::vector<Face> faces;  // ascending
};

/// Between cells of two rooms. A face that stops a part of light has a side, and that part right.
std::map<std::pair<int, int>, std::vector<Face>> faces_by_rooms(const VoxelGrid& voxels, const Rooms& rooms) {
  std::map<std::pair<int, int>, std::vector<Face>> faces;
  for (int cell = 0; cell < int(rooms.cells()); ++cell) {
    const int room = rooms.of(cell);
    for (int axis = 0; axis < 3 && room >= 0; ++axis) {
      const int next = rooms.beyond(cell, 2 * axis + 1), other = next >= 0 ? rooms.of(next) : -1;
      if (other < 0 || other == room) continue;
      const glm::uvec2 sides = voxels.cell_sides(shared::cell_coord(voxels.grid(), cell));
      if (!shared::has_side(sides, 2 * axis + 1)) faces[std::minmax(room, other)].push_back({cell, axis});
    }
  }
  return faces;
}

/// Of the faces between two rooms those belong together whose cells are near each other.
std::vector<std::vector<Face>> connected(const Grid& grid, const std::vector<Face>& faces) {
  std::map<int, std::vector<size_t>> at;
  for (size_t i = 0; i < faces.size(); ++i) at[faces[i].first].push_back(i);
  std::vector<bool> taken(faces.size());
  std::vector<std::vector<Face>> groups;
  constexpr int wide = 2 * NEAR + 1;
  for (size_t first = 0; first < faces.size(); ++first) {
    if (taken[first]) continue;
    std::vector<size_t> met{first};
    taken[first] = true;
    groups.emplace_back();
    for (size_t k = 0; k < met.size(); ++k) {
      groups.back().push_back(faces[met[k]]);
      const glm::ivec3 cell = shared::cell_coord(grid, faces[met[k]].first);
      for (int n = 0; n < wide * wide * wide; ++n) {
        const glm::ivec3 near = cell + glm::ivec3(n % wide, n / wide % wide, n / wide / wide) - NEAR;
        if (!shared::cell_inside(grid, near)) continue;
        const auto there = at.find(shared::cell_index(grid, near));
        if (there == at.end()) continue;
        for (const size_t i : there->second) {
          if (!taken[i]) met.push_back(i);
          taken[i] = true;
        }
      }
    }
  }
  return groups;
}

std::vector<Passage> passages_between(const VoxelGrid& voxels, const Rooms& rooms) {
  std::vector<Passage> passages;
  for (const auto& [between, faces] : faces_by_rooms(voxels, rooms)) {
    for (std::vector<Face>& group : connected(voxels.grid(), faces)) {
      std::sort(group.begin(), group.end());
      passages.push_back({between, std::move(group)});
    }
  }
  return passages;
}

/// Paths of diffuse light around one passage: what of them gets from one room into another between triangles, and what
/// in cells.
class Paths {
 public:
  Paths(const VoxelGrid& voxels, const EmbreeScene& embree, const Rooms& rooms, const Passage& passage)
      : voxels_(voxels), embree_(embree), rooms_(rooms), passage_(passage) {
    const Grid& grid = voxels.grid();
    low_ = grid.cells;
    high_ = glm::ivec3(0);
    for (const auto& [cell, axis] : passage.faces) {
      const glm::ivec3 at = shared::cell_coord(grid, cell);
      low_ = glm::min(low_, at - WAY);
      high_ = glm::max(high_, at + WAY + 1);
    }
    low_ = glm::max(low_, 0);
    high_ = glm::min(high_, grid.cells);
    find_starts();
  }

  /// That makes cells let through what triangles do; 1 where too few paths pass to tell.
  float factor() const {
    if (starts_.empty()) return 1.0f;
    std::vector<Sums> sums(PATHS / PATHS_AT_ONCE);
    tbb::parallel_for(size_t(0), sums.size(), [&](size_t part) {
      for (size_t k = 0; k < PATHS_AT_ONCE; ++k) follow(std::uint32_t(part * PATHS_AT_ONCE + k), sums[part]);
    });
    Sums all;
    for (const Sums& s : sums) all.add(s);
    if (all.passed_in_cells < FEWEST_PASS) return 1.0f;
    float low = 0.0f, high = LARGEST_FACTOR;
    for (int i = 0; i < 24; ++i) {
      const float middle = 0.5f * (low + high);
      (all.in_cells(middle) < all.in_truth ? low : high) = middle;
    }
    return 0.5f * (low + high);
  }

 private:
  static constexpr size_t MOST_CROSSED = 16;
  static constexpr int MOST_SURFACES = 16;  // of both kinds of paths alike: 7 % of a path is left where albedo is 0.85
  struct Sums {
    double in_truth = 0.0;
    std::array<double, MOST_CROSSED> by_crossed{};  // in cells, by how many of the faces were crossed
    size_t passed_in_cells = 0;

    void add(const Sums& s) {
      in_truth += s.in_truth;
      for (size_t i = 0; i < MOST_CROSSED; ++i) by_crossed[i] += s.by_crossed[i];
      passed_in_cells += s.passed_in_cells;
    }
    double in_cells(double factor) const {
      double sum = 0.0, power = 1.0;
      for (const double weight : by_crossed) {
        sum += weight * power;
        power *= factor;
      }
      return sum;
    }
  };

  bool of_passage(int room) const { return room == passage_.rooms.first || room == passage_.rooms.second; }

  /// Cells of its two rooms around the passage, not beside a wall: whose inside lies in the room for certain.
  void find_starts() {
    glm::ivec3 c;
    for (c.z = low_.z; c.z < high_.z; ++c.z) {
      for (c.y = low_.y; c.y < high_.y; ++c.y) {
        for (c.x = low_.x; c.x < high_.x; ++c.x) {
          const int cell = shared::cell_index(voxels_.grid(), c);
          if (!of_passage(rooms_.of(cell))) continue;
          if (rooms_.from_walls(cell) > 1) starts_.push_back(cell);
        }
      }
    }
  }

  /// Distance at which a ray from inside leaves the cells around.
  float distance_out(glm::vec3 from, glm::vec3 way) const {
    const glm::vec3 ahead = glm::mix(glm::vec3(low_), glm::vec3(high_), glm::greaterThan(way, glm::vec3(0.0f)));
    const glm::vec3 t = (ahead - from) / way;
    return std::max(0.0f, std::min({t.x, t.y, t.z}));
  }
  /// Of the cell, or of one beside it.
  int room_near(glm::vec3 point) const {
    const glm::ivec3 cell(glm::floor(point));
    int found = -1;
    for (int n = 0; n < 27; ++n) {
      const glm::ivec3 at = n == 0 ? cell : cell + glm::ivec3(n % 3, n / 3 % 3, n / 9) - 1;
      if (!shared::cell_inside(voxels_.grid(), at)) continue;
      const int room = rooms_.of(shared::cell_index(voxels_.grid(), at));
      if (n == 0 && room >= 0) return room;
      if (found < 0) found = room;
    }
    return found;
  }

  void follow(std::uint32_t k, Sums& sums) const {
    const glm::vec3 in_cell(float(3639409837u * k >> 8) * 0x1p-24f, float(2882110345u * k >> 8) * 0x1p-24f,
                            float(2282420713u * k >> 8) * 0x1p-24f);
    const int start = starts_[size_t(std::uint64_t(2654435769u * k) * starts_.size() >> 32)];
    const glm::vec3 from = glm::vec3(shared::cell_coord(voxels_.grid(), start)) + in_cell;
    const int room = rooms_.of(start);
    sums.in_truth += passed_in_truth(from, room, k);
    follow_cells(from, room, k, sums);
  }

  double passed_in_truth(glm::vec3 from, int room, std::uint32_t k) const {
    const Grid& grid = voxels_.grid();
    DiffusePath path(embree_, grid.origin + from * grid.cell_size_m, k);
    double weight = 1.0;
    for (int surface = 0; surface < MOST_SURFACES; ++surface) {
      const glm::vec3 origin = shared::cell_from_world(grid, path.origin()), way = path.direction();
      const float out = distance_out(origin, way);
      if (!path.step() || path.hit().distance >= out * grid.cell_size_m) {
        const glm::vec3 beyond = origin + (out + 0.01f) * way;
        if (!shared::cell_inside(grid, glm::ivec3(glm::floor(beyond)))) return 0.0;  // out of the grid, as in cells
        const int end = room_near(origin + std::max(out - 0.01f, 0.0f) * way);
        return of_passage(end) && end != room ? weight : 0.0;
      }
      weight *= double(mean(path.albedo()));
    }
    return 0.0;
  }

  /// As sweeps do: sides return light by the cosine to their face.
  void follow_cells(glm::vec3 from, int room, std::uint32_t k, Sums& sums) const {
    const Grid& grid = voxels_.grid();
    glm::vec3 at = from, way = even_direction(k);
    glm::ivec3 cell(glm::floor(from));
    double weight = 1.0;
    size_t crossed = 0;
    std::uint32_t surfaces = 0;
    while (surfaces < std::uint32_t(MOST_SURFACES)) {
      const glm::vec3 ahead(cell + glm::ivec3(glm::greaterThan(way, glm::vec3(0.0f))));
      const glm::vec3 t = (ahead - at) / way;
      const int axis = t.x <= t.y ? (t.x <= t.z ? 0 : 2) : (t.y <= t.z ? 1 : 2);
      at += std::max(t[axis], 0.0f) * way;
      at[axis] = ahead[axis];
      const int face = 2 * axis + (way[axis] > 0.0f ? 1 : 0);
      const glm::uvec2 sides = voxels_.cell_sides(cell);
      if (shared::has_side(sides, face)) {
        const shared::Side& side = voxels_.sides()[shared::side_index(sides, face)];
        if (float(hash(k * 16u + surfaces) >> 8) * 0x1p-24f < side.coverage) {
          weight *= double(mean(shared::side_returned_fraction(side.albedo, side.area_m2, side.face_m2)));
          const glm::vec3 normal = -glm::vec3(shared::face_step(face));
          way = glm::normalize(normal + 0.999f * even_direction(k * 7919u + surfaces++ * 104729u + 1u));
          continue;
        }
      }
      const glm::ivec3 next = cell + shared::face_step(face);
      if (!shared::cell_inside(grid, next)) return;
      const int below = shared::cell_index(grid, (face & 1) != 0 ? cell : next);
      if (std::binary_search(passage_.faces.begin(), passage_.faces.end(), Face(below, axis))) ++crossed;
      if (glm::any(glm::lessThan(next, low_)) || glm::any(glm::greaterThanEqual(next, high_))) break;
      cell = next;
    }
    const int end = rooms_.of(shared::cell_index(grid, cell));
    if (surfaces == std::uint32_t(MOST_SURFACES) || !of_passage(end) || end == room) return;
    sums.by_crossed[std::min(crossed, MOST_CROSSED - 1)] += weight;
    ++sums.passed_in_cells;
  }

  const VoxelGrid& voxels_;
  const EmbreeScene& embree_;
  const Rooms& rooms_;
  const Passage& passage_;
  glm::ivec3 low_, high_;
  std::vector<int> starts_;
};

/// Of each room, what would have to be black to take as much of even light as it does [m^2]: of its sides, and of the
/// grid's open rim.
std::vector<double> black_area(const VoxelGrid& voxels, const Rooms& rooms) {
  const Grid& grid = voxels.grid();
  std::vector<double> area(size_t(rooms.count()), 0.0);
  for (const shared::Side& side : voxels.sides()) {
    const int room = rooms.of(side.cell);
    if (room >= 0) area[size_t(room)] += double(side.area_m2) * (1.0 - double(mean(side.albedo)));
  }
  const double face_m2 = double(grid.cell_size_m) * double(grid.cell_size_m);
  for (int cell = 0; cell < int(rooms.cells()); ++cell) {
    if (rooms.of(cell) < 0) continue;
    const glm::ivec3 at = shared::cell_coord(grid, cell);
    if (glm::all(glm::greaterThan(at, glm::ivec3(0))) && glm::all(glm::lessThan(at, grid.cells - 1))) continue;
    const glm::uvec2 sides = voxels.cell_sides(at);
    for (int face = 0; face < 6; ++face) {
      const bool at_rim = !shared::cell_inside(grid, at + shared::face_step(face));
      if (at_rim && !shared::has_side(sides, face)) area[size_t(rooms.of(cell))] += face_m2;
    }
  }
  return area;
}

/// The largest factor that a passage may have, by passage.
std::vector<float> largest_factors(const VoxelGrid& voxels, const Rooms& rooms, const std::vector<Passage>& passages) {
  const std::vector<double> black_m2 = black_area(voxels, rooms);
  std::vector<int> count(black_m2.size(), 0);
  for (const Passage& p : passages) {
    ++count[size_t(p.rooms.first)];
    ++count[size_t(p.rooms.second)];
  }
  const double face_m2 = double(voxels.grid().cell_size_m) * double(voxels.grid().cell_size_m);
  std::vector<float> largest;
  for (const Passage& p : passages) {
    const auto share_of = [&](int room) { return GAINED * black_m2[size_t(room)] / double(count[size_t(room)]); };
    const double gained = std::min(share_of(p.rooms.first), share_of(p.rooms.second));
    largest.push_back(std::min(LARGEST_FACTOR, 1.0f + float(gained / (double(p.faces.size()) * face_m2))));
  }
  return largest;
}

}  // namespace

std::vector<PassageFace> narrow_passages(const VoxelGrid& voxels, const EmbreeScene& embree) {
  std::vector<PassageFace> all;
  if (cell_count(voxels.grid()) > MOST_CELLS) return all;
  const Rooms rooms(voxels);
  if (rooms.count() < 2) return all;
  const std::vector<Passage> passages = passages_between(voxels, rooms);
  const std::vector<float> largest = largest_factors(voxels, rooms, passages);
  for (size_t i = 0; i < passages.size(); ++i) {
    const float factor = std::min(Paths(voxels, embree, rooms, passages[i]).factor(), largest[i]);
    for (const auto& [cell, axis] : passages[i].faces)
      all.push_back({shared::cell_coord(voxels.grid(), cell), axis, factor, int(i)});
  }
  std::sort(all.begin(), all.end(), [&](const PassageFace& a, const PassageFace& b) {
    return std::pair(shared::cell_index(voxels.grid(), a.cell), a.axis) <
           std::pair(shared::cell_index(voxels.grid(), b.cell), b.axis);
  });
  return all;
}

}  // namespace volgi
