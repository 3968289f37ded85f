#include "apps/volgi/frame_options.h"

#include <CLI/CLI.hpp>

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
    {"vpl.flux", "vpl, negative: 1 samples by reflected flux, 0 by solid angle (0)", 0, 1,
     [](Options& o, double v) {
       using Sampling = screen::VirtualLightOptions::Sampling;
       o.virtual_lights.sampling = v != 0.0 ? Sampling::flux : Sampling::halton;
     }},
    {"vpl.one_of",
     "vpl, negative: one virtual light of so many candidates, by what they send to the picture; 1 takes the paper's "
     "own "
     "samples (16)",
     1, 32, [](Options& o, double v) { o.choose_one_of = int(v); }},
    {"vpl.near",
     "val, hybrid: so many areas of a virtual light around it are lit by its 16 parts instead; 0: by the light alone "
     "(4)",
     0, 1000, [](Options& o, double v) { o.near_zone = float(v); }},
    {"negative.count", "negative: number of negative lights (256)", 1, NEGATIVE_LIGHTS_MOST,
     [](Options& o, double v) { o.negative_lights.count = int(v); }},
    {"negative.method",
     "negative: 0 places and shapes them as Cochran and Steele 2007 do, 1 by the flux that passes what the camera "
     "sees, "
     "2 by the flux that passes the volume's sides (2)",
     0, 2, [](Options& o, double v) { o.negative_lights.method = screen::NegativeLightOptions::Method(int(v)); }},
    {"gather.stride", "virtual lights: pixels between coarse ones, 1 gathers at every pixel (2)", 1, 16,
     [](Options& o, double v) { o.gather.stride = int(v); }},
    {"gather.discontinuity", "virtual lights: turn of normal or surface that a pixel is gathered again for [rad] (0.2)",
     0, 10, [](Options& o, double v) { o.gather.threshold_rad = float(v); }},
    {"gather.contrast", "virtual lights: the same for a part of the irradiance (0.15)", 0, 1,
     [](Options& o, double v) { o.gather.contrast = float(v); }},
    {"gather.distance", "virtual lights: the same for a part of the scene's diagonal (0.05)", 0, 1,
     [](Options& o, double v) { o.gather.distance = float(v); }},
    {"val.shadow", "val, hybrid: 0 convolution soft shadow maps, 1 percentage-closer, 2 one comparison (2)", 0, 2,
     [](Options& o, double v) { o.area_light_shadow = screen::AreaLightShadow::Method(int(v)); }},
    {"val.map", "val, hybrid: texels on a side of an area light's map (256)", 16, 4096,
     [](Options& o, double v) { o.area_light_map = int(v); }},
    {"val.interleave", "val, hybrid: pixels of blocks of n x n share the lights: 1, 2, 4 or 8 (4)", 1, 8,
     [](Options& o, double v) { o.area_light_gather.interleave = int(v); }},
    {"val.exact", "val, hybrid: as many pixels as so many rows hold get every light, the worst ones (10)", 0, 65536,
     [](Options& o, double v) { o.area_light_gather.exact_rows = float(v); }},
    {"gaitatzes.half_albedo", "gaitatzes2010: 1 takes 0.5 for every albedo after the first bounce (0)", 0, 1,
     [](Options& o, double v) { o.volume.scheme.constant_albedo = v != 0.0; }},
};

screen::GiMode gi_mode(const std::string& name) {
  using screen::GiMode;
  if (name == "none") return GiMode::none;
  if (name == "vpl") return GiMode::vpl;
  if (name == "val") return GiMode::val;
  if (name == "hybrid") return GiMode::hybrid;
  return name == "negative" ? GiMode::negative : GiMode::volume;
}

}  // namespace

void FrameCommandOptions::add_to(CLI::App& command) {
  command.add_option("--gi", gi, "technique; lpv is volume --scheme lpv2009 (hybrid; with the papers' schemes volume)")
      ->check(CLI::IsMember({"none", "lpv", "volume", "vpl", "negative", "val", "hybrid"}));
  command.add_option("--light", light, "light shown; direct: straight from any emitter, indirect: after a reflection")
      ->check(CLI::IsMember({"full", "direct", "indirect"}))
      ->capture_default_str();
  command.add_option("--backend", backend, "where the volume is computed; auto: the CPU where GL is software")
      ->check(CLI::IsMember({"auto", "gpu", "cpu"}))
      ->capture_default_str();
  volume.add_to(command);
  command.add_option("--vpls", vpls, "virtual point lights of all lights together, shared by flux")
      ->check(CLI::Range(1, screen::VirtualLightOptions::kMost))
      ->capture_default_str();
  command.add_option("--vpls-per-light", vpls_per_light, "as many for each light instead (emitters count as one)")
      ->check(CLI::Range(1, screen::VirtualLightOptions::kMost));
  command
      .add_option("--vals", vals,
                  "val, hybrid: virtual area lights, clusters of virtual point lights that share a shadow")
      ->check(CLI::Range(1, VIRTUAL_AREA_LIGHTS_MOST))
      ->capture_default_str();
  command.add_option("--set", parameters, parameter_help(std::span<const Parameter<Options>>(kParameters)));
}

std::string FrameCommandOptions::technique() const {
  if (!gi.empty()) return gi;
  return carries_sides(volume.volume_options().scheme.scheme) ? "hybrid" : "volume";
}

screen::FrameOptions FrameCommandOptions::frame_options(glm::ivec2 size) const {
  Options o;
  o.gi = gi_mode(technique());
  o.light = light == "full"     ? screen::LightPart::full
            : light == "direct" ? screen::LightPart::direct
                                : screen::LightPart::indirect;
  o.size = size;
  o.backend = backend == "gpu"   ? screen::Backend::gpu
              : backend == "cpu" ? screen::Backend::cpu
                                 : screen::Backend::automatic;
  o.volume = volume.volume_options();
  o.virtual_lights.count = vpls;
  o.virtual_lights.per_light = vpls_per_light;
  o.area_lights.count = vals;
  if (gi == "lpv") o.volume.scheme.scheme = Scheme::lpv2009;
  set_parameters(o, std::span<const Parameter<Options>>(kParameters), parameters);
  bounce_rules(o.volume, 0.5f);
  return o;
}

}  // namespace volgi::app
