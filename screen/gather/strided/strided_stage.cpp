#include "screen/gather/strided/strided_stage.h"

#include <fmt/format.h>

#include "screen/gather/strided/virtual_light_gather.h"
#include "screen/lights/light_choice.h"

namespace volgi::screen {

namespace {

using Options = GatherOptions;

constexpr Parameter PARAMETERS[] = {
    number<Options>(
        {"gather.stride", "pixels", "between coarse ones; 1 gathers at every pixel"}, {1, 16},
        [](Options& o) -> auto& { return o.stride; }),
    number<Options>(
        {"gather.discontinuity", "rad", "turn of normal or surface that a pixel is gathered again for"}, {0, 10},
        [](Options& o) -> auto& { return o.threshold_rad; }),
    number<Options>(
        {"gather.contrast", "", "the same for a part of the irradiance"}, {0, 1},
        [](Options& o) -> auto& { return o.contrast; }),
    number<Options>(
        {"gather.distance", "", "the same for a part of the scene's diagonal"}, {0, 1},
        [](Options& o) -> auto& { return o.distance; }),
};

StageRole role(const FrameOptions& options) {
  return {.needs = {product<VirtualLightListGl>()},
          .uses = {product<NegativeLights>(), product<LightMaps>()},
          .adds = {{paths_by_lights(options)}}};
}

class StridedStage : public Stage {
 public:
  explicit StridedStage(const StageContext& context)
      : gather_(context.options.size, context.options.of<Options>()), reflected_(reflected_paths(context.options)) {}

  void run(FrameData& frame, gl::PassTimer& timer) override {
    const auto& lights = frame.get<VirtualLightListGl>();
    const bool reflected = frame.wanted.meets(reflected_);
    gather_.run(frame.gbuffer, lights, {frame.find<NegativeLights>(), frame.find<LightMaps>()},
                reflected ? VirtualLightGather::Part::all : VirtualLightGather::Part::emitted, frame.scene_diagonal_m,
                timer);
    if (lights.emitted > 0) frame.layers.push_back({&gather_.direct(), {LightPath::emission_direct}});
    if (reflected) frame.layers.push_back({&gather_.indirect(), reflected_});
  }
  void report(FrameReport& report) const override {
    const double share = double(gather_.coarse_share());
    report.add("coarse_share", share, fmt::format("{:.1f} % of the pixels from coarse ones", 100.0 * share));
    report.memory_bytes += gather_.bytes();
  }
  void list_textures(std::vector<NamedTexture>& list) const override { gather_.list_textures(list); }

 private:
  VirtualLightGather gather_;
  LightPaths reflected_;
};

}  // namespace

constinit const StageType STRIDED_GATHER{
    .name = "gather/strided",
    .slot = Slot::gather,
    .parameters = PARAMETERS,
    .role = role,
    .make = [](const StageContext& context) -> std::unique_ptr<Stage> {
      return std::make_unique<StridedStage>(context);
    },
    .report_nothing = [](FrameReport& report) { report.add("coarse_share", 0.0); }};

}  // namespace volgi::screen
