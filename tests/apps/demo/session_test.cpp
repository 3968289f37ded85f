// volgi-demo's viewer without its window: what is open, how it is rendered, and what a person can say to it.
#include "apps/demo/session.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <fstream>
#include <iterator>
#include <random>
#include <set>
#include <sstream>
#include <thread>

#include "apps/demo/camera_control.h"
#include "apps/demo/commands.h"
#include "apps/demo/keys.h"
#include "apps/demo/presets.h"
#include "apps/demo/render_command.h"
#include "apps/demo/viewer.h"
#include "apps/volgi/frame_options.h"
#include "apps/volgi/scene_options.h"
#include "core/gl/shader_source.h"
#include "propagation/volume_options.h"
#include "screen/frame/registry.h"
#include "tests/support/gl_test.h"
#include "tests/support/gltf_writer.h"
#include "tests/support/paths.h"

namespace volgi::demo {
namespace {

namespace fs = std::filesystem;

fs::path cornell() { return test::source_dir() / "data" / "cornell.glb"; }

/// Frames in a few milliseconds.
Settings quick() {
  Settings s;
  s.progressive = false;
  s.motion_fps = 0.0;
  s.grid_fits_scene = false;
  screen::apply_recipe("hybrid", s.frame);
  s.frame.of<VolumeOptions>().grid_cells = 8;
  for (const char* text :
       {"vpl.count=32", "val.count=4", "val.map=16", "val.exact=0", "shadow.spot=64", "shadow.cube=32", "shadow.sun=64",
        "sky.parts=16", "sky.map=16", "sky.tolerance=0.2", "negative.count=8"})
    screen::set_parameter(s.frame.settings, text);
  return s;
}

double distance(const Image& a, const Image& b) {
  EXPECT_EQ(a.pixels.size(), b.pixels.size());
  double sum = 0.0;
  for (size_t k = 0; k < std::min(a.pixels.size(), b.pixels.size()); ++k)
    sum += double(glm::distance(a.pixels[k], b.pixels[k]));
  return sum / double(a.pixels.size());
}

bool all_finite(const Image& image) {
  return std::all_of(image.pixels.begin(), image.pixels.end(),
                     [](glm::vec3 p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); });
}

class DemoSession : public test::GlTest {
 protected:
  static constexpr glm::ivec2 SIZE{32, 24};

  void SetUp() override {
    GlTest::SetUp();
    if (IsSkipped() || HasFatalFailure()) return;
    viewer_ = std::make_unique<Viewer>(context(), quick(), fs::path(), app::LightOptions());
  }
  void TearDown() override {
    viewer_.reset();
    gl::set_shader_folder({});
    GlTest::TearDown();
  }

  Viewer& viewer() { return *viewer_; }
  Session& session() { return viewer_->session; }
  void open(const fs::path& file) {
    session().open({file});
    session().wait_for_scene();
    draw();
  }
  void draw(glm::ivec2 size = SIZE) {
    for (int k = 0; k < 100; ++k) {
      viewer_->draw(size);
      if (session().settled()) return;
    }
    FAIL() << "100 pictures, and there is still something to do";
  }
  void run(const std::string& line) {
    execute(*viewer_, line);
    draw();
  }
  /// Lets time pass until what is being read has come to something.
  void load() {
    while (session().loader().busy()) {
      viewer_->step(0.0);
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    draw();
  }
  Image image() { return session().picture().image(); }
  std::string last_error() {
    const auto& all = session().messages();
    const auto last = std::find_if(all.rbegin(), all.rend(), [](const Message& m) { return m.error; });
    return last == all.rend() ? std::string() : last->text;
  }
  std::vector<std::string> arguments() {
    return frame_arguments(session().settings().frame, session().settings().grid_fits_scene);
  }

 private:
  std::unique_ptr<Viewer> viewer_;
};

// --- undo

TEST(UndoList, StepsGoBackAndForth) {
  UndoList<int> list;
  EXPECT_FALSE(list.can_undo());
  list.add("a", 1);
  list.add("b", 2);
  EXPECT_EQ(list.undo(3), 2);
  EXPECT_EQ(list.undo(2), 1);
  EXPECT_FALSE(list.can_undo());
  EXPECT_EQ(list.redo(1), 2);
  EXPECT_EQ(list.redo(2), 3);
  EXPECT_FALSE(list.can_redo());
}

TEST(UndoList, ASliderThatIsDraggedIsOneStep) {
  UndoList<int> list;
  list.add("slider", 1);
  list.add("slider", 2);
  EXPECT_EQ(list.steps().size(), 1u);
  list.close();
  list.add("slider", 3);
  EXPECT_EQ(list.steps().size(), 2u);
  EXPECT_EQ(list.undo(4), 3);
  list.add("slider", 3);  // a step of its own, behind one that was undone
  EXPECT_EQ(list.steps().size(), 2u);
}

TEST(UndoList, AChangeForgetsWhatWasUndoneAndTheOldestGo) {
  UndoList<int> list;
  list.add("a", 1);
  list.undo(2);
  list.add("b", 1);
  EXPECT_FALSE(list.can_redo());
  for (int k = 0; k < 300; ++k) list.add(fmt::format("{}", k), k);
  EXPECT_EQ(list.steps().size(), UndoList<int>::MOST_STEPS);
  EXPECT_EQ(list.undo(300), 299);
}

// --- what there is to choose from

TEST(Presets, HaveOnlyWhatThereIs) {
  for (const Preset& preset : presets()) {
    Settings settings = quick();
    EXPECT_NO_THROW(apply_preset(preset.name, settings)) << preset.name;
    EXPECT_GE(preset.grid_cells, 0);
    EXPECT_LE(preset.grid_cells, VolumeOptions::kMaxGridCells);
    for (const std::string text : preset.parameters) {
      const screen::Parameter& p = screen::find_parameter(text.substr(0, text.find('=')));
      const std::optional<double> value = p.get(settings.frame.settings);
      ASSERT_TRUE(value) << text;
      EXPECT_GE(*value, p.least) << text;
      EXPECT_LE(*value, p.most) << text;
    }
  }
  Settings settings;
  EXPECT_THROW(apply_preset("magic", settings), Error);
}

TEST(Recipes, LeaveNothingOfTheOneBefore) {
  for (const screen::Recipe& from : screen::recipes()) {
    for (const screen::Recipe& to : screen::recipes()) {
      screen::FrameOptions options, fresh;
      take_recipe(from.name, options);
      options.without = {"something"};
      take_recipe(to.name, options);
      take_recipe(to.name, fresh);
      EXPECT_EQ(frame_arguments(options, true), frame_arguments(fresh, true)) << from.name << " to " << to.name;
    }
  }
  screen::FrameOptions chosen;
  take_recipe("volume", chosen);
  chosen.of<VolumeOptions>().scheme.scheme = Scheme::conservative;
  screen::set_parameter(chosen.settings, "vpl.count=77");
  take_recipe("hybrid", chosen);
  EXPECT_EQ(chosen.of<VolumeOptions>().scheme.scheme, Scheme::conservative);
  EXPECT_EQ(screen::find_parameter("vpl.count").get(chosen.settings), 77.0);
}

TEST(Keys, EachIsBoundOnceAndToACommandThatThereIs) {
  std::set<std::tuple<int, bool, bool>> keys;
  std::set<std::string> names;
  for (const Command& command : commands()) EXPECT_TRUE(names.insert(command.name).second) << command.name;
  for (const KeyBinding& binding : key_bindings()) {
    const Key key = parse_key(binding.key);
    EXPECT_TRUE(keys.insert({key.key, key.control, key.shift}).second) << binding.key;
    const std::string line = binding.command;
    EXPECT_TRUE(names.contains(line.substr(0, line.find(' ')))) << line;
  }
  // Those that fly are nobody else's.
  for (const char fly : {'W', 'A', 'S', 'D', 'Q', 'E'}) {
    EXPECT_FALSE(keys.contains({fly, false, false})) << fly;
    EXPECT_FALSE(keys.contains({fly, false, true})) << fly;
  }
  for (const ViewInfo& view : views()) {
    const auto bindings = key_bindings();
    const auto bound = std::find_if(bindings.begin(), bindings.end(), [&](const KeyBinding& b) {
      return std::string(b.command) == std::string("view ") + view.name;
    });
    ASSERT_NE(bound, bindings.end()) << view.name;
    EXPECT_STREQ(bound->key, view.key);
    EXPECT_EQ(view_of(view.name), view.view);
    EXPECT_EQ(&info(view.view), &view);
  }
}

// --- changes

TEST_F(DemoSession, UndoAndRedo) {
  open(cornell());
  const auto before = arguments();
  run("set vpl.count=40");
  run("set vpl.count=48");
  run("bounces 2");
  const auto after = arguments();
  EXPECT_EQ(session().undo_list().steps().size(), 2u);
  run("bookmark door");  // is no step
  run("undo");
  run("undo");
  EXPECT_EQ(arguments(), before);
  EXPECT_EQ(viewer().bookmarks().size(), 1u);
  run("undo");  // there is nothing more
  EXPECT_EQ(arguments(), before);
  run("redo");
  run("redo");
  EXPECT_EQ(arguments(), after);
  EXPECT_EQ(viewer().bookmarks().size(), 1u);
}

TEST_F(DemoSession, AChangeThatIsRefusedLeavesTheOldState) {
  open(cornell());
  const auto before = arguments();
  const Image picture = image();
  const std::uint64_t frames = session().frames();
  execute(viewer(), "scheme lpv2009");  // has no orders, which hybrid needs
  EXPECT_NE(last_error().find("scheme"), std::string::npos) << last_error();
  draw();
  EXPECT_EQ(arguments(), before);
  EXPECT_TRUE(session().undo_list().steps().empty());
  EXPECT_EQ(session().frames(), frames);
  EXPECT_EQ(distance(image(), picture), 0.0);
  for (const char* line : {"stage lights/rsm off", "stage nothing off"}) {
    execute(viewer(), line);
    draw();
    EXPECT_EQ(arguments(), before) << line;
  }
  for (const char* line : {"set vpl.count=0", "set nonsense=1", "grid 0", "view inside-out", "recipe magic", "frob"})
    EXPECT_THROW(execute(viewer(), line), Error) << line;
  EXPECT_EQ(arguments(), before);
}

TEST_F(DemoSession, AFrameThatIsTooLargeLeavesTheOldOne) {
  open(cornell());
  const Image picture = image();
  Settings large = session().settings();
  large.frame.of<VolumeOptions>().grid_cells = 256;
  large.frame.of<VolumeOptions>().memory_limit = 1u << 20;
  session().change("grid", large);
  draw();
  EXPECT_NE(last_error().find("--memory-limit"), std::string::npos) << last_error();
  EXPECT_EQ(session().settings().frame.of<VolumeOptions>().grid_cells, 8);
  EXPECT_EQ(distance(image(), picture), 0.0);
  run("bounces 1");
  EXPECT_GT(distance(image(), picture), 0.0);
}

TEST_F(DemoSession, AFirstFrameThatFailsIsSaidOnceAndMended) {
  Settings large = quick();
  large.frame.of<VolumeOptions>().memory_limit = 1000;
  session().change("too little", large);
  session().open({cornell()});
  session().wait_for_scene();
  for (int k = 0; k < 5; ++k) viewer().draw(SIZE);
  EXPECT_FALSE(session().has_picture());
  ASSERT_TRUE(session().failure());
  EXPECT_EQ(session().failure()->code(), ExitCode::over_limit);
  EXPECT_EQ(session().said(), 1u);
  EXPECT_TRUE(session().settled());
  session().change("enough", quick());
  draw();
  EXPECT_FALSE(session().failure());
  EXPECT_TRUE(session().has_picture());
}

TEST_F(DemoSession, MessagesAreForgottenButCounted) {
  for (int k = 0; k < 250; ++k) session().say(fmt::format("{}", k));
  EXPECT_EQ(session().said(), 250u);
  EXPECT_LE(session().messages().size(), 100u);
  EXPECT_EQ(session().messages().back().text, "249");
}

// --- pictures

TEST_F(DemoSession, AnAverageGrowsWhileNothingMovesAndBeginsAnew) {
  open(cornell());
  run("average 4");
  EXPECT_EQ(session().picture().samples(), 4);
  const std::uint64_t frames = session().frames();
  viewer().draw(SIZE);
  EXPECT_EQ(session().frames(), frames);
  const std::uint64_t version = session().picture_version();
  session().set_camera(orbited(session().camera(), glm::vec3(0.0f), 0.1, 0.0));
  viewer().draw(SIZE);
  EXPECT_EQ(session().picture().samples(), 1);
  EXPECT_NE(session().picture_version(), version);
  draw();
  EXPECT_EQ(session().picture().samples(), 4);
  run("average off");
  EXPECT_EQ(session().picture().samples(), 1);
}

TEST_F(DemoSession, SizesFollowTheWindow) {
  open(cornell());
  for (const glm::ivec2 size : {glm::ivec2(1, 1), glm::ivec2(64, 1), glm::ivec2(1, 48), SIZE}) {
    draw(size);
    EXPECT_EQ(session().size(), size);
    EXPECT_TRUE(all_finite(image()));
  }
  const std::uint64_t frames = session().frames();
  viewer().draw({0, 0});  // minimised
  EXPECT_EQ(session().frames(), frames);
  EXPECT_EQ(session().size(), SIZE);
}

TEST_F(DemoSession, EveryViewOfEveryRecipe) {
  open(cornell());
  for (const screen::Recipe& recipe : screen::recipes()) {
    run(std::string("recipe ") + recipe.name);
    for (const ViewInfo& view : views()) {
      run(std::string("view ") + view.name);
      EXPECT_EQ(session().view(), view.view);
      EXPECT_TRUE(session().has_picture());
      why_not(view.view, session().frame());
    }
  }
  EXPECT_EQ(last_error(), "");
}

TEST_F(DemoSession, LayersGoUpAndDownByTheirKeys) {
  open(cornell());
  const auto bindings = key_bindings();
  const auto press = [&](std::string_view key) {
    const auto bound =
        std::find_if(bindings.begin(), bindings.end(), [&](const KeyBinding& b) { return key == b.key; });
    ASSERT_NE(bound, bindings.end());
    run(bound->command);
  };
  run("view cluster_maps");
  for (const auto& [key, layer] : {std::pair{"]", 1}, {"]", 2}, {"[", 1}, {"[", 0}, {"[", 0}}) {
    press(key);
    EXPECT_EQ(session().details().layer, layer);
  }
}

/// Those that write files aside, with a light taken and a camera kept.
TEST_F(DemoSession, EveryKeyDoesSomethingWithoutAnError) {
  open("builtin:metaballs");
  run("light next");
  run("bookmark");
  for (const KeyBinding& binding : key_bindings()) {
    const std::string line = binding.command;
    if (line == "screenshot" || line == "settings save" || line == "camera next" || line == "reload") continue;
    EXPECT_NO_THROW(execute(viewer(), line)) << binding.key << ": " << line;
    viewer().draw(SIZE);
    if (line == "play") run("time 0");
    if (line == "record") {
      viewer().step(0.1);
      run("record");
    }
    if (line == "replay") run("replay");
    EXPECT_EQ(last_error(), "") << binding.key << ": " << line;
    if (line == "light delete") run("light reset");
  }
}

// --- files

TEST_F(DemoSession, WhatCannotBeReadLeavesTheOldScene) {
  open(cornell());
  const Image picture = image();
  const test::TemporaryFolder folder;
  test::write_bytes(folder / "broken.glb", "glTF and nothing more");
  test::GltfWriter empty;
  empty.save_glb(folder / "empty.glb");
  for (const char* name : {"broken.glb", "missing.glb", "empty.glb"}) {
    session().open({folder / name});
    load();
    EXPECT_NE(last_error().find(name), std::string::npos) << last_error();
    if (name == std::string("empty.glb")) continue;  // beside something it is right
    session().append(folder / name);
    load();
    EXPECT_EQ(session().document().title(), "cornell.glb");
  }
  session().open({"builtin:nothing"});
  load();
  EXPECT_NE(last_error().find("builtin:nothing"), std::string::npos) << last_error();
  EXPECT_EQ(distance(image(), picture), 0.0);
}

TEST_F(DemoSession, FilesBesideEachOther) {
  open(cornell());
  const size_t triangles = session().document().scene().triangle_count();
  const test::TemporaryFolder folder;
  test::GltfWriter one;
  one.triangle();
  one.save_glb(folder / "one.glb");
  const glm::dvec3 eye =
      glm::dvec3(session().camera().world_from_camera[3]) + session().document().scene().world_origin;
  session().append(folder / "one.glb");
  session().append(folder / "one.glb");  // while the first is being read
  load();
  EXPECT_EQ(session().document().scene().triangle_count(), triangles + 2);
  const glm::dvec3 now =
      glm::dvec3(session().camera().world_from_camera[3]) + session().document().scene().world_origin;
  EXPECT_LT(glm::distance(eye, now), 1e-5);
  EXPECT_EQ(session().settings().recent_files.size(), 2u);
  EXPECT_THROW(render_command(session(), "x.png", {}), Error);  // `volgi render` takes one file
}

TEST_F(DemoSession, TheNewestRequestWins) {
  open(cornell());
  const test::TemporaryFolder folder;
  test::GltfWriter one;
  one.triangle();
  one.save_glb(folder / "one.glb");
  session().open({"builtin:metaballs"});
  session().open({folder / "missing.glb"});
  session().open({folder / "one.glb"});
  load();
  EXPECT_EQ(session().document().title(), "one.glb");
  EXPECT_EQ(last_error(), "");
}

// --- light and time

TEST(DemoDocument, EditsOfLightSurviveAnimation) {
  Document document({"builtin:metaballs"}, {});
  ASSERT_TRUE(document.animated());
  ASSERT_FALSE(document.lights().empty());
  const size_t count = document.lights().size();
  const auto positions = [&] {
    std::vector<glm::vec3> list;
    for (const Light& light : document.lights()) list.push_back(light.position);
    return list;
  };
  const std::vector<glm::vec3> of_file = positions();
  Light moved = document.lights()[0];
  moved.position += glm::vec3(0.1f, 0.2f, 0.3f);
  document.set_light(0, moved);
  Light more;
  more.position = glm::vec3(0.5f);
  more.intensity = glm::vec3(2.0f);
  EXPECT_EQ(document.add_light(more), count);
  document.set_emission(0, glm::vec3(3.0f));
  EXPECT_TRUE(document.light_changed());
  for (const double time : {0.5, 1.25, 0.0}) {
    document.move(time);
    ASSERT_EQ(document.lights().size(), count + 1);
    EXPECT_EQ(document.lights()[0].position, moved.position);
    EXPECT_EQ(document.lights()[count].position, more.position);
    EXPECT_EQ(document.scene().materials[0].emissive_radiance, glm::vec3(3.0f));
  }
  document.remove_light(0);
  document.move(0.75);
  ASSERT_EQ(document.lights().size(), count);
  EXPECT_EQ(document.lights().back().position, more.position);
  more.position = glm::vec3(0.25f);
  document.set_light(count - 1, more);
  document.set_sky("0.1,0.2,0.3", 20.0);
  document.move(1.5);
  EXPECT_EQ(document.lights().back().position, more.position);
  EXPECT_TRUE(document.scene().sky);
  document.reset_light();
  document.move(0.0);
  EXPECT_EQ(positions(), of_file);
  EXPECT_FALSE(document.light_changed());
  EXPECT_EQ(document.scene().materials[0].emissive_radiance, glm::vec3(0.0f));
}

TEST(DemoDocument, ASkyThatCannotBeLeavesTheOldOne) {
  Document document({cornell()}, {});
  document.set_sky("0.1,0.2,0.3", 20.0);
  EXPECT_THROW(document.set_sky("nothing.exr", 0.0), Error);
  EXPECT_THROW(document.set_sky("sun:up", 0.0), Error);
  EXPECT_EQ(document.sky(), "0.1,0.2,0.3");
  EXPECT_EQ(document.sky_rotate_deg(), 20.0);
  EXPECT_TRUE(document.scene().sky);
}

TEST_F(DemoSession, PlayingGoesRoundAndRound) {
  open("builtin:metaballs");
  const double duration = session().document().duration_s();
  ASSERT_GT(duration, 0.0);
  execute(viewer(), "play on");
  for (int k = 0; k < 5; ++k) {
    viewer().step(0.4 * duration);
    viewer().draw(SIZE);
    EXPECT_LE(session().document().time_s(), duration);
    EXPECT_FALSE(session().settled());
  }
  EXPECT_NEAR(session().document().time_s(), 0.0, 1e-6);
  execute(viewer(), "play off");
  draw();
}

// --- shaders

class DemoShaders : public DemoSession {
 protected:
  void SetUp() override {
    DemoSession::SetUp();
    fs::copy(test::source_dir() / "shaders", folder_.path(),
             fs::copy_options::recursive | fs::copy_options::overwrite_existing);
    gl::set_shader_folder(folder_.path());
  }
  /// Puts a text in place of another one. @returns the line where it stands.
  int edit(const std::string& name, const std::string& from, const std::string& to) {
    std::ifstream in(folder_ / name);
    std::string text{std::istreambuf_iterator<char>(in), {}};
    const size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << name << ": " << from;
    text.replace(at, from.size(), to);
    std::ofstream(folder_ / name) << text;
    return 1 + int(std::count(text.begin(), text.begin() + std::ptrdiff_t(at), '\n'));
  }
  void break_and_mend(const std::string& name) {
    open(cornell());
    const Image picture = image();
    const std::uint64_t frames = session().frames();
    const int line = edit(name, "void main()", "oh void main()");
    run("shaders");
    EXPECT_NE(last_error().find(name), std::string::npos) << last_error();
    EXPECT_NE(last_error().find(fmt::format("{}", line)), std::string::npos) << line << " in " << last_error();
    EXPECT_TRUE(session().has_picture());
    EXPECT_EQ(distance(image(), picture), 0.0);
    const size_t said = session().said();
    session().set_camera(session().camera());
    draw();
    EXPECT_EQ(session().said(), said) << last_error();  // once is enough
    EXPECT_TRUE(session().has_picture());
    edit(name, "oh void main()", "void main()");
    run("shaders");
    EXPECT_EQ(session().said(), said) << last_error();
    EXPECT_GT(session().frames(), frames);
    EXPECT_TRUE(session().has_picture());
  }

 private:
  test::TemporaryFolder folder_;
};

TEST_F(DemoShaders, AMistakeInThePictureIsAMessage) { break_and_mend("screen/base/direct.frag.glsl"); }
TEST_F(DemoShaders, AMistakeInAStageIsAMessage) { break_and_mend("screen/gather/multires/light_cut.comp.glsl"); }
TEST_F(DemoShaders, AMistakeInTheDisplayIsAMessage) { break_and_mend("screen/display/present.frag.glsl"); }

TEST_F(DemoShaders, WhatIsWrittenIsSeen) {
  open(cornell());
  const Image picture = image();
  edit("screen/base/compose.frag.glsl", "void main() {", "void main() {\n  if (gl_FragCoord.x > 0.0) discard;");
  run("shaders");
  EXPECT_EQ(last_error(), "");
  EXPECT_GT(distance(image(), picture), 0.0);
}

// --- the command of a picture

struct RenderArguments {
  app::SceneOptions scene;
  app::FrameCommandOptions frame;
  std::string out, exposure;
  int samples = 0;
  bool whole_animation = false;
};

/// What `volgi render` makes of a command; without quotes in it.
RenderArguments parsed(const std::string& command) {
  std::istringstream words(command);
  std::vector<std::string> arguments{std::istream_iterator<std::string>(words), {}};
  EXPECT_EQ(arguments[0] + " " + arguments[1], "volgi render");
  arguments.erase(arguments.begin(), arguments.begin() + 2);
  std::reverse(arguments.begin(), arguments.end());
  RenderArguments out;
  CLI::App app;
  out.scene.add_to(app);
  out.frame.add_to(app);
  app.add_option("-o", out.out);
  app.add_option("--exposure", out.exposure);
  app.add_option("--samples", out.samples);
  app.add_flag("--whole-animation", out.whole_animation);
  app.parse(arguments);
  return out;
}

TEST_F(DemoSession, CommandsOfPicturesSayAllOfIt) {
  open("builtin:metaballs");
  for (const char* line : {"time 0.5",
                           "recipe volume",
                           "scheme conservative",
                           "sh-order 2",
                           "bounces 3",
                           "iterations 40",
                           "recipe hybrid",
                           "scheme ordinates",
                           "directions 48",
                           "iterations auto",
                           "set grid.shift=0.123456789",
                           "set vpl.flux=flux",
                           "set vpl.near=12.5",
                           "part indirect",
                           "backend cpu",
                           "grid auto",
                           "exposure -1.25",
                           "recipe negative",
                           "stage visibility/negative off",
                           "sky 0.1,0.2,0.3",
                           "sky-rotate 33",
                           "light take 0",
                           "light move 0.1,0.1,0.1",
                           "preset fast",
                           "look 0,1,2.5 0.1,0.9,0 55",
                           "average 3"}) {
    run(line);
    SCOPED_TRACE(line);
    EXPECT_EQ(last_error(), "");
    const bool lit = session().document().light_changed();
    const RenderArguments made = parsed(render_command(session(), "some.png", lit ? "lights.json" : ""));
    screen::FrameOptions frame = made.frame.frame_options(SIZE);
    EXPECT_EQ(frame_arguments(frame, !made.frame.volume.grid_cells), arguments());
    EXPECT_EQ(made.scene.scene_path, "builtin:metaballs");
    EXPECT_EQ(made.scene.size(), SIZE);
    EXPECT_EQ(made.scene.time_s, session().document().time_s());
    EXPECT_TRUE(made.whole_animation);
    EXPECT_EQ(made.samples, session().picture().samples());
    EXPECT_EQ(made.scene.light.lights, fs::path(lit ? "lights.json" : ""));
    EXPECT_EQ(made.scene.light.sky, session().document().sky());
    EXPECT_EQ(made.scene.light.sky_rotate_deg, session().document().sky_rotate_deg());
    const Camera camera = made.scene.camera(session().document().scene());
    EXPECT_EQ(camera.world_from_camera, session().camera().world_from_camera);
    EXPECT_EQ(camera.yfov_rad, session().camera().yfov_rad);
  }
}

TEST_F(DemoSession, NamesAreQuotedForAShell) {
  const test::TemporaryFolder folder;
  test::GltfWriter one;
  one.triangle();
  one.save_glb(folder / "it's a room.glb");
  open(folder / "it's a room.glb");
  EXPECT_NE(render_command(session(), "a b.png", {}).find("it'\\''s a room.glb' -o 'a b.png'"), std::string::npos);
}

#ifdef VOLGI_WINDOW_TESTS  // minutes
// --- anything at all

/// A line that a command takes, mostly; refusals are part of it.
std::string random_line(std::mt19937& random) {
  const auto of = [&](std::initializer_list<const char*> words) {
    return std::string(*(words.begin() + std::ptrdiff_t(random() % words.size())));
  };
  const auto recipes = screen::recipes();
  switch (random() % 20) {
    case 0:
      return std::string("recipe ") + recipes[random() % recipes.size()].name;
    case 1:
      return "stage " + std::string(screen::stage_types()[random() % screen::stage_types().size()]->name) + " toggle";
    case 2:
      return "grid " + of({"auto", "1", "2", "3", "7", "12"});
    case 3:
      return "scheme " + of({"ordinates", "ordinates", "conservative", "gaitatzes2010", "lpv2009"});
    case 4:
      return "directions " + of({"auto", "8", "24"});
    case 5:
      return "sh-order " + of({"1", "2"});
    case 6:
      return "bounces " + of({"all", "0", "1", "3"});
    case 7:
      return "part " + of({"full", "direct", "indirect"});
    case 8:
      return of({"undo", "undo", "redo"});
    case 9:
      return "preset fast";
    case 10:
      return "view " + std::string(views()[random() % views().size()].name);
    case 11:
      return of({"light next", "light add point", "light add spot", "light add sun", "light delete", "light reset"});
    case 12:
      return "sky " + of({"none", "0.2,0.3,0.4", "sun:30,60"});
    case 13:
      return of({"average 2", "average off", "filter", "exposure 1", "exposure auto", "reset", "backend cpu",
                 "motion 1000", "motion off"});
    case 14:
      return of({"orbit 20,5", "orbit -70,-30", "frame", "camera 0", "yfov 30", "yfov 100"});
    default: {  // a parameter, within its range, where pictures stay small
      const auto all = screen::parameters();
      const screen::Parameter& p = *all[random() % all.size()];
      if (!p.value_names.empty())
        return fmt::format("set {}={}", p.name, p.value_names[random() % p.value_names.size()]);
      const double most = std::min(p.most, std::max(p.least + 1.0, 48.0));
      const double value = p.least + (most - p.least) * double(random() % 1001) / 1000.0;
      return p.whole ? fmt::format("set {}={}", p.name, int(value)) : fmt::format("set {}={:.4f}", p.name, value);
    }
  }
}

TEST_F(DemoSession, AThousandRandomChanges) {
  open(cornell());
  const Image picture = image();
  std::mt19937 random(20);
  int refused = 0;
  std::string trace;
  for (int k = 0; k < 1000; ++k) {
    const std::string line = random_line(random);
    trace = line + "; " + trace.substr(0, 600);
    SCOPED_TRACE(trace);
    try {
      execute(viewer(), line);
    } catch (const Error& error) {
      ++refused;
      EXPECT_EQ(error.code(), ExitCode::usage) << error.what();
    }
    viewer().step(0.01);
    // Frames are in flight: not all changes are seen.
    if (random() % 5 != 0) continue;
    viewer().draw(random() % 16 == 0 ? glm::ivec2(1 + int(random() % 40), 1 + int(random() % 30)) : SIZE);
    ASSERT_FALSE(session().failure()) << session().failure()->what();
    ASSERT_TRUE(session().has_picture());
    if (HasFailure()) break;
  }
  EXPECT_LT(refused, 300);
  execute(viewer(), "light reset");
  execute(viewer(), "sky none");
  execute(viewer(), "camera 0");
  session().change("as it was", quick());
  draw();
  EXPECT_EQ(distance(image(), picture), 0.0);
}
#endif

}  // namespace
}  // namespace volgi::demo
