#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <memory>

#include "apps/volgi/commands.h"
#include "apps/volgi/frame_options.h"
#include "apps/volgi/frame_stats.h"
#include "apps/volgi/scene_options.h"
#include "core/atomic_file.h"
#include "core/error.h"
#include "core/gl/context.h"
#include "core/image.h"
#include "core/log.h"
#include "core/virtual_light_list.h"
#include "screen/image_from_texture.h"

namespace volgi::app {

namespace {

struct RenderCommand {
  SceneOptions scene;
  FrameCommandOptions frame;
  std::filesystem::path out = "out.png";
  std::filesystem::path stats;
  std::filesystem::path dump;
  float exposure_ev = 0.0f;
  bool half = false;
  bool quiet = false;
  int frames = 1;
  std::optional<int> device;

  int run() const;
  void write_picture(const Image& picture) const;
};

void warn_of_bad_pixels(const Image& picture) {
  for (const glm::vec3& p : picture.pixels) {
    if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) {
      warn_once("the picture has pixels that are not finite: please report the scene and the command");
      return;
    }
  }
}

void make_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw Error(ExitCode::cannot_write, folder.string() + ": cannot make this folder: " + error.message());
}

void RenderCommand::write_picture(const Image& picture) const {
  if (out.extension() == ".exr") {
    write_exr(out, picture, half);
  } else {
    write_png(out, picture, exposure_ev);
  }
}

int RenderCommand::run() const {
  set_quiet(quiet);
  frame.volume.limit_threads();
  glm::ivec2 size = scene.size();
  screen::FrameOptions options = frame.frame_options(size);
  if (out.extension() != ".exr" && out.extension() != ".png") {
    throw Error(ExitCode::usage, out.string() + ": -o needs a name that ends in .exr or .png");
  }
  check_writable(out);
  if (!stats.empty()) check_writable(stats);
  const std::filesystem::path lights_file = dump / "virtual_lights.json";
  if (!dump.empty()) {
    make_folder(dump);
    check_writable(lights_file);
  }
  Scene loaded = load_scene(scene.scene_path, scene.time_s);
  Camera camera = scene.camera(loaded);
  gl::Context context(device);
  if (!quiet) fmt::print("device: {} ({})\n", context.device_name(), context.version());

  if (!quiet && options.gi == screen::GiMode::volume && loaded.triangle_count() > 0) {
    const bool on_gpu = screen::runs_on_gpu(options.backend);
    fmt::print("volume: on the {}, about {:.1f} MiB\n", on_gpu ? "GPU" : "CPU",
               double(screen::volume_bytes_expected(loaded, options.volume, on_gpu)) / 1048576.0);
  }
  screen::Frame picture(loaded, options);
  const bool timed = !quiet || !stats.empty();  // on a software rasterizer, timing makes passes wait for one another
  gl::PassTimer timer(context.software(), timed);
  // Two warm-up frames where times of several are wanted; one frame is shown with what it took from cold.
  const int warm_up = frames > 1 ? 2 : 0;
  for (int f = 0; f < warm_up + frames; ++f) {
    if (f == warm_up) timer.reset();
    timer.begin_frame();
    picture.render(camera, timer);
    timer.end_frame();
  }
  Image image = screen::image_from_texture(picture.radiance());
  warn_of_bad_pixels(image);
  write_picture(image);
  auto numbers = frame_stats(loaded.name, frame.gi, size, context, timer, frames, picture.report());
  numbers["parameters"] = {{"light", frame.light},
                           {"scheme", frame.volume.scheme},
                           {"grid", frame.volume.grid_cells},
                           {"vpls", frame.vpls},
                           {"set", frame.parameters}};
  if (!stats.empty()) {
    write_atomically(stats, [&](const std::filesystem::path& p) { std::ofstream(p) << numbers.dump(1) << '\n'; });
  }
  if (!dump.empty()) write_virtual_lights(lights_file, picture.virtual_lights());
  if (!quiet) fmt::print("{}wrote {}\n", pass_table(numbers), out.string());
  return int(ExitCode::done);
}

}  // namespace

void add_render_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<RenderCommand>();
  CLI::App* command =
      app.add_subcommand("render", "render a glTF scene to an EXR (linear) or PNG (tone mapped) picture");
  options->scene.add_to(*command);
  command->add_option("-o,--output", options->out, "picture to write, .exr or .png")->capture_default_str();
  options->frame.add_to(*command);
  command->add_option("--exposure", options->exposure_ev, "PNG only: stops (powers of two) before the tone map")
      ->capture_default_str();
  command->add_flag("--half", options->half, "EXR in 16-bit floats; refuses values above 65504");
  command
      ->add_option("--frames", options->frames,
                   "render the same picture this often (after two warm-up frames) for times")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  command->add_option("--device", options->device,
                      "number of the EGL device (the first hardware device, else software)");
  command->add_option("--stats", options->stats, "write times, grid and memory to this JSON file");
  command->add_option("--dump", options->dump,
                      "folder for what the last frame was lit by: virtual_lights.json, for reference --vpls");
  command->add_flag("--quiet", options->quiet, "print nothing but errors");
  command->footer(
      "Example: volgi render data/cornell.glb -o out/cornell.png --light indirect --grid 32 --size 512x512");
  command->callback([options, &exit_code] { exit_code = options->run(); });
}

}  // namespace volgi::app
