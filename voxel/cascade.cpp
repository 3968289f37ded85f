#include "voxel/cascade.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "voxel/voxel_grid.h"

namespace volgi {

namespace {

/// Blocks of every level lie on one lattice over the whole of the outermost grid: a level's is `ratio` times as fine as
/// that of the level around it.
class Lattice {
 public:
  Lattice(const Grid& outermost, int ratio) : outermost_(outermost), ratio_(ratio) {}

  double block_m(int level) const { return kLeafCells * double(outermost_.cell_size_m) / std::pow(ratio_, level); }
  glm::ivec3 blocks(int level) const { return leaf_blocks(outermost_) * int(std::lround(std::pow(ratio_, level))); }
  glm::dvec3 place(glm::vec3 point, int level) const {
    return (glm::dvec3(point) - glm::dvec3(outermost_.origin)) / block_m(level);
  }
  Grid grid(const BlockBox& box, int level) const {
    Grid g = outermost_;
    g.cells = kLeafCells * box.size();
    g.cell_size_m = float(block_m(level) / kLeafCells);
    g.origin = glm::vec3(glm::dvec3(outermost_.origin) + glm::dvec3(box.first) * block_m(level));
    return g;
  }

 private:
  const Grid& outermost_;
  int ratio_;
};

/// With whole blocks of 8^3 cells along every axis, the more on both sides.
Grid of_whole_blocks(Grid g) {
  const glm::ivec3 cells = kLeafCells * leaf_blocks(g);
  const glm::ivec3 before = (cells - g.cells) / 2;
  g.origin -= glm::vec3(before) * g.cell_size_m;
  g.cells = cells;
  return g;
}

BlockBox clamped(const BlockBox& b, glm::ivec3 blocks) {
  return {glm::clamp(b.first, glm::ivec3(0), blocks), glm::clamp(b.last, glm::ivec3(0), blocks)};
}

/// Blocks of level - 1 in which a level of as many cells as the outermost grid lies around a point.
BlockBox around_point(const Lattice& lattice, glm::vec3 point, int level, int ratio) {
  const glm::ivec3 outer = lattice.blocks(0), all = lattice.blocks(level - 1);
  const int longest = std::max({outer.x, outer.y, outer.z});
  const glm::ivec3 size = glm::min(glm::ivec3((longest + ratio - 1) / ratio), all);
  const glm::dvec3 first = glm::round(lattice.place(point, level - 1) - 0.5 * glm::dvec3(size));
  const glm::ivec3 at = glm::ivec3(glm::clamp(first, glm::dvec3(0.0), glm::dvec3(all - size)));
  return {at, at + size};
}

BlockBox around_box(const Lattice& lattice, const GridBox& box, int level) {
  constexpr double ROUNDING = 1e-4;  // of a block: a box of whole blocks has no more
  const glm::dvec3 first = glm::floor(lattice.place(box.min, level - 1) + ROUNDING);
  const glm::dvec3 last = glm::ceil(lattice.place(box.max, level - 1) - ROUNDING);
  const glm::dvec3 all(lattice.blocks(level - 1));
  const BlockBox blocks{glm::ivec3(glm::clamp(first, glm::dvec3(0.0), all)),
                        glm::ivec3(glm::clamp(last, glm::dvec3(0.0), all))};
  if (blocks.empty()) throw Error(ExitCode::usage, "--cascade: a box that is outside of the volume's outermost grid");
  return blocks;
}

/// Makes room in a level's box for the next one's and a block around it.
void make_room(BlockBox& box, const BlockBox& next, int ratio, glm::ivec3 all) {
  const glm::dvec3 first = glm::floor(glm::dvec3(next.first - 1) / double(ratio));
  const glm::dvec3 last = glm::ceil(glm::dvec3(next.last + 1) / double(ratio));
  box = clamped({glm::min(box.first, glm::ivec3(first)), glm::max(box.last, glm::ivec3(last))}, all);
}

void check(const CascadeOptions& options, const Grid& outermost) {
  if (options.ratio != 2 && options.ratio != 4)
    throw Error(ExitCode::usage, "--cascade-ratio: cells are twice or four times as coarse, 2 or 4");
  const double longest = std::max({outermost.cells.x, outermost.cells.y, outermost.cells.z});
  const double finest = longest * std::pow(options.ratio, options.levels - 1);
  if (finest > kMostFinestCells)
    throw Error(
        ExitCode::over_limit,
        fmt::format("{} cascades, each {} times as coarse: the scene is {:.0f} of the finest cells long, {} are "
                    "told apart; fewer --cascades or a smaller --grid",
                    options.levels, options.ratio, finest, kMostFinestCells));
}

}  // namespace

size_t Cascade::level_of(glm::vec3 point, float margin) const {
  for (size_t level = grids.size(); level-- > 1;) {
    const glm::vec3 at = shared::cell_from_world(grids[level], point);
    if (glm::all(glm::greaterThanEqual(at, glm::vec3(margin))) &&
        glm::all(glm::lessThan(at, glm::vec3(grids[level].cells) - margin)))
      return level;
  }
  return 0;
}

glm::ivec3 Cascade::finest_cells() const {
  return grids[0].cells * int(std::lround(std::pow(ratio, double(grids.size() - 1))));
}

Cascade make_cascade(const Grid& outermost, const CascadeOptions& options) {
  if (options.levels < 1 || options.levels > CascadeOptions::kMostLevels)
    throw Error(ExitCode::usage, fmt::format("--cascades: 1 to {} grids", CascadeOptions::kMostLevels));
  const Grid outer = options.nested() ? of_whole_blocks(outermost) : outermost;
  Cascade c{options.ratio, {outer}, {BlockBox{}}};
  if (!options.nested()) return c;
  check(options, outer);
  const Lattice lattice(outer, options.ratio);
  const int inner = options.levels - 1;
  std::vector<BlockBox> boxes(size_t(inner) + 1);  // by level, blocks of the level around
  for (int level = inner; level >= 1; --level) {
    BlockBox& box = boxes[size_t(level)];
    box = options.by_boxes ? around_box(lattice, options.boxes[size_t(level) - 1], level)
                           : around_point(lattice, options.around, level, options.ratio);
    if (level < inner) make_room(box, boxes[size_t(level) + 1], options.ratio, lattice.blocks(level - 1));
  }
  glm::ivec3 first(0);  // block of the level around, on the whole lattice
  for (int level = 1; level <= inner; ++level) {
    const BlockBox& box = boxes[size_t(level)];
    c.inside.back() = {box.first - first, box.last - first};
    const BlockBox blocks{box.first * options.ratio, box.last * options.ratio};
    c.grids.push_back(lattice.grid(blocks, level));
    c.inside.push_back(BlockBox{});
    first = blocks.first;
  }
  return c;
}

bool same_cascade(const Cascade& a, const Cascade& b) {
  return a.ratio == b.ratio && a.inside == b.inside && a.grids.size() == b.grids.size() &&
         std::equal(a.grids.begin(), a.grids.end(), b.grids.begin(), same_grid);
}

}  // namespace volgi
