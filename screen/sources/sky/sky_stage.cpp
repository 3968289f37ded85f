#include "screen/sources/sky/sky_stage.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "screen/frame/quality.h"
#include "screen/sources/sky/sky_gather.h"
#include "shaders/screen/sources/sky/slots.shared.h"

namespace volgi::screen {

namespace {

using Options = SkyOptions;

constexpr const char* FIRST[] = {"volume", "lights"};

constexpr Parameter PARAMETERS[] = {
    choice<Options>(
        {"sky.first", "", "what carries the first reflection of sky light", "volume in hybrid, lights elsewhere"},
        FIRST, [](Options& o) -> auto& { return o.first; }),
    number<Options>(
        {"sky.parts", "", "lights that stand for the sky, each with a map of its own"}, {16, SKY_MAX_PARTS},
        [](Options& o) -> auto& { return o.parts; }),
    number<Options>(
        {"sky.map", "texels", "on a side of each part's map"}, {16, 2048},
        [](Options& o) -> auto& { return o.map_texels; }),
    number<Options>(
        {"sky.tolerance", "", "of its light straight from the sky that a pixel's neighbours may err by"}, {0, 1},
        [](Options& o) -> auto& { return o.tolerance; }),
};

StageRole role(const FrameOptions&) { return {.makes = {product<SkyMaps>()}, .adds = {{{LightPath::sky_direct}}}}; }

class SkyStage : public Stage {
 public:
  explicit SkyStage(const StageContext& context) : maps_(context.options.of<Options>()) {
    if (context.wanted.contains(LightPath::sky_direct))
      gather_.emplace(context.options.size, context.options.of<Options>());
  }

  void run(FrameData& frame, gl::PassTimer& timer) override {
    if (!frame.scene.sky) return;
    maps_.run(frame.triangles, frame.scene, timer, frame.sample);
    frame.lend(maps_);
    if (!gather_) return;
    gather_->run(frame.gbuffer, maps_, timer);
    frame.layers.push_back({gather_->radiance().front(), {LightPath::sky_direct}});
  }
  void scene_changed() override { maps_.scene_moved(); }
  void report(FrameReport& report) const override {
    report.add("sky_parts", double(maps_.part_count()),
               maps_.part_count() > 0 ? std::to_string(maps_.part_count()) + " parts of the sky" : std::string());
    const bool gathered = gather_ && maps_.part_count() > 0;
    report.add("sky_gathered_share", gathered ? gather_->gathered_share() : 0.0);
    report.memory_bytes += maps_.bytes() + (gather_ ? gather_->bytes() : 0);
  }
  void list_textures(std::vector<NamedTexture>& list) const override {
    maps_.list_textures(list);
    if (gather_) gather_->list_textures(list);
  }

 private:
  SkyMaps maps_;
  std::optional<SkyGather> gather_;
};

}  // namespace

bool sky_goes_by_lights(const FrameOptions& options) {
  return options.of<Options>().first.value_or(Options::First::volume) == Options::First::lights;
}

void prefer_sky_by_lights(TypeMap& settings) {
  auto& first = settings.of<Options>().first;
  if (!first) first = Options::First::lights;
}

constinit const StageType SKY{
    .name = "sources/sky",
    .slot = Slot::sources,
    .parameters = PARAMETERS,
    .role = role,
    .make = [](const StageContext& context) -> std::unique_ptr<Stage> { return std::make_unique<SkyStage>(context); },
    .report_nothing =
        [](FrameReport& report) {
          report.add("sky_parts", 0.0);
          report.add("sky_gathered_share", 0.0);
        },
    .suit =
        [](const Needs& needs, TypeMap& settings) {
          settings.of<Options>().parts = std::min(int(std::lround(Options().parts * needs.maps)), SKY_MAX_PARTS);
          settings.of<Options>().map_texels = int(std::lround(Options().map_texels * needs.maps));
        }};

}  // namespace volgi::screen
