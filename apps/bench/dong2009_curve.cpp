#include <fmt/format.h>

#include <optional>

#include "apps/bench/dong2009.h"
#include "apps/bench/repeated_frame.h"
#include "apps/bench/yardstick.h"
#include "reference/virtual_light_tracer.h"
#include "screen/frame/registry.h"
#include "screen/gather/interleaved/area_light_gather.h"
#include "screen/lights/resample/resample_stage.h"
#include "screen/lights/rsm/virtual_lights.h"
#include "screen/visibility/area_maps/area_maps_stage.h"
#include "screen/visibility/area_maps/virtual_area_lights.h"

namespace volgi::app {

namespace {

/// Above this many lights only the default shadow method is shown: a picture gathers all of them at every pixel.
constexpr int kMaxLightsOfAllMethods = 1024;
/// Convolution keeps 28 bytes a texel and its mipmaps, 37 bytes where the others keep 4: 630 MB at 256 maps of 256^2.
constexpr int kMaxConvolutionMaps = 256;

std::vector<int> area_light_counts(int lights) {
  std::vector<int> counts;
  for (const int m : {2, 4, 8, 15, 30, 60, 120, 256, 512, MAX_VIRTUAL_AREA_LIGHTS}) {
    if (m < lights) counts.push_back(m);
  }
  if (lights <= MAX_VIRTUAL_AREA_LIGHTS) counts.push_back(lights);
  return counts;
}

bool shown(const AreaLightShadowName& shadow, int lights, int area_lights) {
  const bool is_default = &shadow == &kAreaLightShadows[0];
  if (!is_default && lights > kMaxLightsOfAllMethods) return false;
  return screen::AreaLightShadow::Method(shadow.number) != screen::AreaLightShadow::Method::convolution ||
         area_lights <= kMaxConvolutionMaps;
}

screen::FrameOptions frame_options(int lights, int area_lights, const AreaLightShadowName& shadow, int size) {
  screen::FrameOptions o;
  screen::apply_recipe("val", o);
  o.light = screen::LightPart::indirect;
  o.size = glm::ivec2(size);
  o.of<screen::VirtualLightOptions>().count = lights;
  o.of<screen::VirtualAreaLightOptions>().count = area_lights;
  o.of<screen::AreaMapOptions>().texels = 256;  // the paper's
  o.of<screen::AreaMapOptions>().shadow = screen::AreaLightShadow::Method(shadow.number);
  o.of<screen::AreaLightGatherOptions>().interleave = 1;
  o.of<screen::ResampleOptions>().near_zone =
      0.0f;  // sub-lights are not in the list whose exact visibility is computed
  return o;
}

/// What the curve's pictures are compared with.
struct Yardsticks {
  Yardstick same_lights;
  std::optional<Yardstick> one_bounce;

  nlohmann::json errors(const Image& image) const {
    nlohmann::json r = {{"same_lights_percent", same_lights.error_percent(image)}};
    if (one_bounce) r["one_bounce_percent"] = one_bounce->error_percent(image);
    return r;
  }
};

std::optional<Yardstick> one_bounce_of(const Scene& scene, const Dong2009Options& options) {
  const std::filesystem::path file = options.one_bounce / (scene.name + ".exr");
  if (!std::filesystem::exists(file)) return std::nullopt;
  ReferenceFile reference = read_reference(file, PathTracerOptions::Light::indirect);
  if (reference.color.width != options.curve_size || reference.color.height != options.curve_size) return std::nullopt;
  return Yardstick(std::move(reference), file.string());
}

ReferencePicture gather(const VirtualLightTracer& tracer, const Scene& scene, const VirtualLightList& lights, int size,
                        VirtualLightGatherOptions::Visibility visibility) {
  VirtualLightGatherOptions o;
  o.size = glm::ivec2(size);
  o.visibility = visibility;
  o.light = PathTracerOptions::Light::indirect;
  return tracer.gather(scene.cameras[0], lights, o);
}

ReferenceFile as_reference(const ReferencePicture& p) {
  return {p.color, std::nullopt, RegionLayers{p.position, p.normal, p.direct, p.id, p.depth}};
}

nlohmann::json curve_point(const Scene& scene, const gl::Context& context, int lights, int area_lights,
                           const Yardsticks& yardsticks, int size) {
  nlohmann::json point = {{"vals", area_lights}, {"methods", nlohmann::json::object()}};
  for (const AreaLightShadowName& shadow : kAreaLightShadows) {
    if (!shown(shadow, lights, area_lights)) continue;
    RepeatedFrame picture(scene, context, frame_options(lights, area_lights, shadow, size));
    picture.render();
    point["methods"][shadow.name] = yardsticks.errors(picture.image());
  }
  return point;
}

}  // namespace

nlohmann::json area_light_curve(const Scene& scene, const gl::Context& context, int lights,
                                const Dong2009Options& options) {
  using Visibility = VirtualLightGatherOptions::Visibility;
  // The lights do not depend on how many area lights they are joined to.
  RepeatedFrame picture(scene, context, frame_options(lights, 1, kAreaLightShadows[0], options.curve_size));
  picture.render();
  const VirtualLightList list = picture.frame().virtual_lights();
  const VirtualLightTracer tracer(scene);
  const ReferencePicture exact = gather(tracer, scene, list, options.curve_size, Visibility::exact);
  const Yardsticks yardsticks{Yardstick(as_reference(exact), scene.name), one_bounce_of(scene, options)};

  nlohmann::json points = nlohmann::json::array();
  for (const int m : area_light_counts(lights))
    points.push_back(curve_point(scene, context, lights, m, yardsticks, options.curve_size));
  return {{"scene", scene.name},
          {"size", {options.curve_size, options.curve_size}},
          {"vpls", lights},
          {"exact", yardsticks.errors(exact.color)},
          {"no_visibility", yardsticks.errors(gather(tracer, scene, list, options.curve_size, Visibility::none).color)},
          {"points", points}};
}

std::string area_light_curve_table(const nlohmann::json& curve) {
  const auto cell = [](const nlohmann::json& e) {
    const std::string of_one_bounce =
        e.contains("one_bounce_percent") ? fmt::format("{:6.2f}", e["one_bounce_percent"].get<double>()) : "     -";
    return fmt::format("{:7.2f} / {}", e["same_lights_percent"].get<double>(), of_one_bounce);
  };
  std::string text = fmt::format(
      "{}, {} x {}, {} VPLs, every pixel: error [%] against the same lights with exact visibility / against one bounce "
      "path traced\n  exact visibility {}, none {}\n  VALs",
      curve["scene"].get<std::string>(), curve["size"][0].get<int>(), curve["size"][1].get<int>(),
      curve["vpls"].get<int>(), cell(curve["exact"]), cell(curve["no_visibility"]));
  for (const AreaLightShadowName& shadow : kAreaLightShadows) text += fmt::format("   {:>17}", shadow.name);
  for (const nlohmann::json& point : curve["points"]) {
    text += fmt::format("\n  {:4}", point["vals"].get<int>());
    for (const AreaLightShadowName& shadow : kAreaLightShadows) {
      const nlohmann::json& methods = point["methods"];
      text += fmt::format("   {:>17}", methods.contains(shadow.name) ? cell(methods[shadow.name]) : "-");
    }
  }
  return text + "\n";
}

}  // namespace volgi::app
