// Which cells a scene of several places needs.
#include "voxel/passages.h"

#include <gtest/gtest.h>

#include <set>

#include "tests/support/volume_scenes.h"
#include "voxel/voxelize_cpu.h"

namespace volgi::test {
namespace {

constexpr size_t MANY = size_t(1) << 20;

/// Rooms of 2 x 2 x 2 m beside each other along x; the walls between, without thickness, end `gap_m` before the rooms'
/// far side.
Scene rooms(int count, float gap_m) {
  Scene scene;
  const int material = add_material(scene, glm::vec3(0.7f));
  add_box_inside(scene, material, {float(count), 1.0f, 1.0f}, {float(count), 1.0f, 1.0f});
  for (int k = 1; k < count; ++k) add_quad(scene, material, {2.0f * float(k), 0, 0}, {0, 2, 0}, {0, 0, 2.0f - gap_m});
  return scene;
}

size_t places(const Scene& scene, int cells) {
  const std::vector<int> place_of = places_of(voxelize_cpu(scene, make_grid(scene, cells)));
  std::set<int> different(place_of.begin(), place_of.end());
  different.erase(-1);
  return different.size();
}

TEST(Passages, RoomsAreJoinedWhereCellsSeeTheGap) {
  EXPECT_EQ(places(rooms(1, 0.0f), 20), 1u);
  EXPECT_EQ(places(rooms(3, 0.0f), 48), 3u);
  EXPECT_EQ(places(rooms(3, 0.3f), 48), 1u);
}

TEST(Passages, TheInsideOfABodyIsNoPlace) {
  Scene scene = rooms(1, 0.0f);
  add_box(scene, 0, {1.0f, 1.0f, 1.0f}, glm::vec3(0.5f));
  EXPECT_EQ(places(scene, 20), 1u);
}

// A gap of 0.08 m: in cells of 0.25 and 0.19 m most of a face beside it is wall, in cells of 0.125 m a third. Those
// that are half as large see it well. Places that no light comes from are nobody's.
TEST(Passages, CellsFollowTheGap) {
  const Scene wide = rooms(3, 1.0f), narrow = rooms(3, 0.08f), closed = rooms(3, 0.0f);
  EXPECT_EQ(cells_that_keep_passages(wide, 48, MANY), 48);
  EXPECT_EQ(cells_that_keep_passages(closed, 48, MANY), 48);
  EXPECT_EQ(cells_that_keep_passages(narrow, 48, MANY), 96);
  const LitPoint in_the_first[] = {{{1.0f, 0.0f, 1.0f}, {0.0f, 1.0f, 0.0f}}}, outside[] = {{{-9, 0, 0}, {0, 1, 0}}};
  EXPECT_EQ(cells_that_keep_passages(narrow, 48, MANY, in_the_first), 96);
  EXPECT_EQ(cells_that_keep_passages(narrow, 48, MANY, outside), 48);
}

TEST(Passages, NoMoreCellsThanAllowed) {
  const Scene narrow = rooms(3, 0.08f);
  const size_t few = cell_count(make_grid(narrow, 80));
  const int cells = cells_that_keep_passages(narrow, 48, few);
  EXPECT_GT(cells, 48);
  EXPECT_LE(cell_count(make_grid(narrow, cells)), few);
}

}  // namespace
}  // namespace volgi::test
