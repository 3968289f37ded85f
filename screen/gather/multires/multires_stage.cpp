#include "screen/gather/multires/multires_stage.h"

#include <fmt/format.h>

#include <optional>

#include "screen/frame/quality.h"
#include "screen/gather/gather_choice.h"
#include "screen/gather/multires/light_cut.h"
#include "screen/gather/multires/light_tree.h"
#include "screen/lights/light_choice.h"
#include "screen/lights/resample/resample_stage.h"
#include "screen/visibility/area_maps/light_clusters.h"

namespace volgi::screen {

namespace {

/// Of the cut through the light tree (LightTree).
struct TreeOptions {
  float zone = 2.0f;
};

constexpr const char* STAGES[] = {"interleaved", "multires"};

constexpr Parameter PARAMETERS[] = {
    choice<GatherChoice>(
        {"gather", "", "of clustered lights: interleaved and blurred, or by a light tree at the pixels that need it"},
        STAGES, [](GatherChoice& o) -> auto& { return o.stage; }),
    number<SmoothPixelOptions>(
        {"multires.coarsest", "pixels", "between those that are always gathered: 1, 2, 4, 8, 16 or 32"}, {1, 32},
        [](SmoothPixelOptions& o) -> auto& { return o.coarsest; }),
    number<SmoothPixelOptions>(
        {"multires.tolerance", "", "of its irradiance that a pixel's neighbours may err by"}, {0, 1},
        [](SmoothPixelOptions& o) -> auto& { return o.tolerance; }),
    number<TreeOptions>(
        {"tree.zone", "areas", "of a sum of lights around it are lit by its parts instead"}, {0.25, 1000},
        [](TreeOptions& o) -> auto& { return o.zone; }),
};

StageRole role(const FrameOptions& options) {
  if (options.of<GatherChoice>().stage != GatherChoice::Stage::multires) return {.active = false};
  SmoothPixels::check(options.of<SmoothPixelOptions>());
  StageRole r{.needs = {product<VirtualLightListGl>(), product<LightClusters>()},
              .makes = {product<SmoothGather>(), product<LightTree>()},
              .adds = {{paths_by_lights(options)}}};
  if (lights_are_subdivided(options)) r.needs.push_back(product<VirtualLightSubdivision>());
  return r;
}

class MultiresStage : public Stage {
 public:
  explicit MultiresStage(const StageContext& context)
      : reflected_(reflected_paths(context.options)),
        size_(context.options.size),
        gathered_later_(context.takes<SmoothGather>()),
        tree_(context.options.of<TreeOptions>().zone),
        pixels_(size_, context.options.of<SmoothPixelOptions>()) {}

  void run(FrameData& frame, gl::PassTimer& timer) override {
    const auto& lights = frame.get<VirtualLightListGl>();
    const auto& clusters = frame.get<LightClusters>();
    tree_.run(lights, frame.find<VirtualLightSubdivision>(), clusters.area_lights, frame.scene_diagonal_m, timer);
    if (!cut_) {
      cut_.emplace(size_, clusters.shadow);
      gather_.emplace(SmoothGather{pixels_, *cut_});
    }
    frame.lend(tree_);
    const bool with_direct = lights.emitted > 0;
    cut_->look_at(tree_, clusters, with_direct);
    if (gathered_later_) {
      frame.lend(*gather_);
    } else {
      SmoothLight* const alone = &*cut_;
      pixels_.run(frame.gbuffer, {&alone, 1}, timer);
    }
    if (with_direct) frame.layers.push_back({&cut_->direct(), {LightPath::emission_direct}});
    if (frame.wanted.meets(reflected_)) frame.layers.push_back({&cut_->indirect(), reflected_});
  }
  void report(FrameReport& report) const override {
    const double share = cut_ ? pixels_.gathered_share() : 0.0;
    report.add("gathered_share", share, fmt::format("{:.1f} % of the pixels gathered", 100.0 * share));
    report.memory_bytes += tree_.bytes() + pixels_.bytes() + (cut_ ? cut_->bytes() : 0);
  }
  void list_textures(std::vector<NamedTexture>& list) const override {
    pixels_.list_textures(list);
    if (cut_) cut_->list_textures(list);
  }

 private:
  LightPaths reflected_;
  glm::ivec2 size_;
  bool gathered_later_;  // by a stage that has smooth light of its own
  LightTree tree_;
  SmoothPixels pixels_;
  std::optional<LightCut> cut_;  // made with the first frame, whose shadow method its shader has
  std::optional<SmoothGather> gather_;
};

}  // namespace

constinit const StageType MULTIRES_GATHER{
    .name = "gather/multires",
    .slot = Slot::gather,
    .parameters = PARAMETERS,
    .role = role,
    .make = [](const StageContext& context) -> std::unique_ptr<Stage> {
      return std::make_unique<MultiresStage>(context);
    },
    .report_nothing = [](FrameReport& report) { report.add("gathered_share", 0.0); },
    .suit =
        [](const Needs& needs, TypeMap& settings) {
          auto& o = settings.of<SmoothPixelOptions>();
          o = {};
          o.tolerance *= float(needs.interpolation);
          if (needs.interpolation == 0.0) o.coarsest = 1;
        }};

}  // namespace volgi::screen
