#include "apps/bench/dong2009.h"

#include <fmt/format.h>

#include <memory>
#include <optional>

#include "apps/bench/repeated_frame.h"
#include "screen/frame/registry.h"
#include "screen/gather/interleaved/area_light_gather.h"
#include "screen/lights/resample/virtual_light_subdivision.h"
#include "screen/visibility/area_maps/area_maps_stage.h"
#include "screen/visibility/area_maps/convolution_shadow.h"

namespace volgi::app {

namespace {

/// Table 1; 8800 GTX, 800 x 800, 1024 virtual lights, 30 area lights.
struct PaperScene {
  const char* name;  // ours
  const char* theirs;
  int faces;
  double fps;
};
constexpr PaperScene kScenes[] = {{"cornell", "Cornell Box", 18, 20.4},
                                  {"animal17k", "Cornell Horse", 17000, 19.7},
                                  {"atrium_detail", "Sponza", 98000, 13.4},
                                  {"builtin:metaballs", "Metaballs", 5000, 20.7}};
constexpr const char* kSceneOfSteps = "animal17k";

/// Table 2, of the horse; a step of theirs is one or several passes of ours.
struct Step {
  const char* name;
  double paper_ms;
  std::initializer_list<std::string_view> passes;  // none: all that no other step names
};
const Step kSteps[] = {
    {"deferred rendering", 0.4, {screen::GBuffer::name, screen::Direct::name, screen::Compose::name}},
    {"VPL generation",
     0.1,
     {screen::ReflectiveShadowMap::name, screen::VirtualLights::name, screen::ResampleVirtualLights::name,
      screen::VirtualLightSubdivision::name}},
    {"VAL clustering", 0.5, {screen::VirtualAreaLights::name}},
    {"shadow maps", 4.2, {screen::ParaboloidDepthMaps::name, screen::ConvolutionShadow::name}},
    {"indirect illumination", 35.0, {}},
    {"geometry-aware blur", 10.7, {screen::AreaLightGather::blur_name}}};

screen::FrameOptions frame_options(const AreaLightShadowName& shadow, int size) {
  screen::FrameOptions o;
  screen::apply_recipe("val", o);
  o.size = glm::ivec2(size);
  o.of<screen::AreaMapOptions>().shadow = screen::AreaLightShadow::Method(shadow.number);
  // The paper's own, not our defaults.
  o.of<screen::VirtualAreaLightOptions>().count = 30;
  o.of<screen::AreaMapOptions>().texels = 256;
  o.of<screen::AreaLightGatherOptions>().interleave = 8;
  return o;
}

nlohmann::json method_times(RepeatedFrame& picture) {
  nlohmann::json steps = nlohmann::json::object();
  double unnamed_ms = picture.all_passes_ms();
  const double rest_ms = picture.frame_ms() - unnamed_ms;
  for (const Step& step : kSteps) unnamed_ms -= picture.passes_ms(step.passes);
  for (const Step& step : kSteps)
    steps[step.name] = step.passes.size() > 0 ? picture.passes_ms(step.passes) : unnamed_ms;
  return {{"steps_ms", steps}, {"rest_ms", rest_ms}, {"frame_ms", picture.frame_ms()}};
}

nlohmann::json scene_times(const Scene& scene, const gl::Context& context, const Dong2009Options& options) {
  std::vector<std::unique_ptr<RepeatedFrame>> pictures;
  std::vector<RepeatedFrame*> in_turn;
  for (const AreaLightShadowName& shadow : kAreaLightShadows) {
    pictures.push_back(std::make_unique<RepeatedFrame>(scene, context, frame_options(shadow, options.size)));
    in_turn.push_back(pictures.back().get());
  }
  render_in_turn(in_turn, options.frames);
  nlohmann::json methods = nlohmann::json::object();
  for (size_t m = 0; m < pictures.size(); ++m) methods[kAreaLightShadows[m].name] = method_times(*pictures[m]);
  const screen::FrameReport report = pictures[0]->frame().report();
  return {
      {"scene", scene.name},           {"triangles", scene.triangle_count()}, {"size", {options.size, options.size}},
      {"vpls", report.number("vpls")}, {"vals", report.number("vals")},       {"methods", methods}};
}

nlohmann::json paper_of(const std::string& name) {
  for (const PaperScene& paper : kScenes) {
    if (name != paper.name) continue;
    nlohmann::json r = {{"scene", paper.theirs}, {"triangles", paper.faces}, {"fps", paper.fps}};
    if (name == kSceneOfSteps) {
      for (const Step& step : kSteps) r["steps_ms"][step.name] = step.paper_ms;
    }
    return r;
  }
  return nullptr;
}

std::string cell(double ms, double whole_ms) {
  return fmt::format("{:9.1f} ms {:5.1f} %  ", ms, 100.0 * ms / whole_ms);
}

std::string times_table(const nlohmann::json& r) {
  const nlohmann::json& paper = r["paper"];
  std::string text = fmt::format("{} ({} triangles), {} x {}, {} VPLs, {} VALs", r["scene"].get<std::string>(),
                                 r["triangles"].get<size_t>(), r["size"][0].get<int>(), r["size"][1].get<int>(),
                                 r["vpls"].get<int>(), r["vals"].get<int>());
  if (!paper.is_null())
    text += fmt::format("; theirs: {}, {} triangles, {} fps", paper["scene"].get<std::string>(),
                        paper["triangles"].get<int>(), paper["fps"].get<double>());
  const bool with_steps = !paper.is_null() && paper.contains("steps_ms");
  const double paper_frame_ms = paper.is_null() ? 0.0 : 1000.0 / paper["fps"].get<double>();
  text += fmt::format("\n  {:22}{:^21}", "", paper.is_null() ? "" : "theirs");
  for (const AreaLightShadowName& shadow : kAreaLightShadows) text += fmt::format("{:^21}", shadow.name);
  const auto line = [&](const char* name, const std::string& theirs, const auto& ms_of) {
    text += fmt::format("\n  {:22}{:21}", name, theirs);
    for (const AreaLightShadowName& shadow : kAreaLightShadows) {
      const nlohmann::json& method = r["methods"][shadow.name];
      text += cell(ms_of(method), method["frame_ms"]);
    }
  };
  for (const Step& step : kSteps)
    line(step.name, with_steps ? cell(step.paper_ms, paper_frame_ms) : "",
         [&](const nlohmann::json& m) { return m["steps_ms"][step.name].get<double>(); });
  line("rest", "", [](const nlohmann::json& m) { return m["rest_ms"].get<double>(); });
  line("frame", paper.is_null() ? "" : cell(paper_frame_ms, paper_frame_ms),
       [](const nlohmann::json& m) { return m["frame_ms"].get<double>(); });
  return text + "\n";
}

}  // namespace

nlohmann::json bench_dong2009(const std::function<Scene(const std::string&)>& scene_by_name, const gl::Context& context,
                              const Dong2009Options& options, const std::function<void(const std::string&)>& show) {
  std::vector<std::string> names = options.scenes, curve_names = options.curve_scenes;
  if (names.empty()) {
    for (const PaperScene& paper : kScenes) names.emplace_back(paper.name);
  }
  if (curve_names.empty()) curve_names = {"cornell", "occluder", "room"};
  nlohmann::json times = nlohmann::json::array(), curves = nlohmann::json::array();
  show(fmt::format("{}, medians of {} frames; theirs: 8800 GTX, 800 x 800\n", context.device_name(), options.frames));
  for (const std::string& name : names) {
    nlohmann::json r = scene_times(scene_by_name(name), context, options);
    r["paper"] = paper_of(name);
    show(times_table(r));
    times.push_back(std::move(r));
  }
  for (const std::string& name : curve_names) {
    const Scene scene = scene_by_name(name);
    for (const int lights : options.curve_lights) {
      curves.push_back(area_light_curve(scene, context, lights, options));
      show(area_light_curve_table(curves.back()));
    }
  }
  return {{"device", context.device_name()}, {"frames", options.frames}, {"times", times}, {"curves", curves}};
}

}  // namespace volgi::app
