// --gi auto's front: the one that is shipped keeps budgets on scenes that it has not seen; files; a device's times.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "apps/report/front.h"
#include "apps/report/front_check.h"
#include "apps/report/renderers.h"
#include "apps/report/sweep.h"
#include "core/error.h"
#include "tests/support/paths.h"

namespace volgi::app {
namespace {

namespace fs = std::filesystem;

// The limits of docs/results/auto.md: nine of ten within 1.3 of the budget, and never 1.15 of the error that the best
// setting for all scenes has in the same time.
TEST(ShippedFront, KeepsBudgetsOfScenesThatItHasNotSeen) {
  const std::vector<FrontCheck> checks = leave_one_out(shipped_front(), usual_budgets());
  ASSERT_GT(checks.size(), 200u);
  const auto kept = std::count_if(checks.begin(), checks.end(), keeps_budget);
  EXPECT_GE(double(kept), 0.9 * double(checks.size())) << check_table(checks);
  for (const FrontCheck& c : checks) {
    if (c.budget.kind == screen::Budget::Kind::error) continue;
    EXPECT_LE(c.times_fixed, 1.15) << c.scene << ", " << c.budget.text() << ": " << c.chosen;
  }
}

TEST(ShippedFront, HasSettingsThatThereAre) {
  const screen::MeasuredFront& front = shipped_front();
  EXPECT_GE(front.scenes.size(), 16u);
  for (const screen::FrontSetting& s : front.settings) EXPECT_NO_THROW(check_options("render", s.options)) << s.name;
}

TEST(FrontFile, IsReadAsItWasWritten) {
  const screen::MeasuredFront& front = shipped_front();
  const std::string text = to_json(front).dump();
  EXPECT_EQ(to_json(front_from_json(text, "f")).dump(), text);
}

TEST(FrontFile, WhatIsNoneIsRefusedByName) {
  std::string damaged = to_json(shipped_front()).dump();
  damaged.resize(damaged.size() / 2);
  nlohmann::ordered_json fewer = to_json(shipped_front());
  fewer["scenes"][0]["points"].erase(0);
  nlohmann::ordered_json negative = to_json(shipped_front());
  negative["scenes"][0]["points"][0]["ms"] = -1.0;
  for (const std::string& text :
       {std::string(), std::string("[]"), std::string("{}"), damaged, fewer.dump(), negative.dump()}) {
    try {
      front_from_json(text, "bad.json");
      ADD_FAILURE() << text.substr(0, 80);
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ExitCode::bad_input);
      EXPECT_EQ(std::string(error.what()).find("bad.json: "), 0u) << error.what();
    }
  }
}

/// Two settings at sizes that take no time.
screen::MeasuredFront tiny_front() {
  screen::MeasuredFront front;
  front.pixels = 16.0 * 16.0;
  front.large_pixels = 32.0 * 32.0;
  front.settings = {{"none", {"--gi", "none"}, 1}, {"volume", {"--gi", "volume", "--grid", "8"}, 4}};
  front.scenes = {{"cornell", {}, {{1.0, 2.0, {}, 1.0}, {10.0, {}, {}, 1.0}}}};
  return front;
}

TEST(DeviceTimes, AreMeasuredKeptAndScaleTheFront) {
  gl::Context context;
  const screen::MeasuredFront front = tiny_front();
  const DeviceTimes times = measure_device(front, test::source_dir() / "data/cornell.glb", context);
  ASSERT_EQ(times.times.size(), 2u);
  EXPECT_EQ(times.device, context.device_name());
  EXPECT_GT(times.times[0].ms, 0.0);
  EXPECT_TRUE(times.times[0].large_ms.has_value());
  EXPECT_FALSE(times.times[1].large_ms.has_value());  // of several pictures
  const fs::path file = fs::path(::testing::TempDir()) / "volgi_device_times" / "a.json";
  write_device_times(file, times);
  const std::optional<DeviceTimes> read = read_device_times(file);
  ASSERT_TRUE(read.has_value());
  const screen::DeviceFactors factors = factors_of(*read, front);
  EXPECT_NEAR(factors.small[0], times.times[0].ms, 1e-9);
  EXPECT_NEAR(factors.large[0], *times.times[0].large_ms / 2.0, 1e-9);
  EXPECT_NEAR(factors.small[1], times.times[1].ms / 10.0, 1e-9);
  EXPECT_EQ(factors.large[1], factors.small[1]);
  std::ofstream(file) << "{\"volgi_times\": 1";
  EXPECT_THROW(read_device_times(file), Error);
  fs::remove_all(file.parent_path());
  EXPECT_FALSE(read_device_times(file).has_value());
}

TEST(DeviceTimes, OfASettingThatNobodyMeasuredAreTheFronts) {
  const screen::DeviceFactors factors = factors_of({"d", "m", "now", {{"cornell", "none", 3.0, 4.0}}}, tiny_front());
  EXPECT_NEAR(factors.small[0], 3.0, 1e-12);
  EXPECT_NEAR(factors.large[0], 2.0, 1e-12);
  EXPECT_EQ(factors.small[1], 1.0);
}

}  // namespace
}  // namespace volgi::app
