#include "screen/gather/area/area_stage.h"

#include <fmt/format.h>

#include <optional>

#include "core/surface.h"
#include "screen/gather/area/area_gather.h"
#include "screen/gather/area/area_lobes.h"

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
    number<Options>(
        {"area.interleave", "pixels", "levels of so many between neighbours, or fewer, share ways out to 2 x 2"},
        {0, 32}, [](Options& o) -> auto& { return o.interleave; }),
    yes_no<AreaLobeOptions>(
        {"area.variance", "", "shadows in narrow lobes by the variance of how far samples see, not by each alone"},
        [](AreaLobeOptions& o) -> auto& { return o.variance; }),
    number<MirrorApart>(
        {"glossy.least", "", "of even light that a pixel's lobe reflects to the viewer, for it to be apart"}, {0, 1},
        [](MirrorApart& o) -> auto& { return o.least; }),
};

StageRole role(const FrameOptions& options) {
  AreaGather::check(options.of<Options>());
  return {.needs = {product<AreaLights>()},
          .uses = {product<ScreenVoxels>(), product<BlockedFaces>(), product<HostRays>()},
          .adds = {{{LightPath::emission_direct}}, {{LightPath::emission_direct}, LightShare::mirror}}};
}

class AreaStage : public Stage {
 public:
  explicit AreaStage(const StageContext& context) : gather_(context.options.size, context.options.of<Options>()) {
    if (shines(context.scene)) {
      lobes_.emplace(context.options.size, context.options.of<AreaLobeOptions>(), has_phong_lobes(context.scene));
    }
  }

  void run(FrameData& frame, gl::PassTimer& timer) override {
    const auto& lights = frame.get<AreaLights>();
    if (lights.count() == 0) return;
    const AreaGather::Hidden hidden{frame.find<ScreenVoxels>(), frame.find<BlockedFaces>(), frame.find<HostRays>()};
    gather_.run(frame.gbuffer, lights, hidden, timer);
    frame.layers.push_back({&gather_.radiance(), {LightPath::emission_direct}});
    if (!lobes_) return;
    lobes_->run(frame.gbuffer, frame.camera, lights, gather_, hidden, timer);
    frame.layers.push_back({&lobes_->radiance(), {LightPath::emission_direct}, LightShare::mirror});
  }
  void scene_changed() override {
    gather_.scene_moved();
    if (lobes_) lobes_->scene_moved();
  }
  void report(FrameReport& report) const override {
    const AreaGather::Figures f = gather_.figures();
    report.add("gathered_share", f.gathered, fmt::format("{:.1f} % of the pixels gathered", 100.0 * f.gathered));
    report.add("ways_asked_share", f.asked, fmt::format("{:.1f} % of their ways to lights asked", 100.0 * f.asked));
    report.add("ways_asked", f.ways);
    report.add("gathered_of_level", f.level);
    report.memory_bytes += gather_.bytes();
    if (!lobes_) return;
    const double narrow = lobes_->narrow_share();
    report.add("narrow_lobe_share", narrow, fmt::format("lobes of {:.1f} % by samples", 100.0 * narrow));
    report.memory_bytes += lobes_->bytes();
  }
  void list_textures(std::vector<NamedTexture>& list) const override { gather_.list_textures(list); }

 private:
  AreaGather gather_;
  std::optional<AreaLobes> lobes_;
};

}  // namespace

constinit const StageType AREA_GATHER{
    .name = "gather/area",
    .slot = Slot::gather,
    .parameters = PARAMETERS,
    .role = role,
    .make = [](const StageContext& context) -> std::unique_ptr<Stage> { return std::make_unique<AreaStage>(context); }};

}  // namespace volgi::screen
