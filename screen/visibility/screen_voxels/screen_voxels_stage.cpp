#include "screen/visibility/screen_voxels/screen_voxels_stage.h"

#include <optional>

#include "core/surface.h"

#include "screen/visibility/host_rays/host_rays.h"
#include "screen/visibility/screen_voxels/screen_voxels.h"
#include "screen/visibility/visibility_choice.h"

namespace volgi::screen {

namespace {

using Options = ScreenVoxelOptions;
using Ways = VisibilityChoice::Ways;

constexpr const char* WAYS[] = {"none", "voxels", "faces", "rays"};

constexpr Parameter PARAMETERS[] = {
    choice<VisibilityChoice>(
        {"area.visibility", "",
         "what hides lights on emissive surfaces: nothing, voxels of what the camera sees, the volume's faces, or rays "
         "of "
         "the CPU"},
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
  switch (ways) {
    case Ways::none:
      return {.active = false};
    case Ways::voxels:
      return {.makes = {product<ScreenVoxels>()}};
    case Ways::faces:
      return {.makes = {product<BlockedFaces>()}};
    case Ways::rays:
      return {.makes = {product<HostRays>(), product<BlockedFaces>()}};
  }
  return {};
}

class ScreenVoxelsStage : public Stage {
 public:
  explicit ScreenVoxelsStage(const StageContext& context) {
    const Ways ways = context.options.of<VisibilityChoice>().ways;
    if (ways == Ways::voxels) voxels_.emplace(context.options.of<Options>());
    if (ways == Ways::rays) rays_.emplace(context.scene);
    if (ways == Ways::faces || (ways == Ways::rays && shines(context.scene)))
      faces_ =
          make_frame_voxels(context.scene, context.options.of<VolumeOptions>(), runs_on_gpu(context.options.backend));
  }

  void run(FrameData& frame, gl::PassTimer& timer) override {
    if (voxels_) {
      voxels_->run(frame.triangles, frame.scene, frame.camera, frame.gbuffer.size(), timer);
      frame.lend(*voxels_);
    }
    if (faces_) {
      faces_->run(frame.triangles, timer);
      lent_.emplace(BlockedFaces{faces_->voxels()});
      frame.lend(*lent_);
    }
    if (rays_) frame.lend(*rays_);
  }
  void scene_changed() override {
    if (faces_) faces_->follow_scene();
    if (rays_) rays_->scene_moved();
  }
  void report(FrameReport& report) const override {
    report.memory_bytes += voxels_ ? voxels_->bytes() : faces_ ? faces_->bytes() : 0;
  }

 private:
  std::optional<ScreenVoxels> voxels_;
  std::unique_ptr<FrameVoxels> faces_;
  std::optional<BlockedFaces> lent_;
  std::optional<HostRays> rays_;
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
