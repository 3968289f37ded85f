#include "screen/lights/resample/resample_stage.h"

#include <optional>

#include "screen/lights/resample/resample_virtual_lights.h"
#include "screen/lights/resample/virtual_light_subdivision.h"
#include "screen/lights/rsm/virtual_lights.h"

namespace volgi::screen {

namespace {

using Options = ResampleOptions;

constexpr Parameter PARAMETERS[] = {
    number<Options>(
        {"vpl.one_of", "",
         "one virtual light of so many candidates, by what they send to the picture; 1 takes the paper's "
         "own samples"},
        {1, 32}, [](Options& o) -> auto& { return o.candidates; }),
    number<Options>(
        {"vpl.near", "areas",
         "of a virtual light around it are lit by its 16 parts instead, where the gather can (val, "
         "hybrid); 0: by the light alone"},
        {0, 1000}, [](Options& o) -> auto& { return o.near_zone; }),
};

StageRole role(const FrameOptions& options) {
  StageRole r{.active = options.of<Options>().candidates > 1,
              .needs = {product<VirtualLights>()},
              .makes = {product<VirtualLightListGl>()}};
  if (lights_are_subdivided(options)) r.makes.push_back(product<VirtualLightSubdivision>());
  return r;
}

class ResampledLights : public Stage {
 public:
  explicit ResampledLights(const StageContext& context) : choose_(context.options.of<Options>().candidates) {
    if (context.takes<VirtualLightSubdivision>()) parts_.emplace();
  }

  void run(FrameData& frame, gl::PassTimer& timer) override {
    const auto& candidates = frame.get<VirtualLights>();
    choose_.run(candidates.list(), frame.gbuffer, timer, frame.sample);
    frame.lend(choose_.lights());
    if (!parts_) return;
    parts_->run(frame.shadow_maps, candidates, choose_, timer, frame.sample);
    frame.lend(*parts_);
  }
  void report(FrameReport& report) const override {
    const int count = choose_.lights().count();
    report.add("vpls", double(count), std::to_string(count) + " virtual lights");
    report.memory_bytes += choose_.bytes() + (parts_ ? parts_->bytes() : 0);
  }
  void list_lights(VirtualLightList& list) const override { list.lights = download(choose_.lights()); }

 private:
  ResampleVirtualLights choose_;
  std::optional<VirtualLightSubdivision> parts_;
};

}  // namespace

bool lights_are_subdivided(const FrameOptions& options) {
  const auto& o = options.of<Options>();
  return o.near_zone > 0.0f && o.candidates > 1;
}

CandidatesAsked candidates_asked(const StageContext& of_candidates) {
  if (!of_candidates.takes<VirtualLights>()) return {};
  return {of_candidates.options.of<Options>().candidates, of_candidates.takes<VirtualLightSubdivision>()};
}

constinit const StageType RESAMPLED_LIGHTS{.name = "lights/resample",
                                           .slot = Slot::lights,
                                           .parameters = PARAMETERS,
                                           .role = role,
                                           .make = [](const StageContext& context) -> std::unique_ptr<Stage> {
                                             return std::make_unique<ResampledLights>(context);
                                           }};

}  // namespace volgi::screen
