#include "apps/demo/settings.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <random>

#include "apps/demo/view.h"
#include "core/error.h"
#include "propagation/volume_options.h"
#include "screen/frame/registry.h"

namespace volgi::demo {
namespace {

namespace fs = std::filesystem;

class DemoSettings : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::path(::testing::TempDir()) / (std::string("settings_") + info->name());
    fs::remove_all(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  fs::path file() const { return folder_ / "deep" / "er" / "demo.json"; }
  std::string bytes() const {
    std::ifstream in(file());
    return {std::istreambuf_iterator<char>(in), {}};
  }
  void put(const std::string& text) const {
    fs::create_directories(file().parent_path());
    std::ofstream(file()) << text;
  }
  std::string error_of(const std::string& text) const {
    put(text);
    try {
      read_settings(file());
    } catch (const Error& e) {
      EXPECT_EQ(e.code(), ExitCode::bad_input);
      return e.what();
    }
    return "no error";
  }
  fs::path folder_;
};

std::string texts_of(const screen::FrameOptions& options) {
  std::string out;
  for (const screen::Parameter* p : screen::parameters())
    out += std::string(p->name) + "=" + screen::value_text(*p, options.settings) + "\n";
  return out;
}

CameraPose some_pose(double x) {
  CameraPose pose;
  pose.position = {x, 1.0 / 3.0, -7e5};
  pose.orientation = glm::normalize(glm::dquat(0.9, 0.1 * x, 0.2, -0.3));
  pose.yfov_rad = 0.8;
  return pose;
}

Settings some_settings() {
  Settings s;
  screen::apply_recipe("hybrid", s.frame);
  s.frame.light = screen::LightPart::indirect;
  s.frame.backend = screen::Backend::cpu;
  s.frame.bounces = 3;
  screen::set_parameter(s.frame.settings, "grid.shift=0.123456");
  screen::set_parameter(s.frame.settings, "solver.warm=on");
  s.frame.of<VolumeOptions>().grid_cells = 48;
  s.frame.of<VolumeOptions>().scheme.directions = 24;
  s.grid_fits_scene = false;
  s.exposure_ev = -1.25;
  s.view = "normals";
  s.panels = {{"timings", true}, {"controls", false}};
  s.bookmarks["/scenes/a b.glb"] = {{"door", some_pose(1)}, {"apse", some_pose(2)}};
  s.bookmarks["builtin:metaballs"] = {{"door", some_pose(3)}};
  add_recent_file(s, "/scenes/a b.glb");
  add_recent_file(s, "builtin:metaballs");
  return s;
}

TEST_F(DemoSettings, NoFileIsDefaults) {
  const ReadSettings read = read_settings(file());
  EXPECT_TRUE(read.unknown.empty());
  EXPECT_TRUE(read.settings.frame.recipe.empty());
  EXPECT_EQ(texts_of(read.settings.frame), texts_of({}));
}

TEST_F(DemoSettings, RoundTripGivesTheSameValuesAndBytes) {
  const Settings s = some_settings();
  write_settings(file(), s);
  const std::string first = bytes();
  const ReadSettings read = read_settings(file());
  EXPECT_TRUE(read.unknown.empty());
  const Settings& r = read.settings;
  EXPECT_EQ(r.frame.recipe, "hybrid");
  EXPECT_EQ(r.frame.light, screen::LightPart::indirect);
  EXPECT_EQ(r.frame.backend, screen::Backend::cpu);
  EXPECT_EQ(r.frame.bounces, 3);
  EXPECT_EQ(texts_of(r.frame), texts_of(s.frame));
  EXPECT_EQ(r.frame.of<VolumeOptions>().grid_cells, 48);
  EXPECT_EQ(r.frame.of<VolumeOptions>().scheme.directions, 24);
  EXPECT_FALSE(r.frame.of<VolumeOptions>().iterations);
  EXPECT_FALSE(r.grid_fits_scene);
  EXPECT_EQ(r.exposure_ev, -1.25);
  EXPECT_EQ(r.view, "normals");
  EXPECT_EQ(r.panels, s.panels);
  EXPECT_EQ(r.recent_files, s.recent_files);
  ASSERT_EQ(r.bookmarks.size(), 2u);
  const std::vector<Bookmark>& list = r.bookmarks.at("/scenes/a b.glb");
  ASSERT_EQ(list.size(), 2u);
  EXPECT_EQ(list[0].name, "door");
  EXPECT_EQ(list[1].pose.position, some_pose(2).position);
  EXPECT_EQ(list[1].pose.orientation, some_pose(2).orientation);
  write_settings(file(), r);
  EXPECT_EQ(bytes(), first);
}

TEST_F(DemoSettings, ParametersAreWrittenWhereTheyAreSet) {
  Settings s;
  write_settings(file(), s);
  EXPECT_EQ(nlohmann::json::parse(bytes())["technique"]["parameters"].dump(), "{}");
  screen::set_parameter(s.frame.settings, "solver.cg=plain");
  write_settings(file(), s);
  EXPECT_EQ(nlohmann::json::parse(bytes())["technique"]["parameters"].dump(), R"({"solver.cg":"plain"})");
}

// A recipe's preset is neither lost nor written as if somebody had set it.
TEST_F(DemoSettings, RecipesKeepTheirPresets) {
  for (const screen::Recipe& recipe : screen::recipes()) {
    Settings s;
    screen::apply_recipe(recipe.name, s.frame);
    write_settings(file(), s);
    EXPECT_EQ(nlohmann::json::parse(bytes())["technique"]["parameters"].dump(), "{}") << recipe.name;
    const Settings r = read_settings(file()).settings;
    EXPECT_EQ(texts_of(r.frame), texts_of(s.frame)) << recipe.name;
    EXPECT_EQ(r.frame.of<VolumeOptions>().scheme.scheme, s.frame.of<VolumeOptions>().scheme.scheme) << recipe.name;
  }
}

TEST_F(DemoSettings, UnknownMembersAreNamedAndKeptInPlace) {
  Settings s = some_settings();
  write_settings(file(), s);
  auto json = nlohmann::ordered_json::parse(bytes());
  nlohmann::ordered_json with;
  with["from_the_future"] = {{"a", {1, 2, nullptr}}};
  for (const auto& [key, member] : json.items()) with[key] = member;
  with["technique"]["quality"] = "best";
  with["technique"]["volume"]["anisotropy"] = 0.5;
  with["technique"]["parameters"]["wavelets.count"] = "7";
  with["picture"]["bloom"] = true;
  with["fps_limits"]["on_battery"] = 20;
  with["benchmark"]["runs"] = 3;
  with["bookmarks"]["/scenes/a b.glb"]["apse"]["note"] = "nice";
  const std::string text = with.dump(2) + "\n";
  put(text);

  const ReadSettings read = read_settings(file());
  const std::vector<std::string> places = {"from_the_future",
                                           "technique.quality",
                                           "technique.volume.anisotropy",
                                           "technique.parameters.wavelets.count",
                                           "picture.bloom",
                                           "fps_limits.on_battery",
                                           "benchmark.runs",
                                           "bookmarks./scenes/a b.glb.apse.note"};
  ASSERT_EQ(read.unknown.size(), places.size());
  for (const std::string& place : places) {
    const std::string line = file().string() + ": " + place + ": unknown to this version, kept";
    EXPECT_EQ(std::count(read.unknown.begin(), read.unknown.end(), line), 1) << line;
  }
  write_settings(file(), read.settings);
  EXPECT_EQ(bytes(), text);

  // They stay when known values beside them change, and go with the bookmark that they belong to.
  Settings changed = read.settings;
  changed.exposure_ev.reset();
  changed.frame.settings = {};
  std::reverse(changed.bookmarks["/scenes/a b.glb"].begin(), changed.bookmarks["/scenes/a b.glb"].end());
  changed.bookmarks.erase("builtin:metaballs");
  write_settings(file(), changed);
  const auto after = nlohmann::ordered_json::parse(bytes());
  EXPECT_EQ(after.begin().key(), "from_the_future");
  EXPECT_EQ(after["technique"]["parameters"].dump(), R"({"wavelets.count":"7"})");
  EXPECT_EQ(after["picture"]["exposure_ev"], "auto");
  EXPECT_EQ(after["bookmarks"].size(), 1u);
  EXPECT_EQ(after["bookmarks"]["/scenes/a b.glb"].begin().key(), "apse");
  EXPECT_EQ(after["bookmarks"]["/scenes/a b.glb"]["apse"]["note"], "nice");
}

TEST_F(DemoSettings, WrongValuesAreRefusedByName) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"nonsense", "not JSON: wrong at byte"},
      {"[1]", "must be an object"},
      {"{}", "not settings of volgi-demo"},
      {R"({"volgi_demo": 0})", "not settings of volgi-demo"},
      {R"({"volgi_demo": 2})", "version 2 is newer than this program, which reads 1"},
      {R"({"volgi_demo": 1, "technique": 3})", "technique: must be an object"},
      {R"({"volgi_demo": 1, "technique": {"recipe": "magic"}})", "technique.recipe: --gi magic: no such recipe"},
      {R"({"volgi_demo": 1, "technique": {"recipe": 7}})", "technique.recipe: must be a text"},
      {R"({"volgi_demo": 1, "technique": {"backend": "tpu"}})", "technique.backend: 'tpu' is none of auto, gpu, cpu"},
      {R"({"volgi_demo": 1, "technique": {"light": "dim"}})", "technique.light: 'dim' is none of full"},
      {R"({"volgi_demo": 1, "technique": {"bounces": -1}})", "technique.bounces: must be a whole number from 0"},
      {R"({"volgi_demo": 1, "technique": {"bounces": "many"}})", "technique.bounces: must be a number or \"all\""},
      {R"({"volgi_demo": 1, "technique": {"bounces": 1.5}})", "technique.bounces: must be a whole number"},
      {R"({"volgi_demo": 1, "technique": {"volume": {"grid": 0}}})", "technique.volume.grid: must be a whole number"},
      {R"({"volgi_demo": 1, "technique": {"volume": {"grid": 4294967297}}})", "technique.volume.grid: must be"},
      {R"({"volgi_demo": 1, "technique": {"volume": {"scheme": "x"}}})", "technique.volume.scheme: no scheme 'x'"},
      {R"({"volgi_demo": 1, "technique": {"volume": {"directions": 9}}})",
       "technique.volume.directions: must be one of 8, 24, 48, 80, 128"},
      {R"({"volgi_demo": 1, "technique": {"volume": {"sh_order": 3}}})", "technique.volume.sh_order: must be"},
      {R"({"volgi_demo": 1, "technique": {"parameters": {"grid.shift": 1}}})",
       "technique.parameters.grid.shift: must be a text"},
      {R"({"volgi_demo": 1, "technique": {"parameters": {"grid.shift": "far"}}})",
       "technique.parameters.grid.shift: 'far': needs a number from -1 to 1"},
      {R"({"volgi_demo": 1, "picture": {"exposure_ev": true}})", "picture.exposure_ev: must be a number or \"auto\""},
      {R"({"volgi_demo": 1, "picture": {"exposure_ev": 1e999}})", "a number is too large"},
      {R"({"volgi_demo": 1, "picture": {"post_filter": "on"}})", "picture.post_filter: must be true or false"},
      {R"({"volgi_demo": 1, "picture": {"most_samples": 0}})", "picture.most_samples: must be a whole number"},
      {R"({"volgi_demo": 1, "fps_limits": {"active": -5}})", "fps_limits.active: must be a whole number from 0"},
      {R"({"volgi_demo": 1, "benchmark": {"frames": 0}})", "benchmark.frames: must be a whole number"},
      {R"({"volgi_demo": 1, "panels": {"timings": 1}})", "panels.timings: must be true or false"},
      {R"({"volgi_demo": 1, "panels": []})", "panels: must be an object"},
      {R"({"volgi_demo": 1, "recent_files": ["a", 3]})", "recent_files: must be a list of texts"},
      {R"({"volgi_demo": 1, "bookmarks": []})", "bookmarks: must be an object"},
      {R"({"volgi_demo": 1, "bookmarks": {"a.glb": 1}})", "bookmarks.a.glb: must be an object"},
      {R"({"volgi_demo": 1, "bookmarks": {"a.glb": {"door": {}}}})", "bookmarks.a.glb.door.position: is missing"},
      {R"({"volgi_demo": 1, "bookmarks": {"a.glb": {"door": {"position": [1,2,3], "orientation": [1,1,1,1],
          "yfov_rad": 1}}}})",
       "bookmarks.a.glb.door.orientation: must be a quaternion"},
  };
  for (const auto& [text, expected] : cases) {
    const std::string message = error_of(text);
    EXPECT_EQ(message.rfind(file().string() + ": ", 0), 0u) << message;
    EXPECT_NE(message.find(expected), std::string::npos) << message << "\n  of " << text;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  }
}

TEST_F(DemoSettings, WhatIsNotFiniteIsNotWritten) {
  Settings s = some_settings();
  write_settings(file(), s);
  const std::string before = bytes();
  s.bookmarks["builtin:metaballs"][0].pose.position.y = std::nan("");
  try {
    write_settings(file(), s);
    FAIL();
  } catch (const Error& e) {
    EXPECT_EQ(e.code(), ExitCode::cannot_write);
    EXPECT_NE(std::string(e.what()).find("bookmarks.builtin:metaballs.door.position[1]"), std::string::npos)
        << e.what();
  }
  EXPECT_EQ(bytes(), before);
}

TEST_F(DemoSettings, AFolderThatCannotBeMadeIsSaid) {
  fs::create_directories(folder_);
  std::ofstream(folder_ / "file") << "x";
  try {
    write_settings(folder_ / "file" / "demo.json", {});
    FAIL();
  } catch (const Error& e) {
    EXPECT_EQ(e.code(), ExitCode::cannot_write);
  }
}

TEST_F(DemoSettings, RecentFilesAreTenWithoutTwins) {
  Settings s;
  for (int i = 0; i < 14; ++i) add_recent_file(s, "scene" + std::to_string(i));
  add_recent_file(s, "scene9");
  ASSERT_EQ(s.recent_files.size(), 10u);
  EXPECT_EQ(s.recent_files[0], "scene9");
  EXPECT_EQ(s.recent_files[1], "scene13");
  EXPECT_EQ(std::count(s.recent_files.begin(), s.recent_files.end(), fs::path("scene9")), 1);
  put(R"({"volgi_demo": 1, "recent_files": ["a", "b", "a", "c"]})");
  EXPECT_EQ(read_settings(file()).settings.recent_files, (std::vector<fs::path>{"a", "b", "c"}));
}

/// Any settings that the window could have.
class AnySettings {
 public:
  explicit AnySettings(unsigned seed) : random_(seed) {}

  Settings operator()() {
    Settings s;
    const auto recipes = screen::recipes();
    if (chance()) screen::apply_recipe(recipes[size_t(whole(0, int(recipes.size()) - 1))].name, s.frame);
    s.frame.light = screen::LightPart(whole(0, 2));
    s.frame.backend = screen::Backend(whole(0, 2));
    if (chance()) s.frame.bounces = whole(0, 1000);
    for (int i = whole(0, 2); i > 0; --i) s.frame.without.push_back(text());
    for (const screen::Parameter* p : screen::parameters())
      if (chance()) p->set(s.frame.settings, p->whole ? whole(int(p->least), int(p->most)) : real(p->least, p->most));
    volume(s);
    picture(s);
    window(s);
    return s;
  }

 private:
  bool chance() { return whole(0, 1) != 0; }
  int whole(int least, int most) { return std::uniform_int_distribution<int>(least, most)(random_); }
  double real(double least, double most) { return std::uniform_real_distribution<double>(least, most)(random_); }
  std::string text() {
    static const std::vector<std::string> letters{"a", "Z", " ", "/", "\"", "\\", "é", "日", ".", "\n", "0", "~"};
    std::string out;
    for (int i = whole(1, 12); i > 0; --i) out += letters[size_t(whole(0, int(letters.size()) - 1))];
    return out;
  }

  void volume(Settings& s) {
    auto& v = s.frame.of<VolumeOptions>();
    s.grid_fits_scene = chance();
    if (!s.grid_fits_scene) v.grid_cells = whole(1, VolumeOptions::kMaxGridCells);
    v.scheme.scheme = Scheme(whole(0, 3));
    if (chance()) v.scheme.directions = std::array{8, 24, 48, 80, 128}[size_t(whole(0, 4))];
    v.scheme.sh_order = whole(1, 2);
    if (chance()) v.iterations = whole(1, 100000);
  }
  void picture(Settings& s) {
    s.view = views()[size_t(whole(0, int(views().size()) - 1))].name;
    s.motion_fps = real(0, 100);
    if (chance()) s.exposure_ev = real(-20, 20);
    s.post_filter = chance(), s.progressive = chance(), s.reference = chance();
    s.most_samples = whole(1, Settings::MOST_SAMPLES);
  }
  void window(Settings& s) {
    s.fps = {whole(0, 1000), whole(0, 100)};
    s.benchmark = {whole(0, 100), whole(1, 1000), whole(1, 16384), whole(1, 16384)};
    for (int i = whole(0, 4); i > 0; --i) s.panels[text()] = chance();
    for (int i = whole(0, 14); i > 0; --i) add_recent_file(s, text());
    for (int i = whole(0, 3); i > 0; --i) {
      std::map<std::string, CameraPose> named;
      for (int k = whole(0, 4); k > 0; --k) named[text()] = pose();
      std::vector<Bookmark>& list = s.bookmarks[text()];
      list.clear();
      for (const auto& [name, where] : named) list.push_back({name, where});
      std::shuffle(list.begin(), list.end(), random_);
    }
  }
  CameraPose pose() {
    CameraPose out;
    out.position = {real(-1e6, 1e6), real(-1, 1), real(-1e-9, 1e-9)};
    out.orientation = glm::normalize(glm::dquat(real(-1, 1), real(-1, 1), real(-1, 1), 0.1));
    if (chance()) {
      out.ymag_m = real(1e-3, 1e3);
    } else {
      out.yfov_rad = real(0.01, 3.1);
    }
    return out;
  }
  std::mt19937 random_;
};

TEST_F(DemoSettings, TwoHundredRandomSettingsComeBackTheSame) {
  AnySettings any(11);
  Settings before;
  for (int i = 0; i < 200; ++i) {
    const Settings s = any();
    write_settings(file(), s);
    const std::string first = bytes();
    const ReadSettings read = read_settings(file());
    ASSERT_TRUE(read.unknown.empty()) << read.unknown.front();
    const Settings& r = read.settings;
    for (const screen::Parameter* p : screen::parameters())
      ASSERT_EQ(p->get(r.frame.settings), p->get(s.frame.settings)) << p->name << "\n" << first;
    ASSERT_EQ(r.bookmarks.size(), s.bookmarks.size());
    ASSERT_EQ(r.recent_files, s.recent_files);
    ASSERT_EQ(r.exposure_ev, s.exposure_ev);
    write_settings(file(), r);
    ASSERT_EQ(bytes(), first);
    // Over a file that says something else, what is known of it goes.
    Settings over = s;
    over.as_read = before.as_read;
    write_settings(file(), over);
    const Settings after = read_settings(file()).settings;
    for (const screen::Parameter* p : screen::parameters())
      ASSERT_EQ(p->get(after.frame.settings), p->get(s.frame.settings)) << p->name;
    ASSERT_EQ(after.bookmarks.size(), s.bookmarks.size());
    before = r;
  }
}

TEST(DemoSettingsPath, FollowsTheEnvironment) {
  const auto saved = [](const char* name) { return std::getenv(name) != nullptr ? std::getenv(name) : std::string(); };
  const std::string config = saved("XDG_CONFIG_HOME"), home = saved("HOME");
  setenv("HOME", "/home/ada", 1);
  setenv("XDG_CONFIG_HOME", "/etc/ada", 1);
  EXPECT_EQ(default_settings_path(), "/etc/ada/volgi/demo.json");
  setenv("XDG_CONFIG_HOME", "relative", 1);
  EXPECT_EQ(default_settings_path(), "/home/ada/.config/volgi/demo.json");
  unsetenv("XDG_CONFIG_HOME");
  EXPECT_EQ(default_settings_path(), "/home/ada/.config/volgi/demo.json");
  unsetenv("HOME");
  EXPECT_TRUE(default_settings_path().empty());
  if (!home.empty()) setenv("HOME", home.c_str(), 1);
  if (!config.empty()) setenv("XDG_CONFIG_HOME", config.c_str(), 1);
}

}  // namespace
}  // namespace volgi::demo
