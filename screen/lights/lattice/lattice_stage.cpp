#include "screen/lights/lattice/lattice_stage.h"

#include <string>

#include "screen/lights/lattice/wave_lattice.h"

namespace volgi::screen {

namespace {

using Options = WaveLatticeOptions;

constexpr const char* DEPTHS[] = {"scene", "ray"};
constexpr const char* POWERS[] = {"printed", "conserving"};

template <size_t k>
constexpr Parameter factor_of_shell(const char* name) {
  return number<Options>(
      {name, "", "of the power of a shell's lights, printed; shell 1 is the nearest"}, {0, 1e6},
      [](Options & o) -> auto& { return o.factor[k]; });
}

constexpr Parameter PARAMETERS[] = {
    number<Options>(
        {"lattice.angle", "deg", "between rays, about the light's axis and along it"}, {1, 90},
        [](Options& o) -> auto& { return o.angle_deg; }),
    number<Options>(
        {"lattice.shells", "", "lights on each ray"}, {1, LATTICE_MAX_SHELLS},
        [](Options& o) -> auto& { return o.shells; }),
    number<Options>(
        {"lattice.farthest", "", "distance of the last shell over the scene's depth from the light"}, {0.01, 10},
        [](Options& o) -> auto& { return o.farthest; }),
    number<Options>(
        {"lattice.growth", "", "of distances from shell to shell"}, {1.01, 10},
        [](Options& o) -> auto& { return o.growth; }),
    choice<Options>(
        {"lattice.depth", "", "what distances are parts of: the farthest surface, or what each ray meets"}, DEPTHS,
        [](Options& o) -> auto& { return o.depth; }),
    choice<Options>(
        {"lattice.power", "",
         "of the lights: what the light sends, attenuated, times a factor for each shell; or what "
         "surfaces reflect of it"},
        POWERS, [](Options& o) -> auto& { return o.power; }),
    number<Options>(
        {"lattice.attenuation", "", "printed: exp(-this x distance over depth) of a light's power is left"}, {0, 100},
        [](Options& o) -> auto& { return o.attenuation; }),
    factor_of_shell<0>("lattice.factor1"),
    factor_of_shell<1>("lattice.factor2"),
    factor_of_shell<2>("lattice.factor3"),
    factor_of_shell<3>("lattice.factor4"),
    factor_of_shell<4>("lattice.factor5"),
    factor_of_shell<5>("lattice.factor6"),
    factor_of_shell<6>("lattice.factor7"),
    factor_of_shell<7>("lattice.factor8"),
    number<Options>(
        {"lattice.on", "%", "of the lights, chosen by chance, which stand for the others"}, {0.01, 100},
        [](Options& o) -> auto& { return o.on_percent; }),
    number<Options>(
        {"lattice.seed", "", "of the choice; while it stays, the same lights are on"}, {0, 1000000},
        [](Options& o) -> auto& { return o.seed; }),
};

StageRole role(const FrameOptions& /*options*/) { return {.makes = {product<VirtualLightListGl>()}}; }

class LatticeLights : public Stage {
 public:
  explicit LatticeLights(const StageContext& context)
      : lattice_(context.scene, context.options.of<Options>(), context.options.bounces) {}

  void run(FrameData& frame, gl::PassTimer& timer) override {
    lattice_.run(frame.shadow_maps, timer);
    frame.lend(lattice_.list());
  }
  void scene_changed() override { lattice_.scene_moved(); }
  void report(FrameReport& report) const override {
    const int count = lattice_.list().count();
    report.add("vpls", double(count), std::to_string(count) + " lights of the lattice");
    report.memory_bytes += lattice_.bytes();
  }
  void list_lights(VirtualLightList& list) const override { list.lights = download(lattice_.list()); }

 private:
  WaveLattice lattice_;
};

}  // namespace

constinit const StageType LATTICE_LIGHTS{.name = "lights/lattice",
                                         .slot = Slot::lights,
                                         .parameters = PARAMETERS,
                                         .role = role,
                                         .make = [](const StageContext& context) -> std::unique_ptr<Stage> {
                                           return std::make_unique<LatticeLights>(context);
                                         }};

}  // namespace volgi::screen
