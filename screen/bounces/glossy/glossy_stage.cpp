#include "screen/bounces/glossy/glossy_stage.h"

#include <fmt/format.h>

#include "core/error.h"
#include "core/surface.h"
#include "propagation/volume_options.h"
#include "screen/bounces/glossy/lobe_rays.h"
#include "screen/bounces/glossy/side_radiosity.h"

namespace volgi::screen {

namespace {

using enum LightPath;
using Options = GlossyOptions;

constexpr LightPaths DIRECT{emission_direct, sky_direct};
constexpr LightPaths INDIRECT{punctual_first, emission_first, sky_first, punctual_higher, emission_higher, sky_higher};

constexpr Parameter PARAMETERS[] = {
    number<Options>(
        {"glossy.rays", "",
         "through the lobe of a surface that shines, for each pixel; 0: it reflects as if light were even"},
        {0, 256}, [](Options& o) -> auto& { return o.rays; }),
    number<Options>(
        {"glossy.interleave", "pixels", "blocks of n x n share rays and lights: 1, 2, 4 or 8"}, {1, 8},
        [](Options& o) -> auto& { return o.interleave; }),
    number<Options>(
        {"glossy.roughness", "", "narrower lobes take this one"}, {0.1, 1},
        [](Options& o) -> auto& { return o.least_roughness; }),
    number<MirrorApart>(
        {"glossy.least", "", "of even light that a pixel's lobe reflects to the viewer, for it to get rays"}, {0, 1},
        [](MirrorApart& o) -> auto& { return o.least; }),
};

StageRole role(const FrameOptions& options) {
  const int n = options.of<Options>().interleave;
  if (n != 1 && n != 2 && n != 4 && n != 8)
    throw Error(ExitCode::usage, fmt::format("glossy.interleave: 1, 2, 4 or 8, not {}", n));
  // Of nested grids no ray knows.
  const bool nested = options.of<VolumeOptions>().cascade.nested();
  if (options.of<Options>().rays == 0 || nested) return {.active = false};
  return {.needs = {product<FrameVolume>()},
          .uses = {product<AreaLights>()},
          .adds = {{DIRECT, LightShare::mirror}, {INDIRECT, LightShare::mirror}}};
}

class GlossyStage : public Stage {
 public:
  explicit GlossyStage(const StageContext& context)
      : bounces_(context.options.bounces),
        rays_(context.options.size, context.options.of<Options>(), has_phong_lobes(context.scene)) {}

  void run(FrameData& frame, gl::PassTimer& timer) override {
    const auto& volume = frame.get<FrameVolume>();
    if (!volume.sides_on_gpu())
      throw Error(ExitCode::over_limit,
                  "lobes of what shines need the volume's sides on the GPU, and these are more than fit into its "
                  "buffers; use a smaller --grid, or --set glossy.rays=0");
    sides_.run(volume, frame.shadow_maps, bounces_, timer);
    const float rotation_rad = frame.scene.sky ? frame.scene.sky->rotation_rad() : 0.0f;
    rays_.run(frame.gbuffer, frame.camera,
              {volume.voxels(), sides_.radiosity(), frame.find<AreaLights>(), frame.sky, rotation_rad}, timer,
              frame.sample);
    if (frame.wanted.meets(DIRECT)) frame.layers.push_back({&rays_.direct(), DIRECT, LightShare::mirror});
    if (frame.wanted.meets(INDIRECT)) frame.layers.push_back({&rays_.indirect(), INDIRECT, LightShare::mirror});
  }
  void scene_changed() override { rays_.scene_moved(); }
  void report(FrameReport& report) const override {
    const LobeRays::Shares shares = rays_.shares();
    report.add("glossy_share", shares.glossy, fmt::format("{:.1f} % of the pixels shine", 100.0 * shares.glossy));
    report.add(
        "glossy_widened_share", shares.widened,
        shares.widened > 0.0 ? fmt::format("{:.0f} % of their lobes widened", 100.0 * shares.widened) : std::string());
    report.memory_bytes += sides_.bytes() + rays_.bytes();
  }
  void list_textures(std::vector<NamedTexture>& list) const override { rays_.list_textures(list); }

 private:
  std::optional<int> bounces_;
  SideRadiosity sides_;
  LobeRays rays_;
};

}  // namespace

constinit const StageType GLOSSY{.name = "bounces/glossy",
                                 .slot = Slot::bounces,
                                 .parameters = PARAMETERS,
                                 .role = role,
                                 .make = [](const StageContext& context) -> std::unique_ptr<Stage> {
                                   return std::make_unique<GlossyStage>(context);
                                 },
                                 .report_nothing =
                                     [](FrameReport& report) {
                                       report.add("glossy_share", 0.0);
                                       report.add("glossy_widened_share", 0.0);
                                     }};

}  // namespace volgi::screen
