#include "screen/lights/patches/patches_stage.h"

#include <fmt/format.h>

#include <algorithm>

#include "screen/lights/light_choice.h"
#include "screen/lights/patches/light_patches.h"
#include "shaders/screen/lights/patches/light_patch.shared.h"

namespace volgi::screen {

namespace {

using Options = LightPatchOptions;

constexpr const char* METHODS[] = {"grid", "radiosity", "hierarchical"};
constexpr const char* LIGHTS[] = {"printed", "exact", "summed"};

constexpr Parameter PARAMETERS[] = {
    choice<Options>(
        {"patches.method", "",
         "lights on a grid over the map, patches of one surface each, or a tree of patches for every fragment"},
        METHODS, [](Options& o) -> auto& { return o.method; }),
    number<Options>(
        {"patches.grid", "", "coarsest patches on a side of a map, a power of two"}, {1, 1024},
        [](Options& o) -> auto& { return o.grid; }),
    number<Options>(
        {"patches.depth", "", "how often a patch may be divided by four, where its map has texels for it"},
        {0, MAX_PATCH_DEPTH}, [](Options& o) -> auto& { return o.depth; }),
    choice<Options>(
        {"patches.light", "",
         "of a patch: of its middle and all solid angles alike, as printed; of its middle and its own solid angle; or "
         "the sum over it"},
        LIGHTS, [](Options& o) -> auto& { return o.light; }),
    number<Options>(
        {"patches.depth_range", "",
         "of the scene's diagonal, above which a patch shows several surfaces: radiosity divides it"},
        {0, 10}, [](Options& o) -> auto& { return o.depth_range; }),
    number<Options>(
        {"patches.normal_range", "", "of a component of its normals, above which it does"}, {0, 2},
        [](Options& o) -> auto& { return o.normal_range; }),
    yes_no<Options>(
        {"patches.edges", "", "hierarchical divides such patches, too, from any distance"},
        [](Options& o) -> auto& { return o.edges; }),
};

StageRole role(const FrameOptions& options) {
  LightPatches::check(options.of<Options>());
  StageRole r{.makes = {product<VirtualLightListGl>()}};
  if (lights_are_a_hierarchy(options)) r.makes.push_back(product<LightPatchTree>());
  return r;
}

class PatchesStage : public Stage {
 public:
  explicit PatchesStage(const StageContext& context) : patches_(context.options.of<Options>()) {}

  void run(FrameData& frame, gl::PassTimer& timer) override {
    patches_.run(frame.shadow_maps, frame.scene_diagonal_m, timer);
    frame.lend(patches_.lights());
    frame.lend(patches_.tree());
  }
  void report(FrameReport& report) const override {
    const std::vector<shared::VirtualLight> lights = download(patches_.lights());
    const auto lit = std::count_if(lights.begin(), lights.end(),
                                   [](const shared::VirtualLight& l) { return l.flux.x + l.flux.y + l.flux.z > 0.0f; });
    report.add("patches", double(lit), fmt::format("{} patches of light", lit));
    report.memory_bytes += patches_.bytes();
  }
  void list_lights(VirtualLightList& list) const override {
    for (const shared::VirtualLight& l : download(patches_.lights())) {
      if (l.flux.x + l.flux.y + l.flux.z > 0.0f) list.lights.push_back(l);
    }
  }

 private:
  LightPatches patches_;
};

void prefer(TypeMap& settings, Options::Method method) {
  settings.of<LightChoice>().stage = LightChoice::Stage::patches;
  settings.of<Options>().method = method;
}

}  // namespace

void prefer_light_grid(TypeMap& settings) { prefer(settings, Options::Method::grid); }
void prefer_light_patches(TypeMap& settings) { prefer(settings, Options::Method::radiosity); }
void prefer_light_hierarchy(TypeMap& settings) { prefer(settings, Options::Method::hierarchical); }

bool lights_are_a_hierarchy(const FrameOptions& options) {
  return options.of<Options>().method == Options::Method::hierarchical &&
         options.of<LightChoice>().stage == LightChoice::Stage::patches;
}

constinit const StageType LIGHT_PATCHES{.name = "lights/patches",
                                        .slot = Slot::lights,
                                        .parameters = PARAMETERS,
                                        .role = role,
                                        .make = [](const StageContext& context) -> std::unique_ptr<Stage> {
                                          return std::make_unique<PatchesStage>(context);
                                        },
                                        .report_nothing = [](FrameReport& report) { report.add("patches", 0.0); }};

}  // namespace volgi::screen
