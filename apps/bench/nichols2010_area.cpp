#include "apps/bench/nichols2010_area.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "apps/bench/repeated_frame.h"
#include "apps/bench/yardstick.h"
#include "core/scene_source.h"
#include "reference/virtual_light_tracer.h"
#include "screen/frame/registry.h"
#include "screen/gather/area/area_gather.h"
#include "screen/lights/resample/resample_stage.h"
#include "screen/lights/rsm/virtual_lights.h"
#include "screen/sources/textured_area/area_lights.h"
#include "screen/visibility/area_maps/paraboloid_depth_maps.h"
#include "screen/visibility/imperfect/light_maps.h"
#include "screen/visibility/screen_voxels/screen_voxels.h"

namespace volgi::app {

namespace {

using screen::FrameOptions;
using Area = screen::AreaGatherOptions;
using Lights = screen::AreaLightOptions;
using Voxels = screen::ScreenVoxelOptions;
using Ways = screen::VisibilityChoice::Ways;
using Maps = screen::VisibilityChoice::Maps;
using Show = std::function<void(const std::string&)>;

FrameOptions options_of(const std::string& recipe, int size) {
  FrameOptions o;
  screen::apply_recipe(recipe, o);
  o.size = glm::ivec2(size);
  o.light = screen::LightPart::direct;
  return o;
}

FrameOptions area(int size, Ways ways) {
  FrameOptions o = options_of("area", size);
  o.of<screen::VisibilityChoice>().ways = ways;
  return o;
}

class Bench {
 public:
  Bench(const gl::Context& context, const NicholsAreaBenchOptions& options, const Show& show)
      : context_(context),
        options_(options),
        show_(show),
        scene_(SceneSource(options.data / "reference/scenes/area_tv.glb").at(0.0)),
        cycles_(reference("reference/ref/area_tv/full.exr")) {}

  nlohmann::json run() {
    show_(fmt::format("area_tv, {} x {}, light straight from the screen, against Cycles:\n", options_.size,
                      options_.size));
    nlohmann::json result;
    result["techniques"] = techniques();
    result["thresholds"] = thresholds();
    result["voxels"] = voxels();
    result["incremental"] = incremental();
    result["lights"] = lights();
    return result;
  }

 private:
  Yardstick reference(const std::string& file) const {
    const std::filesystem::path path = options_.data / file;
    return {read_reference(path, PathTracerOptions::Light::direct), path.string()};
  }
  nlohmann::json measured(const std::string& what, const FrameOptions& o, const Yardstick& against) {
    RepeatedFrame picture(scene_, context_, o);
    picture.render_repeatedly(options_.frames);
    const Metrics::Relative m = against.measure(picture.image());
    const screen::FrameReport report = picture.frame().report();
    nlohmann::json row = {{"what", what},
                          {"error_percent", m.rmse_pct_denoised.value_or(m.rmse_pct)},
                          {"energy", m.ratio},
                          {"frame_ms", picture.frame_ms()},
                          {"gathered_percent", 100.0 * report.number("gathered_share")},
                          {"ways", report.number("ways_asked")}};
    for (const screen::FrameReport::Figure& f : report.figures()) {
      const auto* levels = std::get_if<std::vector<double>>(&f.value);
      if (f.name == "gathered_of_level" && levels != nullptr) row["gathered_of_level"] = *levels;
    }
    for (int step = Area().coarsest; step > 0; step /= 2)
      row["level_ms"].push_back(picture.passes_ms({screen::AreaGather::level_name(step)}));
    show_(fmt::format("  {:<48} {:6.2f} %  energy {:6.4f}  {:5.1f} % gathered {:9.0f} ways {:7.0f} ms\n", what,
                      row["error_percent"].get<double>(), m.ratio, row["gathered_percent"].get<double>(),
                      row["ways"].get<double>(), row["frame_ms"].get<double>()));
    return row;
  }
  nlohmann::json techniques() {
    nlohmann::json rows;
    rows.push_back(measured("no shadows", area(options_.size, Ways::none), cycles_));
    rows.push_back(measured("voxels 128 x 128 x 128, coarse to fine", area(options_.size, Ways::voxels), cycles_));
    rows.push_back(measured("blocked faces of 48 cells, coarse to fine", faces(), cycles_));
    FrameOptions maps = options_of("vpl", options_.size);
    maps.of<screen::VirtualLightOptions>().count = 1024;
    maps.of<screen::ResampleOptions>().candidates = 1;
    maps.of<screen::VisibilityChoice>().maps = Maps::imperfect;
    maps.of<screen::ImperfectMapOptions>().texels = 64;
    rows.push_back(measured("1024 maps of 64 x 64 (imperfect)", maps, cycles_));
    maps.of<screen::VisibilityChoice>().maps = Maps::regular;
    maps.of<screen::ImperfectMapOptions>().regular_count = 1024;
    maps.of<screen::ImperfectMapOptions>().regular_texels = 64;
    rows.push_back(measured("1024 maps of 64 x 64 (regular)", maps, cycles_));
    FrameOptions hybrid = options_of("hybrid", options_.size);
    hybrid.of<VolumeOptions>().grid_cells = 48;
    rows.push_back(measured("hybrid, its defaults", hybrid, cycles_));
    return rows;
  }
  FrameOptions faces() const {
    FrameOptions o = area(options_.size, Ways::faces);
    o.of<VolumeOptions>().grid_cells = 48;
    return o;
  }
  nlohmann::json thresholds() {
    nlohmann::json rows;
    for (const float tolerance : {0.4f, 0.2f, 0.1f, 0.05f, 0.02f, 0.005f}) {
      FrameOptions o = area(options_.size, Ways::voxels);
      o.of<Area>().tolerance = tolerance;
      nlohmann::json row = measured(fmt::format("tolerance {:g}", tolerance), o, cycles_);
      show_(fmt::format("    of its level, 16 ... 1 pixels: {:.2f}; {:.1f} ms\n",
                        fmt::join(row["gathered_of_level"].get<std::vector<double>>(), " "),
                        fmt::join(row["level_ms"].get<std::vector<double>>(), " ")));
      rows.push_back(std::move(row));
    }
    return rows;
  }
  /// Exact visibility of the lights that the recipe has.
  Yardstick exact() {
    RepeatedFrame picture(scene_, context_, area(options_.size, Ways::none));
    picture.render_repeatedly(1);
    VirtualLightGatherOptions traced;
    traced.size = glm::ivec2(options_.size);
    ReferencePicture r = gather_virtual_lights(scene_, scene_.cameras.at(0), picture.frame().virtual_lights(), traced);
    ReferenceFile file;
    file.layers = RegionLayers{r.position, r.normal, cycles_.reference().layers->direct, r.id, r.depth};
    file.color = std::move(r.color);
    return {std::move(file), "exact visibility"};
  }
  nlohmann::json voxels() {
    show_("Voxels, against exact rays to the same lights:\n");
    const Yardstick rays = exact();
    nlohmann::json rows;
    const auto add = [&](const std::string& what, int texels, int bits, bool every) {
      FrameOptions o = area(options_.size, Ways::voxels);
      o.of<Voxels>().texels = texels;
      o.of<Voxels>().bits = bits;
      if (every) {
        o.of<Area>().coarsest = 1;
        o.of<Area>().interleave = 0;
      }
      rows.push_back(measured(what, o, rays));
    };
    for (const int texels : {32, 64, 128, 256, 512, 1024})
      add(fmt::format("{0} x {0} x 128", texels), texels, 128, false);
    for (const int bits : {256, 512, 1024}) add(fmt::format("128 x 128 x {}", bits), 128, bits, false);
    add("128 x 128 x 128, every way", 128, 128, true);
    rows.push_back(measured("blocked faces of 48 cells", faces(), rays));
    return rows;
  }
  /// Against all ways at the same pixels.
  nlohmann::json incremental() {
    FrameOptions all = area(options_.size, Ways::voxels), every = all;
    all.of<Area>().incremental = false;
    every.of<Area>().coarsest = 1;
    every.of<Area>().interleave = 0;
    RepeatedFrame few(scene_, context_, area(options_.size, Ways::voxels)), asked(scene_, context_, all),
        pixels(scene_, context_, every);
    for (RepeatedFrame* f : {&few, &asked, &pixels}) f->render_repeatedly(1);
    ReferenceFile file{asked.image(), {}, cycles_.reference().layers};
    const Metrics::Relative m = Yardstick(std::move(file), "every way").measure(few.image());
    const double share = few.frame().report().number("ways_asked") / pixels.frame().report().number("ways_asked");
    show_(fmt::format(
        "Coarse to fine against all ways at the same pixels: {:.2f} %; {:.1f} % of the ways of all pixels\n",
        m.rmse_pct, 100.0 * share));
    return {{"error_percent", m.rmse_pct}, {"ways_percent", 100.0 * share}};
  }
  nlohmann::json lights() {
    show_("Lights on the screen, blocked faces, against Cycles:\n");
    nlohmann::json rows;
    for (const auto sampling : {Lights::Sampling::grid, Lights::Sampling::importance}) {
      for (const int n : {4, 8, 16, 32, 64, 128}) {
        FrameOptions o = faces();
        o.of<Lights>() = {n * n, sampling};
        rows.push_back(
            measured(fmt::format("{}, {}", n * n, sampling == Lights::Sampling::grid ? "on a grid" : "by importance"),
                     o, cycles_));
      }
    }
    return rows;
  }

  const gl::Context& context_;
  NicholsAreaBenchOptions options_;
  Show show_;
  Scene scene_;
  Yardstick cycles_;
};

}  // namespace

nlohmann::json bench_nichols2010_area(const gl::Context& context, const NicholsAreaBenchOptions& options,
                                      const Show& show) {
  nlohmann::json result = Bench(context, options, show).run();
  result["device"] = context.device_name();
  result["frames"] = options.frames;
  return result;
}

}  // namespace volgi::app
