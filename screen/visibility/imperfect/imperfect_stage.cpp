#include "screen/visibility/imperfect/imperfect_stage.h"

#include <fmt/format.h>

#include "screen/visibility/imperfect/light_maps.h"

namespace volgi::screen {

namespace {

using Options = ImperfectMapOptions;
using Maps = VisibilityChoice::Maps;

constexpr const char* MAPS[] = {"none", "imperfect", "regular"};

constexpr Parameter PARAMETERS[] = {
    choice<VisibilityChoice>(
        {"visibility", "", "shadows of virtual lights: none, by maps of points, or of triangles",
         "imperfect in lattice, regular in val and hybrid, none in vpl"},
        MAPS, [](VisibilityChoice& o) -> auto& { return o.maps; }),
    number<Options>(
        {"imperfect.map", "texels", "on a side of an imperfect map: 16, 32 or 64"}, {16, 64},
        [](Options& o) -> auto& { return o.texels; }),
    number<Options>(
        {"imperfect.points", "", "splatted into each map, as a power of two"}, {6, Options::kMaxPointsLog2},
        [](Options& o) -> auto& { return o.points_log2; }),
    number<Options>(
        {"imperfect.pull", "levels", "coarser by two each, from which holes in a map are closed; 0 leaves them"},
        {0, 4}, [](Options& o) -> auto& { return o.pull_levels; }),
    number<Options>(
        {"regular.count", "", "lights that have a map with visibility=regular; the others cast no shadows"},
        {1, MAX_VIRTUAL_AREA_LIGHTS}, [](Options& o) -> auto& { return o.regular_count; }),
    number<Options>(
        {"regular.map", "texels", "on a side of such a map"}, {16, 1024},
        [](Options& o) -> auto& { return o.regular_texels; }),
};

Maps maps_of(const FrameOptions& options) { return options.of<VisibilityChoice>().maps.value_or(Maps::none); }

StageRole role(const FrameOptions& options) {
  return {.active = maps_of(options) != Maps::none,
          .needs = {product<VirtualLightListGl>()},
          .makes = {product<LightMaps>()}};
}

class ImperfectStage : public Stage {
 public:
  explicit ImperfectStage(const StageContext& context)
      : maps_(context.scene, maps_of(context.options), context.options.of<Options>()), scene_(context.scene) {}

  void run(FrameData& frame, gl::PassTimer& timer) override {
    maps_.run(frame.triangles, frame.get<VirtualLightListGl>(), frame.scene_diagonal_m, timer);
    frame.lend(maps_);
  }
  void scene_changed() override { maps_.follow(scene_); }
  void report(FrameReport& report) const override {
    report.add("light_maps", double(maps_.maps()), fmt::format("{} maps of virtual lights", maps_.maps()));
    report.memory_bytes += maps_.bytes();
  }
  void list_textures(std::vector<NamedTexture>& list) const override { maps_.list_textures(list); }

 private:
  LightMaps maps_;
  const Scene& scene_;
};

}  // namespace

constinit const StageType IMPERFECT_VISIBILITY{
    .name = "visibility/imperfect",
    .slot = Slot::visibility,
    .parameters = PARAMETERS,
    .role = role,
    .make = [](const StageContext& context) -> std::unique_ptr<Stage> {
      return std::make_unique<ImperfectStage>(context);
    },
    .report_nothing = [](FrameReport& report) { report.add("light_maps", 0.0); }};

}  // namespace volgi::screen
