#include "screen/lights/rsm/rsm_stage.h"

#include <algorithm>
#include <cmath>

#include "screen/frame/quality.h"
#include "screen/lights/resample/resample_stage.h"
#include "screen/lights/rsm/virtual_lights.h"
#include "screen/sources/sky/sky_stage.h"

namespace volgi::screen {

namespace {

using Options = VirtualLightOptions;

constexpr const char* SAMPLINGS[] = {"halton", "flux"};

constexpr Parameter PARAMETERS[] = {
    number<Options>(
        {"vpl.count", "", "virtual point lights of all lights together, shared by flux", nullptr, "--vpls"},
        {1, Options::kMaxCount}, [](Options& o) -> auto& { return o.count; }),
    number<Options>(
        {"vpl.per_light", "", "as many for each light instead (emitters count as one)", "by flux", "--vpls-per-light"},
        {1, Options::kMaxCount}, [](Options& o) -> auto& { return o.per_light; }),
    choice<Options>(
        {"vpl.flux", "", "samples by solid angle (Halton's points), or by reflected flux"}, SAMPLINGS,
        [](Options& o) -> auto& { return o.sampling; }),
};

StageRole role(const FrameOptions& options) {
  std::vector<Product> uses;
  if (sky_goes_by_lights(options)) uses.push_back(product<SkyMaps>());
  return {.uses = std::move(uses), .makes = {product<VirtualLights>(), product<VirtualLightListGl>()}};
}

class RsmLights : public Stage {
 public:
  explicit RsmLights(const StageContext& context)
      : lights_(context.scene, options_for(context)), with_sky_(sky_goes_by_lights(context.options)) {}

  void run(FrameData& frame, gl::PassTimer& timer) override {
    lights_.run(frame.shadow_maps, with_sky_ ? frame.find<SkyMaps>() : nullptr, timer, frame.sample);
    frame.lend(lights_);
    frame.lend(lights_.list());
  }
  void scene_changed() override { lights_.scene_moved(); }
  void report(FrameReport& report) const override {
    report.add("vpls", double(lights_.count()), std::to_string(lights_.count()) + " virtual lights");
    report.memory_bytes += lights_.bytes();
  }
  void list_lights(VirtualLightList& list) const override { list.lights = download(lights_.list()); }

 private:
  static Options options_for(const StageContext& context) {
    Options o = context.options.of<Options>();
    const CandidatesAsked asked = candidates_asked(context);
    o.candidates = asked.for_each_light;
    o.along_curve = asked.along_curve;
    return o;
  }
  VirtualLights lights_;
  bool with_sky_;
};

}  // namespace

constinit const StageType RSM_LIGHTS{
    .name = "lights/rsm",
    .slot = Slot::lights,
    .parameters = PARAMETERS,
    .role = role,
    .make = [](const StageContext& context) -> std::unique_ptr<Stage> { return std::make_unique<RsmLights>(context); },
    .report_nothing = [](FrameReport& report) { report.add("vpls", 0.0); },
    .suit =
        [](const Needs& needs, TypeMap& settings) {
          const double count = double(Options().count) * needs.lights;
          settings.of<Options>().count = std::clamp(int(std::lround(count)), 1, Options::kMaxCount);
        }};

}  // namespace volgi::screen
