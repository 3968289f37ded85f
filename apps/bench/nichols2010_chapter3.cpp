#include <fmt/format.h>

#include <algorithm>
#include <glm/gtc/matrix_transform.hpp>

#include "apps/bench/nichols2010_internal.h"
#include "screen/frame/registry.h"
#include "screen/gather/subsplats/subsplat_refinement.h"

namespace volgi::app::nichols2010 {

namespace {

/// A scene of like kind for each of theirs.
struct TheirScene {
  const char* name;  // ours
  const char* theirs;
  int triangles;
  double fps[4];  // table 3.2, at 128^2, 256^2, 512^2 and 1024^2
};
constexpr TheirScene kScenes[] = {{"cornell", "simple teapot", 6300, {68, 50, 33, 22}},
                                  {"bunny", "spinning Buddha", 250000, {60, 42, 30, 24}},
                                  {"animal17k", "dragon & bunny", 405000, {59, 42, 28, 21}},
                                  {"arena", "flying bunnies", 417000, {52, 41, 31, 25}}};
constexpr const char* kSceneOfCurves = "animal17k";  // figures 3.7, 3.8 and 3.12: the dragon
constexpr const char* kSceneOfEachLight = "bunny";   // table 3.1: the Phong Buddha

/// Table 3.1: subsplats [thousands], ms and fps by resolution, 16^2 ... 256^2, and VPLs, 16^2 and 32^2. (Theirs goes on
/// to 128^2.)
struct EachLight {
  double thousands, refine_ms, fps;
};
constexpr EachLight kEachLight[5][2] = {{{65.5, 0.0, 95}, {262.1, 0.0, 60}},
                                        {{120.5, 3.9, 65}, {484.9, 28.0, 21}},
                                        {{220.4, 11.7, 52}, {893.9, 37.1, 14}},
                                        {{421.8, 17.7, 39}, {1730, 37.1, 14}},
                                        {{852.0, 35.3, 27}, {3220, 60.1, 8.9}}};

int longest(const Bench& bench) { return bench.options.sizes.back(); }
std::string scene_or(const Bench& bench, const char* usual) {
  return bench.options.quick || !bench.options.scenes.empty() ? bench.options.scenes.front() : std::string(usual);
}

/// Splatting at an indirect resolution of so many fragments along a side, of 16 at least.
screen::FrameOptions splatting(int size, int resolution, std::initializer_list<std::string> more) {
  screen::FrameOptions o = settings("multires", size, more);
  for (const std::string& s :
       {std::string("multires.sum=splat"), "multires.finest=" + std::to_string(size / resolution)})
    screen::set_parameter(o.settings, s);
  return o;
}

std::vector<int> resolutions(int size) {
  std::vector<int> all;
  for (const int r : {128, 256, 512, 1024}) {
    if (r <= size) all.push_back(r);
  }
  if (all.empty()) all.push_back(size);
  return all;
}

nlohmann::json table_3_1(const Bench& bench) {
  const Scene scene = bench.scene_by_name(scene_or(bench, kSceneOfEachLight));
  const int size = std::min(256, longest(bench)), grids = bench.options.quick ? 1 : 2;
  nlohmann::json rows = nlohmann::json::array();
  std::string text = fmt::format(
      "Table 3.1, {} {} x {}, subsplats of each VPL: thousands / refinement ms / frame ms; theirs in brackets, fps\n"
      "  resolution {:>36} {:>42}\n",
      scene.name, size, size, "16^2 VPLs", "32^2");
  for (int r = 0; r < 5 && (16 << r) <= size; ++r) {
    text += fmt::format("  {:4}^2    ", 16 << r);
    for (int g = 0; g < grids; ++g) {
      const EachLight& theirs = kEachLight[r][g];
      const screen::FrameOptions o = splatting(
          size, 16 << r, {"multires.each_light=on", "multires.difference=1e-4", set("patches.grid", 16 << g)});
      RepeatedFrame frame(scene, bench.context, o);
      frame.render();  // the one that compiles
      frame.forget_warm_up();
      frame.render();
      const double subsplats = double(frame.frame().report().number("fragments"));
      const double refine_ms = frame.passes_ms({screen::SubsplatRefinement::name});
      rows.push_back(
          {{"resolution", 16 << r},
           {"vpls_on_side", 16 << g},
           {"subsplats", subsplats},
           {"refine_ms", refine_ms},
           {"frame_ms", frame.frame_ms()},
           {"theirs", {{"thousands", theirs.thousands}, {"refine_ms", theirs.refine_ms}, {"fps", theirs.fps}}}});
      text += fmt::format("{:8.1f} /{:7.1f} /{:7.1f} ({:6.1f}/{:5.1f}/{:4.1f})", subsplats / 1000.0, refine_ms,
                          frame.frame_ms(), theirs.thousands, theirs.refine_ms, theirs.fps);
    }
    text += '\n';
  }
  bench.show(text);
  return {{"scene", scene.name}, {"rows", rows}};
}

nlohmann::json table_3_2(const Bench& bench) {
  nlohmann::json rows = nlohmann::json::array();
  const int size = longest(bench);
  std::string text =
      fmt::format("Table 3.2, {} x {}, 256 VPLs, splatting: fragments / indirect ms / fps (theirs)\n", size, size);
  for (const TheirScene& s : kScenes) {
    const auto& asked = bench.options.scenes;
    if (!asked.empty() && std::find(asked.begin(), asked.end(), s.name) == asked.end()) continue;
    const Scene scene = bench.scene_by_name(s.name);
    text += fmt::format("  {:10} ({}; theirs {}, {})", s.name, scene.triangle_count(), s.theirs, s.triangles);
    const std::vector<int> all = resolutions(size);
    for (size_t r = 0; r < all.size(); ++r) {
      const Timed t = timed(bench, scene, splatting(size, all[r], {}));
      rows.push_back({{"scene", s.name},
                      {"resolution", all[r]},
                      {"fragments", t.fragments},
                      {"indirect_ms", t.indirect_ms},
                      {"frame_ms", t.frame_ms},
                      {"theirs_fps", s.fps[r]}});
      text += fmt::format("  {}^2 {:.0f} /{:.0f} /{:.2f} ({:.0f})", all[r], t.fragments, t.indirect_ms,
                          1000.0 / t.frame_ms, s.fps[r]);
    }
    text += '\n';
  }
  bench.show(text);
  return rows;
}

/// The first camera, turned about the vertical axis through the middle of the scene.
Scene seen_from(Scene scene, float turn_rad) {
  const glm::vec3 middle = 0.5f * (scene.bounds_min + scene.bounds_max);
  const glm::mat4 turn = glm::translate(glm::mat4(1.0f), middle) *
                         glm::rotate(glm::mat4(1.0f), turn_rad, glm::vec3(0.0f, 1.0f, 0.0f)) *
                         glm::translate(glm::mat4(1.0f), -middle);
  scene.cameras.at(0).world_from_camera = turn * scene.cameras.at(0).world_from_camera;
  return scene;
}

/// Figure 3.7, and what each criterion errs against every pixel, which the thesis could not say.
nlohmann::json figure_3_7(const Bench& bench) {
  const Scene scene = bench.scene_by_name(scene_or(bench, kSceneOfCurves));
  const int size = bench.options.sizes.front();
  nlohmann::json rows = nlohmann::json::array();
  std::string text = fmt::format(
      "Figure 3.7, {} {} x {}, views turned by -20 ... 20 degrees: subsplats / indirect ms / RMS to every pixel, of "
      "the "
      "mean and of the range\n",
      scene.name, size, size);
  for (const char* criterion : {"depth,normal", "derivative,normal", "depth,curvature", "derivative,curvature"}) {
    text += fmt::format("  {:20}", criterion);
    for (const int degrees : {-20, -10, 0, 10, 20}) {
      const Scene view = seen_from(scene, glm::radians(float(degrees)));
      const screen::FrameOptions o = splatting(size, size, {"multires.criterion=" + std::string(criterion)});
      const Timed t = timed(bench, view, o);
      const Image every = picture(bench, view, settings("multires", size, {"multires.cells=16384"}));
      // The same subsplats, gathered.
      const Image some =
          picture(bench, view, settings("multires", size, {"multires.criterion=" + std::string(criterion)}));
      const nlohmann::json error = to_json(rms(every, some));
      rows.push_back({{"criterion", criterion},
                      {"turn_degrees", degrees},
                      {"fragments", t.fragments},
                      {"indirect_ms", t.indirect_ms},
                      {"rms", error}});
      text += fmt::format("  {:7.0f} /{:6.0f} /{}", t.fragments, t.indirect_ms, text_of(error));
      if (bench.options.quick) break;
    }
    text += '\n';
  }
  bench.show(text);
  return {{"scene", scene.name}, {"size", size}, {"rows", rows}};
}

nlohmann::json figure_3_8(const Bench& bench) {
  const Scene scene = bench.scene_by_name(scene_or(bench, kSceneOfCurves));
  const int size = bench.options.sizes.front();
  nlohmann::json rows = nlohmann::json::array();
  std::string text = fmt::format("Figure 3.8, {} {} x {}, by normal threshold: fragments / indirect ms, splatting\n",
                                 scene.name, size, size);
  for (const int resolution : resolutions(size)) {
    text += fmt::format("  {:4}^2 ", resolution);
    for (const double threshold : {0.05, 0.2, 0.5, 1.0, 1.5}) {
      const Timed t = timed(bench, scene, splatting(size, resolution, {set("multires.normal", threshold)}));
      rows.push_back({{"resolution", resolution},
                      {"threshold", threshold},
                      {"fragments", t.fragments},
                      {"indirect_ms", t.indirect_ms}});
      text += fmt::format("  {:4} {:7.0f} /{:6.0f}", threshold, t.fragments, t.indirect_ms);
      if (bench.options.quick) break;
    }
    text += '\n';
  }
  bench.show(text);
  return {{"scene", scene.name}, {"rows", rows}};
}

nlohmann::json figure_3_12(const Bench& bench) {
  const Scene scene = bench.scene_by_name(scene_or(bench, kSceneOfCurves));
  const int size = bench.options.sizes.front();
  nlohmann::json rows = nlohmann::json::array();
  std::string text = fmt::format("Figure 3.12, {} {} x {}, by number of VPLs: indirect ms, splatted / gathered\n",
                                 scene.name, size, size);
  for (const int resolution : resolutions(size)) {
    text += fmt::format("  {:4}^2 ", resolution);
    for (const int grid : {8, 16, 32}) {
      const std::string vpls = set("patches.grid", grid);
      const Timed splat = timed(bench, scene, splatting(size, resolution, {vpls}));
      screen::FrameOptions o = splatting(size, resolution, {vpls});
      screen::set_parameter(o.settings, "multires.sum=gather");
      const Timed gather = timed(bench, scene, o);
      rows.push_back({{"resolution", resolution},
                      {"vpls_on_side", grid},
                      {"splat_ms", splat.indirect_ms},
                      {"gather_ms", gather.indirect_ms}});
      text += fmt::format("  {:2}^2 {:7.0f} /{:6.0f}", grid, splat.indirect_ms, gather.indirect_ms);
      if (bench.options.quick) break;
    }
    text += '\n';
  }
  bench.show(text);
  return {{"scene", scene.name}, {"rows", rows}};
}

}  // namespace

nlohmann::json chapter_3(const Bench& bench) {
  return {{"table_3_1", table_3_1(bench)},
          {"table_3_2", table_3_2(bench)},
          {"figure_3_7", figure_3_7(bench)},
          {"figure_3_8", figure_3_8(bench)},
          {"figure_3_12", figure_3_12(bench)}};
}

}  // namespace volgi::app::nichols2010
