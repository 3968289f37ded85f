#include "screen/gather/interleaved/interleaved_stage.h"

#include <optional>

#include "screen/gather/gather_choice.h"
#include "screen/gather/interleaved/area_light_gather.h"
#include "screen/gather/interleaved/near_lights.h"
#include "screen/lights/light_choice.h"
#include "screen/lights/resample/resample_stage.h"
#include "screen/visibility/area_maps/light_clusters.h"

namespace volgi::screen {

namespace {

using Options = AreaLightGatherOptions;

constexpr Parameter PARAMETERS[] = {
    number<Options>(
        {"val.interleave", "pixels", "gather=interleaved: blocks of n x n share the lights: 1, 2, 4 or 8"}, {1, 8},
        [](Options& o) -> auto& { return o.interleave; }),
    number<Options>(
        {"val.exact", "rows",
         "gather=interleaved: as many pixels as so many rows hold get every light, the worst ones"},
        {0, 65536}, [](Options& o) -> auto& { return o.exact_rows; }),
};

StageRole role(const FrameOptions& options) {
  if (options.of<GatherChoice>().stage != GatherChoice::Stage::interleaved) return {.active = false};
  const LightPaths paths = paths_by_lights(options);
  AreaLightGather::check(options.of<Options>());
  StageRole r{.needs = {product<VirtualLightListGl>(), product<LightClusters>()}};
  if (lights_are_subdivided(options)) {
    r.needs.push_back(product<VirtualLightSubdivision>());
    r.adds = {{paths, LightShare::near}, {paths, LightShare::far}};
  } else {
    r.adds = {{paths}};
  }
  return r;
}

class InterleavedStage : public Stage {
 public:
  explicit InterleavedStage(const StageContext& context)
      : options_(options_for(context)), reflected_(reflected_paths(context.options)), size_(context.options.size) {
    if (options_.near_zone > 0.0f) near_.emplace(size_, options_.near_zone);
  }

  void run(FrameData& frame, gl::PassTimer& timer) override {
    const auto& lights = frame.get<VirtualLightListGl>();
    const auto& clusters = frame.get<LightClusters>();
    if (!gather_) gather_.emplace(size_, options_, clusters.shadow);
    if (near_) near_->run(frame.gbuffer, lights, frame.get<VirtualLightSubdivision>(), timer);
    gather_->run(frame.gbuffer, lights, clusters.area_lights, clusters.maps, clusters.shadow, frame.scene_diagonal_m,
                 timer, frame.sample);
    add_layers(*gather_, near_ ? LightShare::far : LightShare::whole, lights, frame);
    if (near_) add_layers(*near_, LightShare::near, lights, frame);
  }
  void report(FrameReport& report) const override {
    report.memory_bytes += (gather_ ? gather_->bytes() : 0) + (near_ ? near_->bytes() : 0);
  }
  void list_textures(std::vector<NamedTexture>& list) const override {
    if (near_) near_->list_textures(list);
    if (gather_) gather_->list_textures(list);
  }

 private:
  static Options options_for(const StageContext& context) {
    Options o = context.options.of<Options>();
    o.near_zone = lights_are_subdivided(context.options) ? context.options.of<ResampleOptions>().near_zone : 0.0f;
    return o;
  }
  template <class Pass>
  void add_layers(const Pass& pass, LightShare share, const VirtualLightListGl& lights, FrameData& frame) const {
    // Without lights on emissive surfaces nobody has written it in this frame.
    if (lights.emitted > 0) frame.layers.push_back({&pass.direct(), {LightPath::emission_direct}, share});
    if (frame.wanted.meets(reflected_)) frame.layers.push_back({&pass.indirect(), reflected_, share});
  }

  Options options_;
  LightPaths reflected_;
  glm::ivec2 size_;
  std::optional<AreaLightGather> gather_;  // made with the first frame, whose shadow method its shader has
  std::optional<NearLights> near_;
};

}  // namespace

constinit const StageType INTERLEAVED_GATHER{.name = "gather/interleaved",
                                             .slot = Slot::gather,
                                             .parameters = PARAMETERS,
                                             .role = role,
                                             .make = [](const StageContext& context) -> std::unique_ptr<Stage> {
                                               return std::make_unique<InterleavedStage>(context);
                                             }};

}  // namespace volgi::screen
