#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <cstdio>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <string>

#include "apps/volgi/area_video.h"
#include "apps/volgi/commands.h"
#include "apps/volgi/scene_options.h"
#include "core/atomic_file.h"
#include "core/error.h"
#include "core/image.h"
#include "core/log.h"
#include "core/scene.h"
#include "core/virtual_light_list.h"
#include "core/visibility/openness.h"
#include "reference/path_tracer.h"
#include "reference/virtual_light_tracer.h"

namespace volgi::app {
namespace {

struct ReferenceOptions {
  SceneOptions scene;
  AreaVideo video;
  std::filesystem::path output;
  PathTracerOptions tracer;
  std::optional<int> bounces;
  std::string light = "full", filter = "point";
  std::optional<std::filesystem::path> virtual_lights;  // none: paths are traced
  std::string visibility = "exact";
  bool quiet = false;
};

PathTracerOptions::Light requested_light(const std::string& light) {
  if (light == "direct") return PathTracerOptions::Light::direct;
  return light == "indirect" ? PathTracerOptions::Light::indirect : PathTracerOptions::Light::full;
}

Scene scene_of(ReferenceOptions& options) {
  Scene scene = load_scene(options.scene.scene_path, options.scene.time_s, options.scene.file.reading);
  options.video.show(scene, options.scene.time_s);
  options.scene.light.apply(scene);
  return scene;
}

ReferencePicture traced(ReferenceOptions& options) {
  PathTracerOptions tracer = options.tracer;
  tracer.size = options.scene.size();
  tracer.max_bounces = options.bounces;
  tracer.light = requested_light(options.light);
  if (options.filter == "box") tracer.filter = PathTracerOptions::Filter::box;
  const Scene scene = scene_of(options);
  warn_of_open_scene(scene, glm::vec3(options.scene.camera(scene).world_from_camera[3]));
  return path_trace(scene, options.scene.camera(scene), tracer);
}

ReferencePicture gathered(ReferenceOptions& options) {
  if (options.filter != "point")
    throw Error(ExitCode::usage, "--filter box: --vpls gathers at pixel centres only, leave --filter out");
  VirtualLightGatherOptions gather;
  gather.size = options.scene.size();
  gather.light = requested_light(options.light);
  gather.seed = options.tracer.seed;
  gather.threads = options.tracer.threads;
  if (options.visibility == "none") gather.visibility = VirtualLightGatherOptions::Visibility::none;
  const VirtualLightList list = read_virtual_lights(*options.virtual_lights);
  const Scene scene = scene_of(options);
  return gather_virtual_lights(scene, options.scene.camera(scene), list, gather);
}

void render(ReferenceOptions& options) {
  set_quiet(options.quiet);
  if (options.output.extension() != ".exr")
    throw Error(ExitCode::usage,
                fmt::format("-o {}: a reference is an EXR file, name it *.exr", options.output.string()));
  check_writable(options.output);  // not after hours of rendering
  write_exr(options.output, to_channels(options.virtual_lights ? gathered(options) : traced(options)));
}

constexpr const char* kFooter =
    R"(Writes R,G,B [W m^-2 sr^-1]; direct; noise, direct_noise (half the difference of two independent halves of the
samples, what `volgi compare` takes out); position [m], normal, albedo, id, depth [m]; lit, with bit k where punctual
light k reaches the pixel's centre (not with --vpls). With --light indirect the direct layer is called left_out.direct.
The same bytes for any number of threads.
--vpls gathers virtual lights of `volgi render --dump` instead of tracing paths, with the noise layers zero: reflected
ones are the indirect light; emitted ones are the direct light of emissive surfaces, beside the exact punctual light;
negative ones are left out, exact visibility is what they stand for. Cost: pixels x lights shadow rays, 100 million for
320x320 and 1024 lights.
Example: volgi reference data/reference/scenes/cornell.glb -o cornell.exr --size 192x192 --spp 1024
         volgi reference cornell.glb -o same_lights.exr --size 192x192 --vpls dump/virtual_lights.json)";

}  // namespace

void add_reference_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<ReferenceOptions>();
  CLI::App& command = *app.add_subcommand("reference", "Path-traced reference picture of a scene (Embree, CPU)");
  options->scene.add_to(command);
  options->video.add_to(command);
  command.add_option("-o,--output", options->output, "EXR file to write")->required();
  CLI::Option* spp =
      command.add_option("--spp", options->tracer.samples_per_pixel, "samples per pixel, rounded up to an even number")
          ->check(CLI::Range(1, 1 << 24))
          ->capture_default_str();
  CLI::Option* bounces = command
                             .add_option("--bounces", options->bounces,
                                         "largest number of reflections, 0 is direct light only [unlimited]")
                             ->check(CLI::Range(0, std::numeric_limits<int>::max()));
  command.add_option("--light", options->light, "light in R,G,B")
      ->check(CLI::IsMember({"full", "direct", "indirect"}))
      ->capture_default_str();
  command.add_option("--seed", options->tracer.seed, "seed of the random numbers")->capture_default_str();
  command
      .add_option("--filter", options->filter,
                  "point: pixel centres, as a rasterizer samples; box: mean over the pixel")
      ->check(CLI::IsMember({"point", "box"}))
      ->capture_default_str();
  CLI::Option* vpls = command
                          .add_option("--vpls", options->virtual_lights,
                                      "gather these virtual lights (JSON of render --dump) instead of tracing paths")
                          ->type_name("FILE")
                          ->excludes(spp)
                          ->excludes(bounces);
  command
      .add_option("--visibility", options->visibility,
                  "of --vpls. exact: a shadow ray to every light; none: as if nothing stood in between")
      ->check(CLI::IsMember({"exact", "none"}))
      ->needs(vpls)
      ->capture_default_str();
  command.add_option("--threads", options->tracer.threads, "CPU threads, 0 for all; the picture does not depend on it")
      ->check(CLI::Range(0, 4096))
      ->capture_default_str();
  command.add_flag("--quiet", options->quiet, "no progress bar, no warnings");
  command.footer(kFooter);
  command.callback([options, &exit_code] {
    render(*options);
    exit_code = static_cast<int>(ExitCode::done);
  });
}

}  // namespace volgi::app
