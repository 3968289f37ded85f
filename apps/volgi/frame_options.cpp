#include "apps/volgi/frame_options.h"

#include "apps/volgi/parameter.h"
#include "core/error.h"

namespace volgi::app {

namespace {

using Options = screen::FrameOptions;

// What --set takes. Resolutions in texels of a layer's edge; 0 and 1 are no and yes.
constexpr Parameter<Options> kParameters[] = {
    {"shadow.spot", "texels on a side of a spot's map (1024)", 16, 8192,
     [](Options& o, double v) { o.shadow_resolution.spot = int(v); }},
    {"shadow.cube", "texels on a side of a point light's six maps (512)", 16, 8192,
     [](Options& o, double v) { o.shadow_resolution.cube_face = int(v); }},
    {"shadow.sun", "texels on a side of a directional light's map (2048)", 16, 8192,
     [](Options& o, double v) { o.shadow_resolution.sun = int(v); }},
    {"grid.shift", "moves the grid by this part of a cell on each axis, -1 ... 1 (0)", -1, 1,
     [](Options& o, double v) { o.volume.grid_shift_cells = glm::vec3(float(v)); }},
    {"ordinates.characteristic", "ordinates: 1 step-characteristic, 0 step (by the grid)", 0, 1,
     [](Options& o, double v) { o.volume.scheme.ordinates = v != 0.0 ? Ordinates::characteristic : Ordinates::step; }},
    {"solver.cg", "1 conjugate gradients over bounces, 0 one bounce after another (1 where the scheme allows it)", 0, 1,
     [](Options& o, double v) {
       o.volume.solver = v != 0.0 ? BounceRules::Solver::conjugate_gradients : BounceRules::Solver::plain;
     }},
    {"solver.warm", "1 starts from the last frame's answer (0)", 0, 1,
     [](Options& o, double v) { o.volume.warm_start = v != 0.0; }},
    {"solver.passes", "amortised: at most this many passes over the volume a frame (until done)", 1, 10000,
     [](Options& o, double v) { o.volume.passes_a_run = int(v); }},
    {"conservative.coarse", "conservative: 1 carries the tail on a grid of half the edge (1)", 0, 1,
     [](Options& o, double v) { o.volume.scheme.coarse_start = v != 0.0; }},
    {"gaitatzes.half_albedo", "gaitatzes2010: 1 takes 0.5 for every albedo after the first bounce (0)", 0, 1,
     [](Options& o, double v) { o.volume.scheme.constant_albedo = v != 0.0; }},
};

}  // namespace

void FrameCommandOptions::add_to(CLI::App& command) {
  command.add_option("--gi", gi, "technique; lpv is volume --scheme lpv2009")
      ->check(CLI::IsMember({"none", "lpv", "volume"}))
      ->capture_default_str();
  command.add_option("--light", light, "light shown; direct: straight from any emitter, indirect: after a reflection")
      ->check(CLI::IsMember({"full", "direct", "indirect"}))
      ->capture_default_str();
  command.add_option("--backend", backend, "where the volume is computed; auto: the CPU where GL is software")
      ->check(CLI::IsMember({"auto", "gpu", "cpu"}))
      ->capture_default_str();
  volume.add_to(command);
  command.add_option("--set", parameters, parameter_help(std::span<const Parameter<Options>>(kParameters)));
}

screen::FrameOptions FrameCommandOptions::frame_options(glm::ivec2 size) const {
  Options o;
  o.gi = gi == "none" ? screen::GiMode::none : screen::GiMode::volume;
  o.light = light == "full"     ? screen::LightPart::full
            : light == "direct" ? screen::LightPart::direct
                                : screen::LightPart::indirect;
  o.size = size;
  o.backend = backend == "gpu"   ? screen::Backend::gpu
              : backend == "cpu" ? screen::Backend::cpu
                                 : screen::Backend::automatic;
  o.volume = volume.volume_options();
  if (gi == "lpv") o.volume.scheme.scheme = Scheme::lpv2009;
  set_parameters(o, std::span<const Parameter<Options>>(kParameters), parameters);
  bounce_rules(o.volume, 0.5f);
  return o;
}

}  // namespace volgi::app
