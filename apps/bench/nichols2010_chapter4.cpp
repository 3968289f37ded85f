#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "apps/bench/nichols2010_internal.h"
#include "apps/bench/timing.h"
#include "core/exposure.h"
#include "screen/frame/registry.h"
#include "screen/gather/subsplats/discontinuity_mipmaps.h"
#include "screen/gather/subsplats/flattened_buffer.h"
#include "screen/gather/subsplats/light_cache.h"
#include "screen/gather/subsplats/splat.h"
#include "screen/gather/subsplats/stencil_gather.h"
#include "screen/gather/subsplats/subsplat_refinement.h"
#include "screen/gather/subsplats/upsample.h"
#include "screen/lights/patches/light_patches.h"

namespace volgi::app::nichols2010 {

namespace {

/// Table 4.1 by step: of the gather, then of splatting, for each of their scenes.
struct Step {
  const char* name;
  std::initializer_list<std::string_view> passes;
  double gather_ms[4], splat_ms[4];
};
const Step kSteps[] = {
    {"direct light",
     {screen::GBuffer::name, screen::Direct::name, screen::Compose::name},
     {1.8, 5.8, 2.8, 2.8},
     {1.8, 5.8, 2.8, 2.8}},
    {"reflective shadow map",
     {screen::ReflectiveShadowMap::name, screen::LightPatches::name, screen::LightCache::name},
     {0.9, 2.3, 1.4, 1.6},
     {0.9, 2.3, 1.4, 1.6}},
    {"min-max mipmap", {screen::DiscontinuityMipmaps::name}, {0.7, 0.7, 0.7, 0.7}, {0.7, 0.7, 0.7, 0.7}},
    {"stencil / geometry shader",
     {screen::FlattenedBuffer::mark_name, screen::SubsplatRefinement::name},
     {0.7, 0.7, 0.7, 0.7},
     {1.3, 1.7, 1.3, 1.6}},
    {"gather / splat",
     {screen::StencilGather::name, screen::Splat::name},
     {2.5, 3.5, 3.0, 6.6},
     {45.8, 67.0, 58.1, 130.0}},
    {"upsample", {screen::Upsample::name}, {1.6, 1.7, 1.3, 1.3}, {1.6, 1.7, 1.3, 1.3}}};
struct TheirScene {
  const char* name;
  const char* theirs;
};
constexpr TheirScene kScenes[] = {
    {"cornell", "Cornell box"}, {"animal17k", "feline"}, {"atrium", "Sponza"}, {"room704", "indoor garden"}};
constexpr const char* kSceneOfCurves = "animal17k";  // the feline

bool is_asked(const Bench& bench, const char* name) {
  const auto& asked = bench.options.scenes;
  return asked.empty() || std::find(asked.begin(), asked.end(), name) != asked.end();
}
std::string scene_of_curves(const Bench& bench) {
  return bench.options.scenes.empty() ? std::string(kSceneOfCurves) : bench.options.scenes.front();
}

nlohmann::json steps_of(RepeatedFrame& frame) {
  nlohmann::json steps = nlohmann::json::object();
  for (const Step& step : kSteps) steps[step.name] = frame.passes_ms(step.passes);
  steps["total"] = frame.frame_ms();
  return steps;
}

std::string steps_text(const nlohmann::json& row, int theirs) {
  std::string text;
  for (const Step& step : kSteps)
    text += fmt::format("    {:26}{:9.1f} ms ({:4.1f}){:12.1f} ms ({:5.1f})\n", step.name,
                        row["gather_ms"][step.name].get<double>(), step.gather_ms[theirs],
                        row["splat_ms"][step.name].get<double>(), step.splat_ms[theirs]);
  const double gather = row["gather_ms"]["gather / splat"], splat = row["splat_ms"]["gather / splat"];
  return text + fmt::format("    {:26}{:9.1f} ms{:19.1f} ms\n    {:.0f} fragments; splat over gather {:.1f} ({:.1f})\n",
                            "total", row["gather_ms"]["total"].get<double>(), row["splat_ms"]["total"].get<double>(),
                            row["fragments"].get<double>(), splat / gather,
                            kSteps[4].splat_ms[theirs] / kSteps[4].gather_ms[theirs]);
}

nlohmann::json table_4_1(const Bench& bench) {
  nlohmann::json rows = nlohmann::json::array();
  for (int s = 0; s < 4; ++s) {
    if (!is_asked(bench, kScenes[s].name)) continue;
    const Scene scene = bench.scene_by_name(kScenes[s].name);
    for (const int size : bench.options.sizes) {
      RepeatedFrame gather(scene, bench.context, settings("multires", size, {}));
      RepeatedFrame splat(scene, bench.context, settings("multires", size, {"multires.sum=splat"}));
      nichols2010::render_in_turn(bench, {&gather, &splat});
      nlohmann::json row = {{"scene", scene.name},
                            {"theirs", kScenes[s].theirs},
                            {"size", size},
                            {"fragments", gather.frame().report().number("fragments")},
                            {"gather_ms", steps_of(gather)},
                            {"splat_ms", steps_of(splat)}};
      bench.show(fmt::format("Table 4.1, {} {} x {}, 256 VPLs (theirs: {}, 1024^2): gather, splat\n", scene.name, size,
                             size, kScenes[s].theirs) +
                 steps_text(row, s));
      rows.push_back(std::move(row));
    }
  }
  return rows;
}

/// All texels at every pixel: what errors are measured against; and all texels at the fragments.
screen::FrameOptions all_texels(const Bench& bench, int texels, bool every_pixel) {
  screen::FrameOptions o = settings("multires", bench.options.error_size, {set("patches.grid", texels)});
  const int with_margin = texels + 2 * RSM_MARGIN_TEXELS;
  o.of<screen::ReflectiveShadowMap::Resolution>() = {with_margin, with_margin, with_margin};
  if (every_pixel) screen::set_parameter(o.settings, "multires.cells=16384");
  return o;
}
/// As a display of their time has it: all light, exposed, cut off at white, and its root mean square difference in
/// percent of white.
class Shown {
 public:
  Shown(const Bench& bench, const Scene& scene, const Image& indirect) {
    screen::FrameOptions o = settings("multires", bench.options.error_size, {});
    o.light = screen::LightPart::direct;
    direct_ = picture(bench, scene, o);
    Image all = direct_;
    for (size_t i = 0; i < all.pixels.size(); ++i) all.pixels[i] += indirect.pixels[i];
    exposure_ = std::exp2(automatic_exposure_ev(all));
  }
  double rms_percent(const Image& reference, const Image& indirect) const {
    double squared = 0.0;
    for (size_t i = 0; i < reference.pixels.size(); ++i) {
      const glm::dvec3 d = glm::dvec3(at(i, indirect)) - glm::dvec3(at(i, reference));
      squared += glm::dot(d, d) / 3.0;
    }
    return 100.0 * std::sqrt(squared / double(reference.pixels.size()));
  }

 private:
  glm::vec3 at(size_t i, const Image& indirect) const {
    return glm::min((direct_.pixels[i] + indirect.pixels[i]) * exposure_, glm::vec3(1.0f));
  }
  Image direct_;
  float exposure_;
};

/// Figure 4.9, and the bounds of §4.3: fragments, light patches, and both.
nlohmann::json figure_4_9_and_bounds(const Bench& bench) {
  nlohmann::json rows = nlohmann::json::array();
  const int size = bench.options.error_size;
  bench.show(fmt::format(
      "Figure 4.9 and bounds, {} x {}, {}^2 texels: RMS of the mean / of the range (of white, all light shown)\n", size,
      size, bench.options.all_texels));
  for (const TheirScene& s : kScenes) {
    if (!is_asked(bench, s.name)) continue;
    const Scene scene = bench.scene_by_name(s.name);
    const Image every = picture(bench, scene, all_texels(bench, bench.options.all_texels, true));
    nlohmann::json row = {{"scene", s.name}, {"eye_space", nlohmann::json::array()}};
    std::string text = fmt::format("  {:10} eye space by depth threshold:", s.name);
    for (const double threshold : {0.01, 0.02, 0.05, 0.1, 0.2}) {
      screen::FrameOptions o = all_texels(bench, bench.options.all_texels, false);
      screen::set_parameter(o.settings, set("multires.depth", threshold));
      const nlohmann::json error = to_json(rms(every, picture(bench, scene, o)));
      row["eye_space"].push_back({{"depth", threshold}, {"rms", error}});
      text += fmt::format("  {} {}", threshold, text_of(error));
      if (bench.options.quick) break;
    }
    const Shown shown(bench, scene, every);
    const auto error_of = [&](const char* recipe, std::initializer_list<std::string> more) {
      const Image image = picture(bench, scene, settings(recipe, size, more));
      nlohmann::json error = to_json(rms(every, image));
      error["of_white_percent"] = shown.rms_percent(every, image);
      return error;
    };
    row["light_space"] =
        error_of("hierarchical", {"multires.cells=16384", "patches.depth=3", "multires.threshold=0.1"});
    row["together"] = error_of("hierarchical", {"patches.depth=3", "multires.threshold=0.1"});
    row["edges"] = error_of("hierarchical", {"multires.cells=16384", "patches.depth=3", "patches.edges=on"});
    row["radiosity"] = error_of("radiosity", {});
    row["grid"] = error_of("multires", {});
    bench.show(
        text +
        fmt::format(
            "\n    light space (hierarchical, tau 0.1, depth 3) {}, edges divided {}   together {}   radiosity and "
            "fragments {}   16^2 lights and fragments {}\n",
            text_of(row["light_space"]), text_of(row["edges"]), text_of(row["together"]), text_of(row["radiosity"]),
            text_of(row["grid"])));
    rows.push_back(std::move(row));
  }
  return rows;
}

/// The scene with its first light moved along x by parts of the diagonal.
Scene moved_light(Scene scene, double parts) {
  const float by = float(parts) * glm::distance(scene.bounds_min, scene.bounds_max);
  Light& light = scene.lights.at(0);
  if (light.type == Light::Type::directional) {
    light.direction = glm::normalize(light.direction + glm::vec3(float(parts), 0.0f, 0.0f));
  } else {
    light.position.x += by;
  }
  return scene;
}

nlohmann::json figure_4_10(const Bench& bench) {
  const Scene scene = bench.scene_by_name(scene_of_curves(bench));
  const int size = bench.options.sizes.front();
  nlohmann::json rows = nlohmann::json::array();
  std::string text =
      fmt::format("Figure 4.10, {} {} x {}, indirect ms as the light moves by tenths of the diagonal (lights)\n",
                  scene.name, size, size);
  struct Line {
    const char* name;
    const char* recipe;
    const char* threshold;
  };
  for (const Line& line : {Line{"radiosity, 64^2", "radiosity", "0.2"},
                           {"hierarchical 0.05", "hierarchical", "0.05"},
                           {"hierarchical 0.2", "hierarchical", "0.2"},
                           {"hierarchical 0.5", "hierarchical", "0.5"}}) {
    text += fmt::format("  {:18}", line.name);
    for (const double parts : {-0.2, -0.1, 0.0, 0.1, 0.2}) {
      const Timed t = timed(bench, moved_light(scene, parts),
                            settings(line.recipe, size, {std::string("multires.threshold=") + line.threshold}));
      rows.push_back({{"what", line.name},
                      {"moved", parts},
                      {"indirect_ms", t.indirect_ms},
                      {"frame_ms", t.frame_ms},
                      {"patches", t.patches}});
      text += fmt::format("  {:6.0f} ({:5.0f})", t.indirect_ms, t.patches);
      if (bench.options.quick) break;
    }
    text += '\n';
  }
  bench.show(text);
  return rows;
}

nlohmann::json figure_4_11(const Bench& bench) {
  const Scene scene = bench.scene_by_name(scene_of_curves(bench));
  const int size = bench.options.sizes.front();
  nlohmann::json rows = nlohmann::json::array();
  std::string text =
      fmt::format("Figure 4.11, {} {} x {}, radiosity by depth threshold: indirect ms (lights), two divisions\n",
                  scene.name, size, size);
  for (const int grid : {8, 16, 32}) {
    text += fmt::format("  {:2}^2 first", grid);
    for (const double threshold : {0.01, 0.02, 0.05, 0.1, 0.2}) {
      const Timed t =
          timed(bench, scene,
                settings("radiosity", size, {set("patches.grid", grid), set("patches.depth_range", threshold)}));
      rows.push_back(
          {{"grid", grid}, {"depth_range", threshold}, {"indirect_ms", t.indirect_ms}, {"patches", t.patches}});
      text += fmt::format("  {:4} {:6.0f} ({:5.0f})", threshold, t.indirect_ms, t.patches);
      if (bench.options.quick) break;
    }
    text += '\n';
  }
  bench.show(text);
  return rows;
}

/// Figures 4.12 and 4.13: time and error of the hierarchy against the threshold.
nlohmann::json figures_4_12_and_4_13(const Bench& bench) {
  const Scene scene = bench.scene_by_name(scene_of_curves(bench));
  const int size = bench.options.sizes.front();
  const Image truth = picture(bench, scene, all_texels(bench, bench.options.all_texels, false));
  nlohmann::json rows = nlohmann::json::array();
  std::string text = fmt::format(
      "Figures 4.12 and 4.13, {}: by tau, indirect ms at {} x {} / RMS to all texels at the same fragments at {}^2\n",
      scene.name, size, size, bench.options.error_size);
  for (const int depth : {1, 2, 3}) {
    text += fmt::format("  depth {} ({}^2)", depth, 16 << depth);
    for (const double threshold : {0.0001, 0.05, 0.1, 0.2, 0.5, 1.0}) {
      const auto of = [&](int pixels) {
        return settings("hierarchical", pixels, {set("patches.depth", depth), set("multires.threshold", threshold)});
      };
      const Timed t = timed(bench, scene, of(size));
      const nlohmann::json error = to_json(rms(truth, picture(bench, scene, of(bench.options.error_size))));
      rows.push_back({{"depth", depth}, {"threshold", threshold}, {"indirect_ms", t.indirect_ms}, {"rms", error}});
      text += fmt::format("  {:g} {:6.0f} /{}", threshold, t.indirect_ms, text_of(error));
      if (bench.options.quick) break;
    }
    text += '\n';
  }
  bench.show(text);
  return rows;
}

/// Mean absolute change in percent of the mean.
double change_percent(const Image& before, const Image& after) {
  double sum = 0.0, mean = 0.0;
  for (size_t i = 0; i < before.pixels.size(); ++i) {
    const glm::dvec3 d = glm::abs(glm::dvec3(after.pixels[i]) - glm::dvec3(before.pixels[i]));
    sum += d.x + d.y + d.z;
    mean += double(before.pixels[i].x) + double(before.pixels[i].y) + double(before.pixels[i].z);
  }
  return 100.0 * sum / std::max(mean, 1e-30);
}

/// Figure 4.5: what changes from frame to frame as the light moves by thousandths of the scene.
nlohmann::json figure_4_5(const Bench& bench) {
  nlohmann::json rows = nlohmann::json::array();
  const int size = bench.options.error_size, steps = bench.options.quick ? 2 : 12;
  std::string text = fmt::format(
      "Figure 4.5, {} x {}, change from frame to frame as the light moves by 1/1000 of the diagonal, median ... "
      "largest "
      "of {} [% of the mean]; over that of all texels of a map half as fine\n",
      size, size, steps);
  for (const TheirScene& s : kScenes) {
    if (!is_asked(bench, s.name)) continue;
    const Scene scene = bench.scene_by_name(s.name);
    double exact = 0.0;
    text += fmt::format("  {:10}", s.name);
    for (const char* what : {"all texels", "multires", "radiosity", "hierarchical"}) {
      const bool all = std::string_view(what) == "all texels";
      const screen::FrameOptions o =
          all ? all_texels(bench, bench.options.all_texels / 2, false) : settings(what, size, {});
      std::vector<double> changes;
      Image before = picture(bench, scene, o);
      for (int k = 1; k <= steps; ++k) {
        Image after = picture(bench, moved_light(scene, 0.001 * k), o);
        changes.push_back(change_percent(before, after));
        before = std::move(after);
      }
      const double middle = median(changes), most = *std::max_element(changes.begin(), changes.end());
      if (all) exact = middle;
      rows.push_back({{"scene", s.name}, {"what", what}, {"median_percent", middle}, {"largest_percent", most}});
      text += fmt::format("  {} {:.2f} ... {:.2f}", what, middle, most);
      if (!all && exact > 0.0) text += fmt::format(" ({:.1f} x)", middle / exact);
    }
    text += '\n';
  }
  bench.show(text);
  return rows;
}

}  // namespace

nlohmann::json chapter_4(const Bench& bench) {
  return {{"table_4_1", table_4_1(bench)},
          {"figure_4_5", figure_4_5(bench)},
          {"figure_4_9_and_bounds", figure_4_9_and_bounds(bench)},
          {"figure_4_10", figure_4_10(bench)},
          {"figure_4_11", figure_4_11(bench)},
          {"figures_4_12_and_4_13", figures_4_12_and_4_13(bench)}};
}

}  // namespace volgi::app::nichols2010
