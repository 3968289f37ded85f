#include "screen/visibility/screen_voxels/screen_voxels_stage.h"

#include <optional>

#include "screen/visibility/screen_voxels/screen_voxels.h"
#include "screen/visibility/visibility_choice.h"

namespace volgi::screen {

namespace {

using Options = ScreenVoxelOptions;
using Ways = VisibilityChoice::Ways;

constexpr const char* WAYS[] = {"none", "voxels", "faces"};

constexpr Parameter PARAMETERS[] = {
    choice<VisibilityChoice>(
        {"area.visibility", "",
         "what hides lights on emissive surfaces: nothing, voxels of what the camera sees, or the volume's faces"},
        WAYS, [](VisibilityChoice& o) -> auto& { return o.ways; }),
    number<Options>(
        {"voxels.map", "texels", "area.visibility=voxels: on a side"}, {32, 1024},
        [](Options& o) -> auto& { return o.texels; }),
    number<Options>(
        {"voxels.bits", "", "area.visibility=voxels: slices in depth, 128, 256, 512 or 1024"}, {128, 1024},
        [](Options& o) -> auto& { return o.bits; }),
    number<Options>(
        {"voxels.steps", "", "area.visibility=voxels: samples along a way, at most"}, {8, 1024},
        [](Options& o) -> auto& { return o.steps; }),
    number<Options>(
        {"voxels.bias", "voxels", "area.visibility=voxels: that a way leaves out at both ends"}, {0, 16},
        [](Options& o) -> auto& { return o.bias; }),
};

StageRole role(const FrameOptions& options) {
  const Ways ways = options.of<VisibilityChoice>().ways;
  if (ways == Ways::none) return {.active = false};
  return {.makes = {ways == Ways::voxels ? product<ScreenVoxels>() : product<BlockedFaces>()}};
}

class ScreenVoxelsStage : public Stage {
 public:
  explicit ScreenVoxelsStage(const StageContext& context) {
    if (context.options.of<VisibilityChoice>().ways == Ways::voxels) {
      voxels_.emplace(context.options.of<Options>());
    } else {
      faces_ =
          make_frame_voxels(context.scene, context.options.of<VolumeOptions>(), runs_on_gpu(context.options.backend));
      lent_.emplace(BlockedFaces{faces_->voxels()});
    }
  }

  void run(FrameData& frame, gl::PassTimer& timer) override {
    if (voxels_) {
      voxels_->run(frame.triangles, frame.scene, frame.camera, frame.gbuffer.size(), timer);
      frame.lend(*voxels_);
    } else {
      faces_->run(frame.triangles, timer);
      lent_.emplace(BlockedFaces{faces_->voxels()});
      frame.lend(*lent_);
    }
  }
  void scene_changed() override {
    if (faces_) faces_->follow_scene();
  }
  void report(FrameReport& report) const override {
    report.memory_bytes += voxels_ ? voxels_->bytes() : faces_->bytes();
  }

 private:
  std::optional<ScreenVoxels> voxels_;
  std::unique_ptr<FrameVoxels> faces_;
  std::optional<BlockedFaces> lent_;
};

}  // namespace

constinit const StageType SCREEN_VOXELS{.name = "visibility/screen_voxels",
                                        .slot = Slot::visibility,
                                        .parameters = PARAMETERS,
                                        .role = role,
                                        .make = [](const StageContext& context) -> std::unique_ptr<Stage> {
                                          return std::make_unique<ScreenVoxelsStage>(context);
                                        }};

}  // namespace volgi::screen
