#include "screen/sources/textured_area/textured_area_stage.h"

#include <fmt/format.h>

#include "screen/sources/textured_area/area_lights.h"

namespace volgi::screen {

namespace {

using Options = AreaLightOptions;

constexpr const char* SAMPLINGS[] = {"grid", "importance"};

constexpr Parameter PARAMETERS[] = {
    number<Options>(
        {"area.lights", "", "on emissive surfaces, for stages that light by them: 256 is a screen of 16 x 16"},
        {1, AreaLights::kMaxLights}, [](Options& o) -> auto& { return o.lights; }),
    choice<Options>(
        {"area.sampling", "", "lights on an even grid, or where the texture is bright"}, SAMPLINGS,
        [](Options& o) -> auto& { return o.sampling; }),
};

StageRole role(const FrameOptions& /*options*/) { return {.makes = {product<AreaLights>()}}; }

class TexturedAreaStage : public Stage {
 public:
  explicit TexturedAreaStage(const StageContext& context) : lights_(context.scene, context.options.of<Options>()) {}

  void run(FrameData& frame, gl::PassTimer& timer) override {
    lights_.run(timer, frame.sample);
    frame.lend(lights_);
  }
  void scene_changed() override { lights_.scene_moved(); }
  void report(FrameReport& report) const override {
    report.add("area_lights", double(lights_.count()),
               lights_.count() > 0 ? fmt::format("{} lights on emissive surfaces", lights_.count()) : std::string());
    report.memory_bytes += lights_.bytes();
  }
  void list_lights(VirtualLightList& list) const override { list.lights = lights_.download(); }

 private:
  AreaLights lights_;
};

}  // namespace

constinit const StageType TEXTURED_AREA{.name = "sources/textured_area",
                                        .slot = Slot::sources,
                                        .parameters = PARAMETERS,
                                        .role = role,
                                        .make = [](const StageContext& context) -> std::unique_ptr<Stage> {
                                          return std::make_unique<TexturedAreaStage>(context);
                                        },
                                        .report_nothing = [](FrameReport& report) { report.add("area_lights", 0.0); }};

}  // namespace volgi::screen
