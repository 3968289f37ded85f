// What qualities ask of scenes, without OpenGL: rooms have the defaults, large scenes more, each quality more than the
// one before; nobody's own choice is touched; and a climb ends when two answers agree.
#include "screen/frame/quality.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/error.h"
#include "propagation/volume_options.h"
#include "screen/frame/registry.h"

namespace volgi::test {
namespace {

using screen::Climb;
using screen::FrameOptions;
using screen::Needs;
using screen::Quality;

SceneFacts room() {
  return {.edge_m = 6.0f, .cells = 48, .feature_m = 0.2f, .flight_m = 3.0f, .lit_area_m2 = 60.0f, .lamps = 1};
}
SceneFacts square_in_a_town() {
  return {.edge_m = 90.0f, .cells = 200, .feature_m = 0.1f, .flight_m = 5.0f, .lit_area_m2 = 5000.0f, .lamps = 1};
}

TEST(Quality, DefaultOfARoomIsWhatOptionsHave) {
  const Needs needs = screen::needs_of(Quality::standard, 0, room());
  EXPECT_EQ(needs, Needs{});
  FrameOptions options;
  screen::apply_recipe("hybrid", options);
  const FrameOptions before = options;
  const std::vector<screen::Chosen> chosen = screen::apply_needs(needs, {}, options);
  // Options by themselves are the least; commands take what costs a room little beside.
  ASSERT_EQ(chosen.size(), 3u);
  EXPECT_EQ(chosen[0].name, "grid");
  EXPECT_EQ(chosen[1].name, "ordinates.sources");
  EXPECT_EQ(chosen[1].value, "on");
  EXPECT_EQ(chosen[2].name, "sides.gather");
  EXPECT_EQ(chosen[2].value, "64");
  for (const screen::Parameter* p : screen::parameters()) {
    if (p->name == std::string("ordinates.sources") || p->name == std::string("sides.gather")) continue;
    EXPECT_EQ(p->get(options.settings), p->get(before.settings)) << p->name;
  }
}

TEST(Quality, HasteSparesDirectionsOfSources) {
  FrameOptions options;
  screen::apply_recipe("hybrid", options);
  screen::apply_needs(screen::needs_of(Quality::fast, 0, room()), {}, options);
  EXPECT_FALSE(options.of<VolumeOptions>().scheme.many_for_sources);
  EXPECT_EQ(options.of<VolumeOptions>().gather_rays, 0);
  screen::apply_needs(screen::needs_of(Quality::fine, 0, room()), {}, options);
  EXPECT_TRUE(options.of<VolumeOptions>().scheme.many_for_sources);
}

TEST(Quality, EachAsksForMoreThanTheOneBefore) {
  for (const SceneFacts& facts : {room(), square_in_a_town()}) {
    Needs last = screen::needs_of(Quality::fast, 0, facts);
    for (const Quality quality : {Quality::standard, Quality::fine, Quality::truth}) {
      for (int rung = 0; rung < (quality == Quality::truth ? Climb::RUNGS : 1); ++rung) {
        const Needs needs = screen::needs_of(quality, rung, facts);
        EXPECT_GE(needs.cells, last.cells);
        EXPECT_GE(needs.lights, last.lights);
        EXPECT_LE(needs.interpolation, last.interpolation);
        EXPECT_GE(needs.samples, last.samples);
        EXPECT_NE(needs, last);
        last = needs;
      }
    }
  }
  EXPECT_GT(screen::needs_of(Quality::standard, 0, square_in_a_town()).lights,
            screen::needs_of(Quality::standard, 0, room()).lights);
}

// All that is chosen lies in what parameters take, for every recipe, and what somebody has chosen stays.
TEST(Quality, KeepsChoicesAndRanges) {
  const std::vector<std::string> keep{"grid", "vpl.count"};
  for (const screen::Recipe& recipe : screen::recipes()) {
    FrameOptions options;
    screen::apply_recipe(recipe.name, options);
    options.of<VolumeOptions>().grid_cells = 37;
    screen::set_parameter(options.settings, "vpl.count=123");
    const auto chosen =
        screen::apply_needs(screen::needs_of(Quality::truth, Climb::RUNGS - 1, square_in_a_town()), keep, options);
    EXPECT_EQ(options.of<VolumeOptions>().grid_cells, 37);
    EXPECT_EQ(screen::find_parameter("vpl.count").get(options.settings), 123.0);
    for (const screen::Chosen& c : chosen) {
      const screen::Parameter& p = screen::find_parameter(c.name);
      EXPECT_EQ(screen::parse_value(p, c.value, c.name), p.get(options.settings)) << recipe.name;
    }
  }
}

TEST(Quality, NamesThoseThatThereAre) {
  EXPECT_EQ(screen::quality_from_name("default"), Quality::standard);
  EXPECT_THROW(screen::quality_from_name("best"), Error);
}

Image grey(float value) {
  Image image(8, 8);
  std::fill(image.pixels.begin(), image.pixels.end(), glm::vec3(value));
  return image;
}

TEST(Climb, EndsWhereTwoAnswersAgree) {
  Climb climb;
  EXPECT_TRUE(climb.next(grey(1.0f)));
  EXPECT_TRUE(climb.next(grey(1.05f)));  // 5 of 105 %
  EXPECT_FALSE(climb.next(grey(1.055f)));
  EXPECT_TRUE(climb.agrees());
  ASSERT_EQ(climb.changes_percent().size(), 2u);
  EXPECT_NEAR(climb.changes_percent()[0], 100.0 * 0.05 / 1.05, 1e-3);
  EXPECT_EQ(climb.rung(), 3);
}

TEST(Climb, EndsAfterItsRungs) {
  Climb climb;
  int answers = 1;
  while (climb.next(grey(float(1 << answers)))) ++answers;
  EXPECT_EQ(answers, Climb::RUNGS);
  EXPECT_FALSE(climb.agrees());
}

}  // namespace
}  // namespace volgi::test
