#include "apps/bench/lattice.h"

#include <fmt/format.h>

#include <cmath>

#include "apps/bench/repeated_frame.h"
#include "apps/bench/yardstick.h"
#include "core/error.h"
#include "reference/flip.h"
#include "screen/frame/registry.h"
#include "screen/gather/strided/virtual_light_gather.h"
#include "screen/lights/lattice/wave_lattice.h"
#include "screen/lights/resample/resample_stage.h"
#include "screen/lights/rsm/virtual_lights.h"
#include "screen/visibility/area_maps/paraboloid_depth_maps.h"
#include "screen/visibility/imperfect/light_maps.h"

namespace volgi::app {

namespace {

using screen::FrameOptions;
using Lattice = screen::WaveLatticeOptions;
using Maps = screen::VisibilityChoice::Maps;

FrameOptions options_of(const std::string& recipe, int size) {
  FrameOptions o;
  screen::apply_recipe(recipe, o);
  o.size = glm::ivec2(size);
  o.light = screen::LightPart::indirect;
  return o;
}

Yardstick yardstick_of(const LatticeBenchOptions& options, const std::string& name) {
  const std::filesystem::path file = options.references / (name + ".exr");
  ReferenceFile reference = read_reference(file, PathTracerOptions::Light::indirect);
  if (reference.color.width != options.size || reference.color.height != options.size) {
    throw Error(ExitCode::usage, fmt::format("{} has {}x{} pixels; give --size {}", file.string(),
                                             reference.color.width, reference.color.height, reference.color.width));
  }
  return Yardstick(std::move(reference), file.string());
}

nlohmann::json measured(const Scene& scene, const gl::Context& context, const Yardstick& yardstick,
                        const FrameOptions& options, int frames) {
  RepeatedFrame picture(scene, context, options);
  picture.render_repeatedly(frames);
  const Image image = picture.image();
  const Metrics::Relative m = yardstick.measure(image);
  const std::optional<FlipMap> flip = flip_hdr(yardstick.reference().color, image);
  return {{"error_percent", m.rmse_pct_denoised.value_or(m.rmse_pct)},
          {"energy", m.ratio},
          {"ssim", m.ssim},
          {"flip", flip ? flip->mean(Mask(image.pixels.size(), 1)) : 0.0},
          {"lights", picture.frame().report().number("vpls")},
          {"frame_ms", picture.frame_ms()},
          {"maps_ms", picture.passes_ms({screen::ImperfectMaps::name, screen::ParaboloidDepthMaps::name})},
          {"gather_ms", picture.passes_ms({screen::VirtualLightGather::name})}};
}

std::string row_text(const nlohmann::json& r) {
  return fmt::format("  {:<46} {:6.0f} lights {:7.1f} %  energy {:5.2f}  SSIM {:5.3f}  FLIP {:5.3f}  {:7.0f} ms\n",
                     r["what"].get<std::string>(), r["lights"].get<double>(), r["error_percent"].get<double>(),
                     r["energy"].get<double>(), r["ssim"].get<double>(), r["flip"].get<double>(),
                     r["frame_ms"].get<double>());
}

struct Variant {
  std::string what;
  FrameOptions options;
};

/// The lattice as it can be had, and virtual point lights, as many.
std::vector<Variant> variants(int size) {
  std::vector<Variant> all;
  const auto lattice = [&](const std::string& what, Lattice::Power power, Lattice::Depth depth, Maps maps) {
    FrameOptions o = options_of("lattice", size);
    o.of<Lattice>().power = power;
    o.of<Lattice>().depth = depth;
    o.of<screen::VisibilityChoice>().maps = maps;
    all.push_back({what, o});
  };
  lattice("printed power, hemispheres, no shadows", Lattice::Power::printed, Lattice::Depth::scene, Maps::none);
  lattice("printed power, hemispheres, imperfect maps", Lattice::Power::printed, Lattice::Depth::scene,
          Maps::imperfect);
  lattice("conserving, hemispheres, no shadows", Lattice::Power::conserving, Lattice::Depth::scene, Maps::none);
  lattice("conserving, hemispheres, 256 lights with maps", Lattice::Power::conserving, Lattice::Depth::scene,
          Maps::regular);
  lattice("conserving, hemispheres, imperfect maps", Lattice::Power::conserving, Lattice::Depth::scene,
          Maps::imperfect);
  lattice("conserving, depth by ray, imperfect maps", Lattice::Power::conserving, Lattice::Depth::ray, Maps::imperfect);
  const int lights = screen::lattice_size(Light::Type::spot, Lattice{}.angle_deg, Lattice{}.shells).lights;
  for (const Maps maps : {Maps::none, Maps::imperfect}) {
    FrameOptions o = options_of("vpl", size);
    o.of<screen::VirtualLightOptions>().count = lights;
    o.of<screen::ResampleOptions>().candidates = 1;
    o.of<screen::VisibilityChoice>().maps = maps;
    all.push_back({maps == Maps::none ? "vpl, no shadows" : "vpl, imperfect maps", o});
  }
  all.push_back({"hybrid, its defaults", options_of("hybrid", size)});
  return all;
}

nlohmann::json recipes_table(const Scene& scene, const gl::Context& context, const LatticeBenchOptions& options,
                             const std::function<void(const std::string&)>& show) {
  const Yardstick yardstick = yardstick_of(options, scene.name);
  nlohmann::json rows = nlohmann::json::array();
  show(fmt::format("{}, {} x {}, all indirect light:\n", scene.name, options.size, options.size));
  for (const Variant& v : variants(options.size)) {
    nlohmann::json row = measured(scene, context, yardstick, v.options, options.frames);
    row["what"] = v.what;
    show(row_text(row));
    rows.push_back(std::move(row));
  }
  return {{"scene", scene.name}, {"rows", rows}};
}

/// One parameter after another, from the defaults.
nlohmann::json sweeps(const Scene& scene, const gl::Context& context, const LatticeBenchOptions& options,
                      const std::function<void(const std::string&)>& show) {
  const Yardstick yardstick = yardstick_of(options, scene.name);
  nlohmann::json rows = nlohmann::json::array();
  show(fmt::format("{}, from the defaults:\n", scene.name));
  const auto add = [&](const std::string& what, const FrameOptions& o) {
    nlohmann::json row = measured(scene, context, yardstick, o, options.frames);
    row["what"] = what;
    show(row_text(row));
    rows.push_back(std::move(row));
  };
  for (const float angle : {20.0f, 10.0f, 5.0f}) {
    FrameOptions o = options_of("lattice", options.size);
    o.of<Lattice>().angle_deg = angle;
    add(fmt::format("rays every {:g} degrees", angle), o);
  }
  for (int shells = 1; shells <= 5; ++shells) {
    FrameOptions o = options_of("lattice", options.size);
    o.of<Lattice>().shells = shells;
    add(fmt::format("{} shell{}", shells, shells > 1 ? "s" : ""), o);
  }
  for (const float on : {10.0f, 25.0f, 50.0f, 100.0f}) {
    FrameOptions o = options_of("lattice", options.size);
    o.of<Lattice>().on_percent = on;
    add(fmt::format("{:g} % of the lights on", on), o);
  }
  return {{"scene", scene.name}, {"rows", rows}};
}

/// 1024 lights, a map of 32 x 32 texels for each: of points, and of triangles; and their own picture's error against
/// the regular ones'.
nlohmann::json maps_table(const Scene& scene, const gl::Context& context, const LatticeBenchOptions& options,
                          const std::function<void(const std::string&)>& show) {
  constexpr int lights = 1024, texels = 32;
  const auto of = [&](Maps maps) {
    FrameOptions o = options_of("vpl", options.size);
    o.of<screen::VirtualLightOptions>().count = lights;
    o.of<screen::VisibilityChoice>().maps = maps;
    auto& m = o.of<screen::ImperfectMapOptions>();
    m.regular_count = lights;
    m.texels = m.regular_texels = texels;
    return o;
  };
  RepeatedFrame imperfect(scene, context, of(Maps::imperfect)), regular(scene, context, of(Maps::regular));
  render_in_turn({&imperfect, &regular}, options.frames);
  const double imperfect_ms = imperfect.passes_ms({screen::ImperfectMaps::name});
  const double regular_ms = regular.passes_ms({screen::ParaboloidDepthMaps::name});
  nlohmann::json result = {{"scene", scene.name},
                           {"triangles", scene.triangle_count()},
                           {"lights", lights},
                           {"texels", texels},
                           {"imperfect_ms", imperfect_ms},
                           {"regular_ms", regular_ms},
                           {"ratio", imperfect_ms / regular_ms}};
  show(fmt::format("{}, {} triangles, {} maps of {} x {}: imperfect {:.0f} ms, regular {:.0f} ms, ratio {:.3f}\n",
                   scene.name, scene.triangle_count(), lights, texels, texels, imperfect_ms, regular_ms,
                   imperfect_ms / regular_ms));
  return result;
}

}  // namespace

nlohmann::json bench_lattice(const std::function<Scene(const std::string&)>& scene, const gl::Context& context,
                             const LatticeBenchOptions& options, const std::function<void(const std::string&)>& show) {
  nlohmann::json result = {{"device", context.device_name()}, {"frames", options.frames}};
  const std::vector<std::string> usual{"cornell", "room", "thin_wall", "occluder"};
  for (const std::string& name : options.scenes.empty() ? usual : options.scenes)
    result["recipes"].push_back(recipes_table(scene(name), context, options, show));
  result["sweeps"] = sweeps(scene(options.swept), context, options, show);
  result["maps"] = maps_table(scene(options.mapped), context, options, show);
  return result;
}

}  // namespace volgi::app
