#include "screen/visibility/area_maps/area_maps_stage.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "core/error.h"
#include "screen/frame/quality.h"
#include "screen/visibility/area_maps/light_clusters.h"
#include "screen/visibility/imperfect/imperfect_maps.h"
#include "screen/visibility/visibility_choice.h"

namespace volgi::screen {

namespace {

constexpr const char* SHADOWS[] = {"convolution", "percentage_closer", "single"};
constexpr const char* FILTERS[] = {"map", "printed"};
constexpr const char* POSITIONS[] = {"nearest", "mean"};

constexpr Parameter PARAMETERS[] = {
    number<VirtualAreaLightOptions>(
        {"val.count", "", "virtual area lights, clusters of virtual point lights that share a shadow", nullptr,
         "--vals"},
        {1, MAX_VIRTUAL_AREA_LIGHTS}, [](VirtualAreaLightOptions& o) -> auto& { return o.count; }),
    choice<AreaMapOptions>(
        {"val.shadow", "", "convolution soft shadow maps, percentage-closer, or one comparison with the map"}, SHADOWS,
        [](AreaMapOptions& o) -> auto& { return o.shadow; }),
    choice<AreaMapOptions>(
        {"val.filter", "", "width of convolution's filters: by the map's scale, or an angle over pi as Dong has it"},
        FILTERS, [](AreaMapOptions& o) -> auto& { return o.filter; }),
    choice<VirtualAreaLightOptions>(
        {"val.position", "", "of a cluster: of its light nearest to the mean, or the mean as Dong has it"}, POSITIONS,
        [](VirtualAreaLightOptions& o) -> auto& { return o.position; }),
    number<VirtualAreaLightOptions>(
        {"val.plane", "",
         "weight of a light's distance off its cluster's plane, beside 0.7 of its distance and 0.3 of its angle; 0 is "
         "as "
         "Dong has it"},
        {0, 100}, [](VirtualAreaLightOptions& o) -> auto& { return o.plane_weight; }),
    number<AreaMapOptions>(
        {"val.map", "texels", "on a side of an area light's map"}, {16, 4096},
        [](AreaMapOptions& o) -> auto& { return o.texels; }),
};

void suit(const Needs& needs, TypeMap& settings) {
  const double count = double(VirtualAreaLightOptions().count) * needs.lights;
  settings.of<VirtualAreaLightOptions>().count = std::clamp(int(std::lround(count)), 1, MAX_VIRTUAL_AREA_LIGHTS);
  settings.of<AreaMapOptions>().texels = int(std::lround(double(AreaMapOptions().texels) * needs.maps));
}

StageRole role(const FrameOptions& options) {
  if (options.of<VisibilityChoice>().maps == VisibilityChoice::Maps::none)
    throw Error(ExitCode::usage, "visibility=none: clusters need maps, imperfect or regular; --gi vpl needs none");
  return {.needs = {product<VirtualLightListGl>()}, .makes = {product<LightClusters>()}};
}

class AreaMapsStage : public Stage {
 public:
  explicit AreaMapsStage(const StageContext& context)
      : scene_(context.scene),
        area_lights_(context.options.of<VirtualAreaLightOptions>()),
        imperfect_(imperfect_maps(context)),
        maps_(imperfect_ ? imperfect_->texels() : context.options.of<AreaMapOptions>().texels, area_lights_.count()),
        shadow_(AreaLightShadow::make(context.options.of<AreaMapOptions>().shadow,
                                      context.options.of<AreaMapOptions>().filter, maps_.resolution(),
                                      area_lights_.count())) {}

  void run(FrameData& frame, gl::PassTimer& timer) override {
    const auto& lights = frame.get<VirtualLightListGl>();
    area_lights_.run(lights.buffer, lights.count(), frame.scene_diagonal_m, timer, frame.sample);
    if (imperfect_) {
      imperfect_->run(area_lights_.buffer(), area_lights_.count(), maps_.distance(), 1, frame.scene_diagonal_m, timer);
    } else {
      maps_.run(frame.triangles, area_lights_, timer);
    }
    shadow_->run(maps_, timer);
    frame.lend(clusters_);
  }
  void scene_changed() override {
    if (imperfect_) imperfect_->follow(scene_);
  }
  void report(FrameReport& report) const override {
    report.add("vals", double(area_lights_.count()), std::to_string(area_lights_.count()) + " clusters");
    report.memory_bytes +=
        area_lights_.bytes() + maps_.bytes() + shadow_->bytes() + (imperfect_ ? imperfect_->bytes() : 0);
  }
  void list_textures(std::vector<NamedTexture>& list) const override {
    maps_.list_textures(list);
    shadow_->list_textures(list);
  }

 private:
  static std::optional<ImperfectMaps> imperfect_maps(const StageContext& context) {
    if (context.options.of<VisibilityChoice>().maps != VisibilityChoice::Maps::imperfect) return std::nullopt;
    return std::optional<ImperfectMaps>(std::in_place, context.scene, context.options.of<ImperfectMapOptions>());
  }

  const Scene& scene_;
  VirtualAreaLights area_lights_;
  std::optional<ImperfectMaps> imperfect_;  // in place of those of triangles
  ParaboloidDepthMaps maps_;
  std::unique_ptr<AreaLightShadow> shadow_;
  LightClusters clusters_{area_lights_, maps_, *shadow_};
};

}  // namespace

constinit const StageType AREA_MAPS{.name = "visibility/area_maps",
                                    .slot = Slot::visibility,
                                    .parameters = PARAMETERS,
                                    .role = role,
                                    .make = [](const StageContext& context) -> std::unique_ptr<Stage> {
                                      return std::make_unique<AreaMapsStage>(context);
                                    },
                                    .report_nothing = [](FrameReport& report) { report.add("vals", 0.0); },
                                    .suit = suit};

}  // namespace volgi::screen
