#include "apps/demo/camera_path.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <functional>
#include <glm/gtc/constants.hpp>
#include <iterator>
#include <random>

#include "core/error.h"

namespace volgi::demo {
namespace {

glm::dquat looking(double yaw_rad, double pitch_rad) {
  return glm::angleAxis(yaw_rad, glm::dvec3(0, 1, 0)) * glm::angleAxis(pitch_rad, glm::dvec3(1, 0, 0));
}

double angle(const glm::dquat& a, const glm::dquat& b) {
  const glm::dquat d = glm::conjugate(a) * b;
  return 2.0 * std::atan2(glm::length(glm::dvec3(d.x, d.y, d.z)), std::abs(d.w));
}

/// Unevenly spaced, gentle, far from the origin.
CameraKey winding(double t) {
  CameraKey key;
  key.time_s = t;
  key.pose.position = {1e5 + 3.0 * std::sin(t), 1.5 + 0.2 * t, 4.0 * std::cos(0.7 * t)};
  key.pose.orientation = looking(0.5 * t, 0.4 * std::sin(1.3 * t));
  key.pose.yfov_rad = 0.8 + 0.2 * std::sin(t);
  key.scene_time_s = 2.0 * t + 1.0;
  return key;
}

CameraPath winding_path(double step) {
  std::vector<CameraKey> keys;
  for (int i = 0; step * i < 10.0; ++i) keys.push_back(winding(step * (i + 0.3 * std::sin(double(i)))));
  return CameraPath(keys);
}

void expect_near(const CameraKey& a, const CameraKey& b, double tolerance) {
  EXPECT_LT(glm::distance(a.pose.position, b.pose.position), tolerance);
  EXPECT_LT(angle(a.pose.orientation, b.pose.orientation), tolerance);
  EXPECT_NEAR(a.pose.yfov_rad, b.pose.yfov_rad, tolerance);
  EXPECT_NEAR(a.scene_time_s, b.scene_time_s, tolerance);
}

TEST(CameraPath, PassesThroughItsKeysAndHoldsItsEnds) {
  const CameraPath path = winding_path(0.5);
  for (const CameraKey& key : path.keys()) expect_near(path.at(key.time_s), key, 1e-9);
  expect_near(path.at(-100.0), path.keys().front(), 1e-12);
  expect_near(path.at(+100.0), path.keys().back(), 1e-12);
  EXPECT_EQ(path.at(100.0).time_s, 100.0);
  const CameraPath one({winding(2.0)});
  expect_near(one.at(7.0), winding(2.0), 1e-12);
}

// The error of cubic interpolation with tangents of second order is O(h³).
TEST(CameraPath, FollowsTheCurveThatItsKeysAreOf) {
  const auto worst = [](double step) {
    const CameraPath path = winding_path(step);
    double most = 0.0;
    for (double t = 2.0; t < 8.0; t += 0.01) {
      const CameraKey made = path.at(t), exact = winding(t);
      most = std::max({most, glm::distance(made.pose.position, exact.pose.position),
                       angle(made.pose.orientation, exact.pose.orientation)});
    }
    return most;
  };
  const double coarse = worst(0.4), fine = worst(0.2);
  EXPECT_LT(coarse, 0.02);
  EXPECT_LT(fine, coarse / 5.0);
}

TEST(CameraPath, SpeedAndTurningRateDoNotJump) {
  const CameraPath path = winding_path(0.7);
  constexpr double h = 1e-5;
  for (size_t i = 1; i + 1 < path.keys().size(); ++i) {
    const double t = path.keys()[i].time_s;
    const CameraKey before = path.at(t - h), here = path.at(t), after = path.at(t + h);
    // Of rates about 3 m/s and 1 rad/s; a curvature of 10 /s² changes them by 1e-4.
    const glm::dvec3 in = (here.pose.position - before.pose.position) / h,
                     out = (after.pose.position - here.pose.position) / h;
    EXPECT_LT(glm::distance(in, out), 1e-3);
    const glm::dquat turn_in = glm::conjugate(before.pose.orientation) * here.pose.orientation,
                     turn_out = glm::conjugate(here.pose.orientation) * after.pose.orientation;
    EXPECT_LT(angle(turn_in, turn_out) / h, 1e-3);
  }
}

TEST(CameraPath, SteadyMotionStaysSteady) {
  std::vector<CameraKey> keys;
  for (const double t : {0.0, 0.3, 1.7, 2.0, 4.5}) {
    CameraKey key;
    key.time_s = t;
    key.pose.position = glm::dvec3(1, 2, 3) * t;
    key.pose.orientation = looking(0.4 * t, 0.0);
    key.pose.yfov_rad = std::exp(-0.1 * t);
    keys.push_back(key);
  }
  const CameraPath path(keys), smooth = path.smoothed(1.0);
  for (double t = 0.0; t <= 4.5; t += 0.05) {
    for (const CameraKey& made : {path.at(t), smooth.at(t)}) {
      EXPECT_LT(glm::distance(made.pose.position, glm::dvec3(1, 2, 3) * t), 1e-9);
      EXPECT_LT(angle(made.pose.orientation, looking(0.4 * t, 0.0)), 1e-7);
      EXPECT_NEAR(made.pose.yfov_rad, std::exp(-0.1 * t), 1e-9);
    }
  }
}

TEST(CameraPath, ACameraThatStandsDoesNotSwingBack) {
  std::vector<CameraKey> keys(4);
  for (size_t i = 0; i < 4; ++i) {
    keys[i].time_s = double(i);
    keys[i].pose.position.x = i < 2 ? 0.0 : double(i - 1);
  }
  const CameraPath path(keys);
  for (double t = 0.0; t < 3.0; t += 0.01) EXPECT_GE(path.at(t).pose.position.x, 0.0);
  EXPECT_EQ(path.at(0.6).pose.position.x, 0.0);
}

TEST(CameraPath, LevelKeysMakeALevelPath) {
  std::vector<CameraKey> keys(3);
  for (size_t i = 0; i < 3; ++i) {
    keys[i].time_s = double(i);
    keys[i].pose.orientation = looking(1.2 * double(i), i == 1 ? 0.9 : -0.6);
  }
  const CameraPath path(keys);
  for (double t = 0.0; t <= 2.0; t += 0.01) EXPECT_TRUE(is_level(path.at(t).pose.orientation));
  keys[1].pose.orientation = keys[1].pose.orientation * glm::angleAxis(0.3, glm::dvec3(0, 0, 1));
  EXPECT_FALSE(is_level(CameraPath(keys).at(0.5).pose.orientation));
}

TEST(CameraPath, OrientationsOfEitherSignAreTheSame) {
  std::vector<CameraKey> keys{winding(0.0), winding(1.0), winding(2.0)}, flipped = keys;
  flipped[1].pose.orientation = -flipped[1].pose.orientation;
  for (double t = 0.0; t < 2.0; t += 0.1)
    EXPECT_LT(angle(CameraPath(keys).at(t).pose.orientation, CameraPath(flipped).at(t).pose.orientation), 1e-7);
}

CameraPath shaken(double noise_m) {
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0.0, noise_m);
  std::vector<CameraKey> keys;
  for (int i = 0; i < 600; ++i) {
    CameraKey key = winding(i / 60.0);
    key.pose.position += glm::dvec3(noise(random), noise(random), noise(random));
    key.pose.orientation = key.pose.orientation * looking(noise(random), noise(random));
    keys.push_back(key);
  }
  return CameraPath(keys);
}

double rms_off(const CameraPath& path) {
  double sum = 0.0;
  for (const CameraKey& key : path.keys()) {
    const double off = glm::distance(key.pose.position, winding(key.time_s).pose.position);
    sum += off * off;
  }
  return std::sqrt(sum / double(path.keys().size()));
}

// White noise falls by sqrt(2 sqrt(pi) sigma f) = 3.8 at 60 keys a second; the curve's bend of 3 m/s² costs 3 sigma²/2.
TEST(CameraPath, SmoothingTakesNoiseAndKeepsEnds) {
  const CameraPath rough = shaken(0.05), smooth = rough.smoothed(0.07);
  EXPECT_LT(rms_off(smooth), rms_off(rough) / 3.0);
  expect_near(smooth.keys().front(), rough.keys().front(), 1e-12);
  expect_near(smooth.keys().back(), rough.keys().back(), 1e-12);
  for (size_t i = 0; i < rough.keys().size(); ++i) {
    EXPECT_EQ(smooth.keys()[i].time_s, rough.keys()[i].time_s);
    EXPECT_EQ(smooth.keys()[i].scene_time_s, rough.keys()[i].scene_time_s);
  }
  EXPECT_EQ(rms_off(rough.smoothed(0.0)), rms_off(rough));
}

TEST(CameraPath, ThinningStaysWithinItsTolerance) {
  const CameraPath path = shaken(0.0);
  const PathTolerance tolerance{0.01, 0.01, 0.01};
  const CameraPath thin = path.thinned(tolerance);
  EXPECT_LT(thin.keys().size(), path.keys().size() / 10);
  for (const CameraKey& key : path.keys()) expect_near(thin.at(key.time_s), key, 0.01);
  // Nothing that is left is in the way of a tolerance of nothing, and a straight line needs two keys.
  EXPECT_GT(path.thinned({1e-9, 1e-9, 1e-9}).keys().size(), path.keys().size() / 2);
  std::vector<CameraKey> straight(50);
  for (size_t i = 0; i < straight.size(); ++i) {
    straight[i].time_s = straight[i].scene_time_s = 0.1 * double(i);
    straight[i].pose.position.z = 0.2 * double(i);
  }
  EXPECT_EQ(CameraPath(straight).thinned(tolerance).keys().size(), 2u);
}

TEST(CameraPath, RecordingReplacesWhatIsNotLater) {
  CameraPath path;
  for (const double t : {0.0, 1.0, 2.0, 1.0, 3.0}) path.add(winding(t));
  ASSERT_EQ(path.keys().size(), 3u);
  EXPECT_EQ(path.keys()[1].time_s, 1.0);
  EXPECT_EQ(path.first_time_s(), 0.0);
  EXPECT_EQ(path.last_time_s(), 3.0);
}

class CameraPathFile : public ::testing::Test {
 protected:
  std::filesystem::path file() const {
    const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
    return std::filesystem::path(::testing::TempDir()) / (std::string("path_") + info->name() + ".json");
  }
  void write(const std::string& text) const { std::ofstream(file()) << text; }
  std::string bytes() const {
    std::ifstream in(file());
    return {std::istreambuf_iterator<char>(in), {}};
  }
  std::string error_of(const std::string& text) const {
    write(text);
    try {
      read_camera_path(file());
    } catch (const Error& e) {
      EXPECT_EQ(e.code(), ExitCode::bad_input);
      return e.what();
    }
    return "no error";
  }
  void TearDown() override { std::filesystem::remove(file()); }
};

TEST_F(CameraPathFile, SamePathSameBytesAndBack) {
  CameraPath path = winding_path(0.5);
  write_camera_path(file(), path);
  const std::string first = bytes();
  const CameraPath again = read_camera_path(file());
  ASSERT_EQ(again.keys().size(), path.keys().size());
  for (size_t i = 0; i < path.keys().size(); ++i) {
    EXPECT_EQ(again.keys()[i].time_s, path.keys()[i].time_s);
    EXPECT_EQ(again.keys()[i].scene_time_s, path.keys()[i].scene_time_s);
    EXPECT_EQ(again.keys()[i].pose.position, path.keys()[i].pose.position);
    EXPECT_EQ(again.keys()[i].pose.orientation, path.keys()[i].pose.orientation);
    EXPECT_EQ(again.keys()[i].pose.yfov_rad, path.keys()[i].pose.yfov_rad);
  }
  write_camera_path(file(), again);
  EXPECT_EQ(bytes(), first);
}

const std::string KEY = R"("position": [1,2,3], "orientation": [0,0,0,1], "yfov_rad": 0.7)";

TEST_F(CameraPathFile, OrthographicKeysAndDefaults) {
  write(R"({"volgi_camera_path": 1, "later": 5, "keys": [
    {"time_s": 1, "position": [1,2,3], "orientation": [0,0,0,1], "ymag_m": 2.5, "comment": "x"},
    {"time_s": 2, "position": [1,2,3], "orientation": [0,0,0,1.0001], "ymag_m": 5, "scene_time_s": 0.5}]})");
  const CameraPath path = read_camera_path(file());
  EXPECT_EQ(path.keys()[0].scene_time_s, 1.0);
  EXPECT_EQ(path.keys()[1].scene_time_s, 0.5);
  EXPECT_NEAR(glm::length(path.keys()[1].pose.orientation), 1.0, 1e-15);
  EXPECT_NEAR(*path.at(1.5).pose.ymag_m, std::sqrt(2.5 * 5.0), 1e-9);
}

TEST_F(CameraPathFile, ErrorsNameFileAndElement) {
  const std::string head = R"({"volgi_camera_path": 1, "keys": [)";
  const std::string good = "{\"time_s\": 1, " + KEY + "}";
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"", "not JSON"},
      {"[]", "must be an object"},
      {"{}", "not a camera path"},
      {R"({"volgi_camera_path": 2, "keys": []})", "version 2 is newer"},
      {R"({"volgi_camera_path": "1", "keys": []})", "not a camera path"},
      {R"({"volgi_camera_path": 1})", "keys: is missing"},
      {R"({"volgi_camera_path": 1, "keys": []})", "keys: must be a list of one key or more"},
      {R"({"volgi_camera_path": 1, "keys": {}})", "keys: must be a list of one key or more"},
      {head + "7]}", "keys[0]: must be an object"},
      {head + "{" + KEY + "}]}", "keys[0].time_s: is missing"},
      {head + good + ",{\"time_s\": \"2\", " + KEY + "}]}", "keys[1].time_s: must be a number"},
      {head + good + ",{\"time_s\": null, " + KEY + "}]}", "keys[1].time_s: must be a number"},
      {head + good + ",{\"time_s\": NaN, " + KEY + "}]}", "not JSON"},
      {head + good + ",{\"time_s\": 1e999, " + KEY + "}]}", "a number is too large"},
      {head + good + "," + good + "]}", "keys[1]: time_s 1 is not after the 1 of the key before"},
      {head + R"({"time_s": 1, "orientation": [0,0,0,1], "yfov_rad": 1}]})", "keys[0].position: is missing"},
      {head + R"({"time_s": 1, "position": [1,2], "orientation": [0,0,0,1], "yfov_rad": 1}]})",
       "keys[0].position: must be a list of 3 numbers"},
      {head + R"({"time_s": 1, "position": [1,2,null], "orientation": [0,0,0,1], "yfov_rad": 1}]})",
       "keys[0].position: must be a list of 3 numbers"},
      {head + R"({"time_s": 1, "position": [1,2,3], "orientation": [0,0,0,0], "yfov_rad": 1}]})",
       "keys[0].orientation: must be a quaternion"},
      {head + R"({"time_s": 1, "position": [1,2,3], "orientation": [0,0,0,1]}]})", "keys[0].yfov_rad: is missing"},
      {head + R"({"time_s": 1, "position": [1,2,3], "orientation": [0,0,0,1], "yfov_rad": -1}]})",
       "keys[0].yfov_rad: must be a number from"},
      {head + good + R"(,{"time_s": 2, "position": [1,2,3], "orientation": [0,0,0,1], "ymag_m": 1}]})",
       "keys[1]: perspective and orthographic"},
  };
  for (const auto& [text, expected] : cases) {
    const std::string message = error_of(text);
    EXPECT_NE(message.find(file().string() + ": "), std::string::npos) << message;
    EXPECT_NE(message.find(expected), std::string::npos) << message << "\n  of " << text;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  }
  std::filesystem::remove(file());
  EXPECT_THROW(read_camera_path(file()), Error);
}

TEST_F(CameraPathFile, WhatCannotBeWrittenIsSaid) {
  try {
    write_camera_path("/no/such/folder/path.json", winding_path(1.0));
    FAIL();
  } catch (const Error& e) {
    EXPECT_EQ(e.code(), ExitCode::cannot_write);
  }
}

}  // namespace
}  // namespace volgi::demo
