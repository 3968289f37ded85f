#include "screen/gather/area/area_stage.h"

#include <fmt/format.h>

#include "core/error.h"
#include "screen/gather/area/area_gather.h"
#include "shaders/screen/gather/area/slots.shared.h"

namespace volgi::screen {

namespace {

using Options = AreaGatherOptions;

constexpr Parameter PARAMETERS[] = {
    number<Options>(
        {"area.coarsest", "pixels", "between those that are always gathered: 1, 2, 4, 8, 16 or 32"}, {1, 32},
        [](Options& o) -> auto& { return o.coarsest; }),
    number<Options>(
        {"area.tolerance", "", "of irradiance between neighbours, above which what lies between is gathered"}, {0, 10},
        [](Options& o) -> auto& { return o.tolerance; }),
    number<Options>(
        {"area.in_part", "", "share of the lights whose visibility may differ between neighbours"}, {0, 1},
        [](Options& o) -> auto& { return o.in_part; }),
    yes_no<Options>(
        {"area.incremental", "", "lights that all neighbours see, or none does, are not asked again"},
        [](Options& o) -> auto& { return o.incremental; }),
};

StageRole role(const FrameOptions& options) {
  AreaGather::check(options.of<Options>());
  if (options.of<AreaLightOptions>().lights > AREA_MASK_LIGHTS)
    throw Error(ExitCode::usage, fmt::format("area.lights: {} are more than the {} that a pixel has bits for",
                                             options.of<AreaLightOptions>().lights, AREA_MASK_LIGHTS));
  return {.needs = {product<AreaLights>()},
          .uses = {product<ScreenVoxels>(), product<BlockedFaces>()},
          .adds = {{{LightPath::emission_direct}}}};
}

class AreaStage : public Stage {
 public:
  explicit AreaStage(const StageContext& context) : gather_(context.options.size, context.options.of<Options>()) {}

  void run(FrameData& frame, gl::PassTimer& timer) override {
    const auto& lights = frame.get<AreaLights>();
    if (lights.count() == 0) return;
    gather_.run(frame.gbuffer, lights, {frame.find<ScreenVoxels>(), frame.find<BlockedFaces>()}, timer);
    frame.layers.push_back({&gather_.radiance(), {LightPath::emission_direct}});
  }
  void scene_changed() override { gather_.scene_moved(); }
  void report(FrameReport& report) const override {
    const AreaGather::Figures f = gather_.figures();
    report.add("gathered_share", f.gathered, fmt::format("{:.1f} % of the pixels gathered", 100.0 * f.gathered));
    report.add("ways_asked_share", f.asked, fmt::format("{:.1f} % of their ways to lights asked", 100.0 * f.asked));
    report.add("ways_asked", f.ways);
    report.add("gathered_of_level", f.level);
    report.memory_bytes += gather_.bytes();
  }
  void list_textures(std::vector<NamedTexture>& list) const override { gather_.list_textures(list); }

 private:
  AreaGather gather_;
};

}  // namespace

constinit const StageType AREA_GATHER{
    .name = "gather/area",
    .slot = Slot::gather,
    .parameters = PARAMETERS,
    .role = role,
    .make = [](const StageContext& context) -> std::unique_ptr<Stage> { return std::make_unique<AreaStage>(context); }};

}  // namespace volgi::screen
