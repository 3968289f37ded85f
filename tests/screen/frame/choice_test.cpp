// --gi auto without OpenGL: what a budget may be, predictions of fronts whose law is known, and what is chosen by them.
#include "screen/frame/choice.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace volgi::test {
namespace {

using screen::Budget;
using screen::Choice;
using screen::FrontPoint;
using screen::FrontScene;
using screen::LightPart;
using screen::MeasuredFront;
using screen::PictureFacts;
using screen::Prediction;

constexpr double SMALL = 192.0 * 192.0, LARGE = 384.0 * 384.0;

PictureFacts scene(double ktriangles, double kcells, double noise) {
  PictureFacts f;
  f.scene = {.edge_m = 6.0f, .cells = 48, .feature_m = 0.2f, .flight_m = 3.0f, .lit_area_m2 = 30.0f, .lamps = 1};
  f.triangles = 1e3 * ktriangles;
  f.cells = 1e3 * kcells;
  f.noise = noise;
  f.indirect_share = 0.5;
  f.first_share = 0.4;
  return f;
}

/// Setting k takes (k+1) (10 + 2 ktriangles + kcells / 10) ms, twice that in the large size, and errs by
/// 40 (noise + 0.05) / 4^k %.
FrontPoint law(const PictureFacts& f, size_t k) {
  const double ms = double(k + 1) * (10.0 + 2.0 * f.triangles / 1e3 + f.cells / 1e4);
  return {ms, 2.0 * ms, std::nullopt, 40.0 * (f.noise + 0.05) / std::pow(4.0, double(k))};
}

MeasuredFront front_of_a_law() {
  MeasuredFront front;
  front.pixels = SMALL;
  front.large_pixels = LARGE;
  for (size_t k = 0; k < 3; ++k)
    front.settings.push_back({"s" + std::to_string(k), {"--gi", "r" + std::to_string(k)}, 1});
  front.settings.back().pictures = 4;
  int number = 0;
  for (const auto& [triangles, cells, noise] : {std::tuple{0.03, 100.0, 0.1},
                                                {0.5, 60.0, 0.9},
                                                {2.0, 300.0, 0.4},
                                                {10.0, 900.0, 0.6},
                                                {40.0, 500.0, 0.3},
                                                {66.0, 1000.0, 0.5},
                                                {1.0, 20.0, 0.2},
                                                {5.0, 700.0, 0.8}}) {
    FrontScene s{"scene" + std::to_string(number++), scene(triangles, cells, noise), {}};
    for (size_t k = 0; k < front.settings.size(); ++k) s.points.push_back(law(s.facts, k));
    front.scenes.push_back(std::move(s));
  }
  return front;
}

TEST(Budget, TakesTimesAndErrors) {
  EXPECT_EQ(screen::parse_budget("50ms").amount, 50.0);
  EXPECT_EQ(screen::parse_budget("0.2s").amount, 200.0);
  EXPECT_EQ(screen::parse_budget("0.2s").kind, Budget::Kind::time);
  EXPECT_EQ(screen::parse_budget("3%").kind, Budget::Kind::error);
  EXPECT_EQ(screen::parse_budget("2.5%").text(), "2.5 %");
}

TEST(Budget, RefusesAnythingElseByName) {
  for (const char* text : {"abc", "-3%", "0ms", "0%", "", "50", "ms", "nan%", "inf s", "1e999ms", "3%%", "5 ms"}) {
    try {
      screen::parse_budget(text);
      ADD_FAILURE() << text;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ExitCode::usage);
      EXPECT_NE(std::string(error.what()).find(std::string("'") + text + "'"), std::string::npos) << error.what();
    }
  }
}

// Times are sums of what is measured: to the pull of the fit, 1e-3 of each coefficient. Errors of one cause are a power
// of it: to the pull of their fit, a fifth of the slope, over e^±1 of the mean.
TEST(Prediction, FollowsTheLawsOfASceneThatItHasNotSeen) {
  const MeasuredFront front = front_of_a_law();
  for (const PictureFacts& f : {scene(3.0, 200.0, 0.5), scene(20.0, 800.0, 0.25)}) {
    const std::vector<Prediction> p = screen::predict(front, f, SMALL, LightPart::indirect);
    ASSERT_EQ(p.size(), 3u);
    for (size_t k = 0; k < 3; ++k) {
      const FrontPoint truth = law(f, k);
      EXPECT_NEAR(p[k].ms.value() / truth.ms.value(), 1.0, 0.02);
      EXPECT_NEAR(std::log(p[k].error_percent.value() / truth.indirect_error_percent.value()), 0.0, 0.25);
    }
  }
}

TEST(Prediction, GrowsWithPixelsAsBetweenTheTwoSizes) {
  const MeasuredFront front = front_of_a_law();
  const PictureFacts f = scene(3.0, 200.0, 0.5);
  const double small = *screen::predict(front, f, SMALL, LightPart::indirect)[0].ms;
  EXPECT_NEAR(*screen::predict(front, f, LARGE, LightPart::indirect)[0].ms / small, 2.0, 0.02);
  EXPECT_NEAR(*screen::predict(front, f, 7.0 * SMALL, LightPart::indirect)[0].ms / small, 3.0, 0.03);
  EXPECT_GT(*screen::predict(front, f, 0.1 * SMALL, LightPart::indirect)[0].ms, 0.0);
}

// All light errs by its indirect share, and by light straight from surfaces where some shine and were measured.
TEST(Prediction, OfAllLightIsThatOfItsIndirectShare) {
  MeasuredFront front = front_of_a_law();
  PictureFacts f = scene(3.0, 200.0, 0.5);
  const double indirect = *screen::predict(front, f, SMALL, LightPart::indirect)[0].error_percent;
  EXPECT_NEAR(*screen::predict(front, f, SMALL, LightPart::full)[0].error_percent, 0.5 * indirect, 1e-9);
  front.scenes[0].facts.emits = true;
  front.scenes[0].points[0].error_percent = 3.0 * 0.5 * *front.scenes[0].points[0].indirect_error_percent;
  EXPECT_NEAR(*screen::predict(front, f, SMALL, LightPart::full)[0].error_percent, 0.5 * indirect, 1e-9);
  f.emits = true;
  EXPECT_NEAR(*screen::predict(front, f, SMALL, LightPart::full)[0].error_percent, 1.5 * indirect, 1e-6 * indirect);
}

TEST(Choice, IsTheLeastErrorInTheTimeOrTheLeastTimeForTheError) {
  const MeasuredFront front = front_of_a_law();
  const PictureFacts f = scene(3.0, 200.0, 0.5);  // 36, 72, 108 ms; 22, 5.5, 1.4 %
  const auto chosen = [&](const char* budget) {
    return screen::choose(front, f, SMALL, LightPart::indirect, screen::parse_budget(budget));
  };
  EXPECT_EQ(chosen("50ms").setting, 0u);
  EXPECT_EQ(chosen("80ms").setting, 1u);
  EXPECT_EQ(chosen("5s").setting, 2u);
  EXPECT_EQ(chosen("10%").setting, 1u);
  EXPECT_EQ(chosen("2%").setting, 2u);
  EXPECT_EQ(chosen("60%").setting, 0u);
  for (const char* budget : {"50ms", "10%"}) EXPECT_TRUE(chosen(budget).reached) << budget;
  EXPECT_EQ(chosen("50ms").predictions.size(), 3u);
  EXPECT_EQ(chosen("50ms").nearest.size(), 2u);
}

TEST(Choice, WhatCannotBeReachedIsTheNearestAndSaysSo) {
  const MeasuredFront front = front_of_a_law();
  const PictureFacts f = scene(3.0, 200.0, 0.5);
  const Choice quick = screen::choose(front, f, SMALL, LightPart::indirect, screen::parse_budget("1ms"));
  EXPECT_EQ(quick.setting, 0u);
  EXPECT_FALSE(quick.reached);
  const Choice right = screen::choose(front, f, SMALL, LightPart::indirect, screen::parse_budget("0.01%"));
  EXPECT_EQ(right.setting, 2u);
  EXPECT_FALSE(right.reached);
}

TEST(Choice, TakesOnlyWhatIsAllowed) {
  const MeasuredFront front = front_of_a_law();
  const PictureFacts f = scene(3.0, 200.0, 0.5);
  const Budget budget = screen::parse_budget("5s");
  const auto one_picture = [](const screen::FrontSetting& s) { return s.pictures == 1; };
  EXPECT_EQ(screen::choose(front, f, SMALL, LightPart::indirect, budget, one_picture).setting, 1u);
  const auto nothing = [](const screen::FrontSetting&) { return false; };
  EXPECT_THROW(screen::choose(front, f, SMALL, LightPart::indirect, budget, nothing), Error);
}

// Predictions that are too low by so much are given so much room.
TEST(Choice, KeepsAMarginWherePredictionsHaveBeenTooLow) {
  MeasuredFront front = front_of_a_law();
  const PictureFacts f = scene(3.0, 200.0, 0.5);
  const Budget budget = screen::parse_budget("80ms");
  EXPECT_EQ(screen::choose(front, f, SMALL, LightPart::indirect, budget).margin, 1.0);
  for (size_t k = 0; k < front.scenes.size(); ++k)
    for (FrontPoint& p : front.scenes[k].points) *p.ms *= k % 2 == 0 ? 3.0 : 1.0 / 3.0;
  EXPECT_GT(screen::choose(front, f, SMALL, LightPart::indirect, budget).margin, 1.3);
}

TEST(Choice, GoesByTheDevicesTimes) {
  const MeasuredFront front = front_of_a_law();
  const PictureFacts f = scene(3.0, 200.0, 0.5);
  const MeasuredFront other =
      screen::on_device(front, {"another", "today", {1.0 / 8.0, 1.0 / 8.0, 1.0 / 2.0}, {1.0 / 8.0, 1.0 / 8.0, 0.5}});
  EXPECT_EQ(other.device, "another");
  EXPECT_NEAR(*screen::predict(other, f, SMALL, LightPart::indirect)[1].ms,
              *screen::predict(front, f, SMALL, LightPart::indirect)[1].ms / 8.0, 0.1);
  EXPECT_EQ(screen::choose(other, f, SMALL, LightPart::indirect, screen::parse_budget("50ms")).setting, 1u);
}

}  // namespace
}  // namespace volgi::test
