#include "screen/visibility/negative/negative_stage.h"

#include "screen/base/frame_voxels.h"
#include "screen/visibility/negative/negative_lights.h"

namespace volgi::screen {

namespace {

using Options = NegativeLightOptions;

constexpr const char* METHODS[] = {"cochran2007", "screen", "sides"};

constexpr Parameter PARAMETERS[] = {
    number<Options>(
        {"negative.count", "", "number of negative lights"}, {1, MAX_NEGATIVE_LIGHTS},
        [](Options& o) -> auto& { return o.count; }),
    choice<Options>(
        {"negative.method", "",
         "places and shapes them as Cochran and Steele 2007 do, by the flux that passes what the camera "
         "sees, or by the flux that passes the volume's sides"},
        METHODS, [](Options& o) -> auto& { return o.method; }),
};

StageRole role(const FrameOptions& options) {
  // They take from light that has been reflected.
  return {.active = asked_paths(options.light, options.bounces).contains(LightPath::punctual_first),
          .needs = {product<VirtualLightListGl>()},
          .makes = {product<NegativeLights>()}};
}

class NegativeStage : public Stage {
 public:
  explicit NegativeStage(const StageContext& context) : negative_(context.options.of<Options>()) {
    if (context.options.of<Options>().method != Options::Method::sides) return;
    voxels_ =
        make_frame_voxels(context.scene, context.options.of<VolumeOptions>(), runs_on_gpu(context.options.backend));
  }

  void run(FrameData& frame, gl::PassTimer& timer) override {
    if (voxels_) voxels_->run(frame.triangles, timer);
    negative_.run(frame.gbuffer, frame.camera, frame.get<VirtualLightListGl>(), voxels_ ? &voxels_->voxels() : nullptr,
                  timer, frame.sample);
    frame.lend(negative_);
  }
  void scene_changed() override {
    if (voxels_) voxels_->follow_scene();
  }
  void report(FrameReport& report) const override {
    report.add("negative_lights", double(negative_.count()), std::to_string(negative_.count()) + " negative lights");
    report.memory_bytes += negative_.bytes() + (voxels_ ? voxels_->bytes() : 0);
  }
  void list_lights(VirtualLightList& list) const override {
    for (const shared::NegativeLight& n : negative_.download())
      list.lights.push_back({n.position, n.area_m2, n.direction, VIRTUAL_LIGHT_NEGATIVE, n.flux, -1});
  }

 private:
  NegativeLights negative_;
  std::unique_ptr<FrameVoxels> voxels_;
};

}  // namespace

constinit const StageType NEGATIVE_LIGHTS_STAGE{
    .name = "visibility/negative",
    .slot = Slot::visibility,
    .parameters = PARAMETERS,
    .role = role,
    .make = [](const StageContext& context) -> std::unique_ptr<Stage> {
      return std::make_unique<NegativeStage>(context);
    },
    .report_nothing = [](FrameReport& report) { report.add("negative_lights", 0.0); }};

}  // namespace volgi::screen
