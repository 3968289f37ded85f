// Where nested grids lie, and how their faces fit together.
#include "voxel/cascade.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "tests/support/volume_scenes.h"
#include "voxel/cascade_voxels.h"
#include "voxel/volume_sides.h"
#include "voxel/voxelize_cpu.h"

namespace volgi::test {
namespace {

Grid outermost(glm::ivec3 cells, float cell_size_m = 1.0f) {
  Grid grid{};
  grid.cells = cells;
  grid.cell_size_m = cell_size_m;
  grid.origin = -0.5f * cell_size_m * glm::vec3(cells);
  return grid;
}

CascadeOptions nested(int levels, int ratio, glm::vec3 around = glm::vec3(0.0f)) {
  CascadeOptions o;
  o.levels = levels;
  o.ratio = ratio;
  o.around = around;
  return o;
}

// Every level but the outermost: its box is whole blocks of the level around it, which are where it says, and between
// two levels is a block of the one between, or the rim of all.
void expect_nested(const Cascade& c) {
  ASSERT_EQ(c.grids.size(), c.inside.size());
  EXPECT_TRUE(c.inside.back().empty());
  for (size_t level = 1; level < c.levels(); ++level) {
    const Grid &outer = c.grids[level - 1], &inner = c.grids[level];
    const BlockBox& box = c.inside[level - 1];
    EXPECT_FLOAT_EQ(inner.cell_size_m * float(c.ratio), outer.cell_size_m);
    EXPECT_EQ(inner.cells, c.ratio * kLeafCells * box.size());
    const glm::vec3 origin = shared::world_from_cell(outer, glm::vec3(kLeafCells * box.first));
    EXPECT_LT(glm::distance(inner.origin, origin), 1e-4f);
    const glm::vec3 first = shared::cell_from_world(c.grids[0], outer.origin);
    const glm::vec3 last = first + glm::vec3(outer.cells) * outer.cell_size_m / c.grids[0].cell_size_m;
    for (int axis = 0; axis < 3; ++axis) {
      const bool at_low = first[axis]<0.01f, at_high = last[axis]> float(c.grids[0].cells[axis]) - 0.01f;
      EXPECT_GE(box.first[axis], at_low ? 0 : 1);
      EXPECT_LE(box.last[axis], leaf_blocks(outer)[axis] - (at_high ? 0 : 1));
    }
  }
}

TEST(Cascade, OfOneGridIsThatGrid) {
  const Grid grid = outermost({13, 7, 9});
  const Cascade c = make_cascade(grid, CascadeOptions{});
  ASSERT_EQ(c.levels(), 1u);
  EXPECT_TRUE(same_grid(c.grids[0], grid));
  EXPECT_FALSE(c.covers(0, glm::ivec3(0)));
}

TEST(Cascade, LevelsLieInOneAnother) {
  for (const int ratio : {2, 4}) {
    for (const glm::vec3 around : {glm::vec3(0.0f), glm::vec3(31.0f, -3.0f, 9.0f), glm::vec3(-200.0f, 0.0f, 200.0f)}) {
      for (const int levels : {2, 3}) {
        const Cascade c = make_cascade(outermost({64, 13, 30}), nested(levels, ratio, around));
        ASSERT_EQ(c.levels(), size_t(levels));
        EXPECT_EQ(c.grids[0].cells, glm::ivec3(64, 16, 32));  // whole blocks
        expect_nested(c);
      }
    }
  }
}

TEST(Cascade, TheInnermostHoldsThePointItLiesAround) {
  for (const glm::vec3 around : {glm::vec3(1.0f), glm::vec3(30.0f, 3.0f, -9.0f), glm::vec3(-31.9f, -6.0f, 14.9f)}) {
    const Cascade c = make_cascade(outermost({64, 16, 32}), nested(4, 2, around));
    EXPECT_EQ(c.level_of(around), 3u);
  }
  const Cascade c = make_cascade(outermost({64, 16, 32}), nested(4, 2));
  EXPECT_EQ(c.level_of({500.0f, 0.0f, 0.0f}), 0u);
}

TEST(Cascade, MovesByWholeBlocksOfTheGridAround) {
  Cascade before = make_cascade(outermost({128, 16, 16}), nested(3, 2, {-20.0f, 0.0f, 0.0f}));
  int moves = 0;
  for (float x = -20.0f; x < 20.0f; x += 0.25f) {
    const Cascade c = make_cascade(outermost({128, 16, 16}), nested(3, 2, {x, 0.0f, 0.0f}));
    if (same_cascade(c, before)) continue;
    ++moves;
    for (size_t level = 1; level < c.levels(); ++level) {
      const float blocks = (c.grids[level].origin.x - before.grids[level].origin.x) /
                           (float(kLeafCells) * c.grids[level - 1].cell_size_m);
      EXPECT_NEAR(blocks, std::round(blocks), 1e-4f);
    }
    before = c;
  }
  EXPECT_GT(moves, 5);  // 40 m by blocks of 4 and 8 m
  EXPECT_LT(moves, 20);
}

TEST(Cascade, BoxesAreMadeUpToWholeBlocksAndMakeRoomForThoseInside) {
  CascadeOptions options = nested(3, 2);
  options.by_boxes = true;
  options.boxes[0] = {{0.0f, 0.0f, 0.0f}, {1.0f, 1.0f, 1.0f}};
  options.boxes[1] = {{-7.0f, -7.0f, -7.0f}, {8.0f, 7.0f, 7.0f}};
  const Cascade c = make_cascade(outermost({64, 64, 64}), options);
  ASSERT_EQ(c.levels(), 3u);
  expect_nested(c);
  EXPECT_EQ(c.grids[2].origin, glm::vec3(-8.0f));
  EXPECT_EQ(c.grids[2].cells, glm::ivec3(64));
  EXPECT_EQ(c.grids[1].origin, glm::vec3(-16.0f));  // asked for less
}

TEST(Cascade, WhatCannotBeIsAnError) {
  EXPECT_THROW(make_cascade(outermost({64, 64, 64}), nested(2, 3)), Error);
  EXPECT_THROW(make_cascade(outermost({64, 64, 64}), nested(0, 2)), Error);
  CascadeOptions outside = nested(2, 2);
  outside.by_boxes = true;
  outside.boxes[0] = {{100.0f, 0.0f, 0.0f}, {101.0f, 1.0f, 1.0f}};
  EXPECT_THROW(make_cascade(outermost({64, 64, 64}), outside), Error);
  try {
    make_cascade(outermost({512, 64, 64}), nested(3, 2));
    FAIL();
  } catch (const Error& e) {
    EXPECT_EQ(e.code(), ExitCode::over_limit);
  }
}

/// A long room whose walls no grid is parallel to, with a wall across and a sheet along, all through the rim of the
/// inner grid.
Scene turned_rooms() {
  Scene scene;
  const int grey = add_material(scene, glm::vec3(0.5f));
  const glm::mat3 turn(glm::rotate(glm::mat4(1.0f), 0.3f, glm::normalize(glm::vec3(0.2f, 1.0f, 0.1f))));
  add_box_inside(scene, grey, glm::vec3(0.0f), {14.0f, 6.0f, 9.0f}, turn);
  for (const glm::vec3 axis : {glm::vec3(1.0f, 0.0f, 0.0f), glm::vec3(0.0f, 0.0f, 1.0f)})
    add_square(scene, grey, glm::vec3(0.3f, 0.1f, -0.2f), turn * axis, 15.0f);
  return scene;
}

// What a coarse face stops is the mean of what the fine ones stop, and where the one has a side the other has.
TEST(CascadeVoxels, BothSidesOfARimStopTheSame) {
  const Scene scene = turned_rooms();
  for (const int ratio : {2, 4}) {
    const Cascade c = make_cascade(make_grid(scene, 32), nested(2, ratio, {1.0f, 0.0f, 2.0f}));
    const std::vector<VoxelGrid> levels = voxelize_cascade(scene, c, voxelization_mipmaps(scene));
    int shut = 0, partly = 0;
    for_each_cell_at_rim(c, 0, [&](glm::ivec3 cell, int face, glm::ivec3 first) {
      float open = 0.0f;
      const int b = shared::axis_b(face >> 1), e = shared::axis_c(face >> 1);
      for (int k = 0; k < ratio * ratio; ++k) {
        glm::ivec3 fine = first;
        fine[b] += k % ratio;
        fine[e] += k / ratio;
        open += open_share(levels[1], fine, shared::opposite_face(face));
      }
      const float share = open_share(levels[0], cell, face);
      EXPECT_NEAR(open / float(ratio * ratio), share, 1e-6f);
      shut += share == 0.0f ? 1 : 0;
      partly += share > 0.0f && share < 1.0f ? 1 : 0;
    });
    EXPECT_GT(shut, 3);
    EXPECT_GT(partly, 10);
    for (const shared::Side& side : levels[0].sides())
      EXPECT_FALSE(c.covers(0, shared::cell_coord(levels[0].grid(), side.cell) / kLeafCells));
  }
}

/// All cells of a cascade that a journey through open faces leads to, as (level, cell).
class Journey {
 public:
  Journey(const Cascade& cascade, const std::vector<VoxelGrid>& levels) : c_(cascade), levels_(levels) {
    for (const Grid& grid : c_.grids) been_.emplace_back(cell_count(grid), false);
  }
  void start(glm::vec3 point) {
    const size_t level = c_.level_of(point);
    go(level, glm::ivec3(shared::cell_from_world(c_.grids[level], point)));
    while (!todo_.empty()) {
      const auto [l, cell] = todo_.back();
      todo_.pop_back();
      for (int face = 0; face < 6; ++face) step(l, cell, face);
    }
  }
  bool been(glm::vec3 point) const {
    const size_t level = c_.level_of(point);
    const glm::ivec3 cell(shared::cell_from_world(c_.grids[level], point));
    return been_[level][size_t(shared::cell_index(c_.grids[level], cell))];
  }

 private:
  void step(size_t level, glm::ivec3 cell, int face) {
    if (shared::is_opaque(levels_[level].cell_sides(cell), face)) return;
    const glm::ivec3 next = cell + shared::face_step(face);
    if (shared::cell_inside(c_.grids[level], next)) {
      if (!c_.covers(level, next / kLeafCells)) {
        go(level, next);
      } else {
        enter(level, next, shared::opposite_face(face));
      }
    } else if (level > 0) {
      const glm::ivec3 outer_first = kLeafCells * c_.inside[level - 1].first;
      const glm::vec3 at = glm::vec3(next) + 0.5f;
      go(level - 1, outer_first + glm::ivec3(glm::floor(at / float(c_.ratio))));
    }
  }
  void enter(size_t level, glm::ivec3 covered, int face) {
    const glm::ivec3 first = c_.ratio * (covered - kLeafCells * c_.inside[level].first);
    const int axis = face >> 1, b = shared::axis_b(axis), e = shared::axis_c(axis);
    for (int k = 0; k < c_.ratio * c_.ratio; ++k) {
      glm::ivec3 fine = first;
      fine[axis] += (face & 1) != 0 ? c_.ratio - 1 : 0;
      fine[b] += k % c_.ratio;
      fine[e] += k / c_.ratio;
      if (!shared::is_opaque(levels_[level + 1].cell_sides(fine), face)) go(level + 1, fine);
    }
  }
  void go(size_t level, glm::ivec3 cell) {
    if (!shared::cell_inside(c_.grids[level], cell)) return;
    auto seen = been_[level].begin() + shared::cell_index(c_.grids[level], cell);
    if (*seen) return;
    *seen = true;
    todo_.emplace_back(level, cell);
  }

  const Cascade& c_;
  const std::vector<VoxelGrid>& levels_;
  std::vector<std::vector<bool>> been_;
  std::vector<std::pair<size_t, glm::ivec3>> todo_;
};

// Four rooms, each of them partly in either grid: no journey leads from one into another, wherever the walls lie in
// cells.
TEST(CascadeVoxels, NoWallLeaksAtTheRim) {
  const Scene scene = turned_rooms();
  const glm::mat3 turn(glm::rotate(glm::mat4(1.0f), 0.3f, glm::normalize(glm::vec3(0.2f, 1.0f, 0.1f))));
  const auto middle = [&](int room) {
    return turn * glm::vec3(room & 1 ? 7.0f : -7.0f, 0.0f, room & 2 ? 4.5f : -4.5f);
  };
  for (const glm::vec3 shift : {glm::vec3(0.0f), glm::vec3(0.3f), glm::vec3(-0.45f, 0.2f, 0.37f)}) {
    for (const int levels_wanted : {1, 2, 3}) {
      const Grid grid = make_grid(scene, 32, shift);
      const Cascade c = make_cascade(grid, nested(levels_wanted, 2, {1.0f, 0.0f, 2.0f}));
      const std::vector<VoxelGrid> levels = voxelize_cascade(scene, c, voxelization_mipmaps(scene));
      for (int from = 0; from < 4; ++from) {
        Journey journey(c, levels);
        journey.start(middle(from));
        for (int to = 0; to < 4; ++to)
          EXPECT_EQ(journey.been(middle(to)), to == from) << levels_wanted << " levels, " << from << " to " << to;
      }
    }
  }
}

TEST(VolumeSides, NumbersThoseOfAllLevels) {
  const Scene scene = turned_rooms();
  const Cascade c = make_cascade(make_grid(scene, 24), nested(2, 2));
  const std::vector<VoxelGrid> levels = voxelize_cascade(scene, c, voxelization_mipmaps(scene));
  const VolumeSides sides(c, levels);
  ASSERT_EQ(sides.count(), levels[0].side_count() + levels[1].side_count());
  EXPECT_EQ(&sides[0], &levels[0].sides()[0]);
  EXPECT_EQ(&sides[levels[0].side_count()], &levels[1].sides()[0]);
  EXPECT_EQ(sides.relative_face(0), 1.0f);
  EXPECT_EQ(sides.relative_face(sides.count() - 1), 0.25f);
}

}  // namespace
}  // namespace volgi::test
