#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <exception>
#include <memory>
#include <optional>

#include "apps/volgi/area_video.h"
#include "apps/volgi/automatic.h"
#include "apps/volgi/commands.h"
#include "apps/volgi/device_options.h"
#include "apps/volgi/frame_options.h"
#include "apps/volgi/frame_stats.h"
#include "apps/volgi/frame_times.h"
#include "apps/volgi/parse_number.h"
#include "apps/volgi/program_ranks.h"
#include "apps/volgi/scene_options.h"
#include "apps/volgi/shared_frames.h"
#include "core/atomic_file.h"
#include "core/error.h"
#include "core/exposure.h"
#include "core/gl/context.h"
#include "core/image.h"
#include "core/log.h"
#include "core/progress.h"
#include "core/scene_source.h"
#include "core/virtual_light_list.h"
#include "core/visibility/openness.h"
#include "propagation/light_in/volume_service.h"
#include "screen/base/image_from_texture.h"
#include "screen/frame/frame.h"
#include "screen/frame/registry.h"

namespace volgi::app {

namespace {

struct RenderCommand {
  SceneOptions scene;
  FrameCommandOptions frame;
  std::filesystem::path out = "out.png";
  std::filesystem::path stats;
  std::filesystem::path dump;
  std::string exposure = "auto";
  bool half = false;
  bool quiet = false;
  int frames = 1;
  std::optional<int> samples;  // none: 1, or 8 without jitter where something is half transparent
  std::string animate;         // T0:T1:FPS; empty: one picture
  AreaVideo video;
  bool whole_animation = false;
  std::filesystem::path share;  // folder of who does which frame; empty: one process does them all
  DeviceOptions device;

  int run();

 private:
  std::optional<float> exposure_ev_;  // as asked for, or of the first picture for all of them
  std::optional<SharedFrames> shared_;
  int samples_by_quality_ = 1;

  std::filesystem::path lights_file() const { return dump / "virtual_lights.json"; }
  void check_outputs() const;
  void join_ranks(screen::FrameOptions& options) const;
  TimedFrames render_still(screen::Frame& picture, const Scene& loaded, gl::PassTimer& timer, bool software,
                           Image& image);
  TimedFrames climb(std::optional<screen::Frame>& picture, screen::FrameOptions& options, const Scene& loaded,
                    gl::PassTimer& timer, bool software, screen::Climb& climb, FrameCommandOptions::Fitted& fitted);
  TimedFrames render_animation(std::optional<screen::Frame>& picture, const screen::FrameOptions& options,
                               const SceneSource& source, Scene& moving, const FrameTimes& times, const WorldBox& box,
                               gl::PassTimer& timer, bool software);
  void share_frames(int count, const std::function<void(int)>& frame);
  bool writes_png() const { return out.extension() == ".png"; }
  void light(Scene& loaded, const Camera& camera) const;
  void read_exposure();
  void choose_exposure(const Image& image, const std::filesystem::path& path);
  screen::Quality quality() const { return screen::quality_from_name(frame.quality); }
  FrameCommandOptions::Fitted fit(const Scene& loaded, int rung, screen::FrameOptions& options);
  void say(const FrameCommandOptions::Fitted& fitted) const;
  int sample_count(const Scene& loaded) const;
  bool jitters() const { return samples.has_value() || samples_by_quality_ > 1; }
  Image all_samples(screen::Frame& picture, const Scene& loaded, const Camera& camera, bool software) const;
  void write_picture(const Image& image, const std::filesystem::path& path);
  nlohmann::json numbers(const screen::Frame& picture, const screen::FrameOptions& options, const Scene& loaded,
                         const gl::Context& context, gl::PassTimer& timer, const TimedFrames& timed) const;
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

/// Around everything at all times.
WorldBox box_of(const SceneSource& source, const FrameTimes& times) {
  WorldBox box;
  for (int k = 0; k < (source.animated() ? times.count : 1); ++k) box.add(source.bounds(times.at(k)));
  return box;
}

/// Finds out now what would fail after minutes of work.
void RenderCommand::check_outputs() const {
  if (out.extension() != ".exr" && out.extension() != ".png") {
    throw Error(ExitCode::usage, out.string() + ": -o needs a name that ends in .exr or .png");
  }
  check_writable(animate.empty() ? out : frame_path(out, 0));
  if (!stats.empty()) check_writable(stats);
  if (dump.empty()) return;
  make_folder(dump);
  check_writable(lights_file());
}

void RenderCommand::read_exposure() {
  if (exposure == "auto") return;
  exposure_ev_ = parse_number<float>(exposure);
  if (!exposure_ev_) throw Error(ExitCode::usage, "--exposure " + exposure + ": takes stops, such as -1.5, or auto");
}

/// What --exposure auto chooses is said, and kept for later pictures of an animation.
void RenderCommand::choose_exposure(const Image& image, const std::filesystem::path& path) {
  if (exposure_ev_) return;
  exposure_ev_ = automatic_exposure_ev(image);
  if (!quiet) fmt::print("{}: --exposure {:g} (auto)\n", path.string(), double(*exposure_ev_));
}

/// A PNG that hardly shows anything says what to try.
void warn_of_exposure(const Image& image, float exposure_ev, const std::filesystem::path& path) {
  const float scale = std::exp2(exposure_ev);
  size_t white = 0, black = 0;
  for (const glm::vec3& p : image.pixels) {
    const glm::vec3 shown = tone_map(p * scale);
    white += std::min({shown.x, shown.y, shown.z}) > 0.95f;
    black += std::max({shown.x, shown.y, shown.z}) < 0.002f;
  }
  const double pixels = std::max<double>(1.0, double(image.pixels.size()));
  for (const auto& [count, name] : {std::pair(white, "white"), std::pair(black, "black")}) {
    if (double(count) <= 0.9 * pixels) continue;
    const float other = automatic_exposure_ev(image);
    const std::string hint = std::abs(other - exposure_ev) > 1.0f ? fmt::format("; try --exposure {:g}", double(other))
                                                                  : std::string("; is the camera where the light is?");
    warn_once(
        fmt::format("{}: {:.0f} % of the picture is {}{}", path.string(), 100.0 * double(count) / pixels, name, hint));
  }
}

int RenderCommand::sample_count(const Scene& loaded) const {
  constexpr int OF_BLEND = 8;
  const auto blends = [](const Material& m) { return m.passes_by_chance(); };
  const bool any = std::any_of(loaded.materials.begin(), loaded.materials.end(), blends);
  return samples.value_or(std::max(any ? OF_BLEND : 1, samples_by_quality_));
}

/// The mean of the picture that there is, sample 0, and of the others, which are not timed.
Image RenderCommand::all_samples(screen::Frame& picture, const Scene& loaded, const Camera& camera,
                                 bool software) const {
  Image image = screen::image_from_texture(picture.radiance());
  const int count = sample_count(loaded);
  gl::PassTimer untimed(software, false);
  for (int k = 1; k < count; ++k) {
    picture.set_sample(k, jitters());
    picture.render(camera, untimed);
    const Image other = screen::image_from_texture(picture.radiance());
    for (size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] += other.pixels[i];
  }
  picture.set_sample(0, jitters());
  for (glm::vec3& p : image.pixels) p /= float(count);
  return image;
}

void RenderCommand::write_picture(const Image& image, const std::filesystem::path& path) {
  warn_of_bad_pixels(image);
  if (!writes_png()) {
    write_exr(path, image, half);
    return;
  }
  choose_exposure(image, path);
  warn_of_exposure(image, *exposure_ev_, path);
  write_png(path, image, *exposure_ev_);
}

/// What the command line adds, and for pictures to look at a lamp where there is no light at all.
void RenderCommand::light(Scene& loaded, const Camera& camera) const {
  scene.light.apply(loaded);
  if (writes_png()) scene.add_default_lamp(loaded, camera);
}

/// What the quality asks of the scene. The grid of what moves is around all of it.
FrameCommandOptions::Fitted RenderCommand::fit(const Scene& loaded, int rung, screen::FrameOptions& options) {
  const bool stands = animate.empty() && !whole_animation;
  const auto eye = stands ? std::optional(glm::vec3(scene.camera(loaded).world_from_camera[3])) : std::nullopt;
  FrameCommandOptions::Fitted fitted = frame.fit(loaded, eye, rung, options);
  samples_by_quality_ = fitted.needs.samples;
  return fitted;
}

void RenderCommand::say(const FrameCommandOptions::Fitted& fitted) const {
  if (quiet) return;
  std::string text;
  for (const screen::Chosen& c : fitted.chosen) text += fmt::format(", {} {}", c.name, c.value);
  if (fitted.needs.samples > 1 && !samples) text += fmt::format(", {} samples", fitted.needs.samples);
  fmt::print("quality {}{}\n", frame.quality, text.empty() ? "" : ": " + text.substr(2));
}

/// From rung to rung until two answers agree; the last one's frame is left in `picture`.
TimedFrames RenderCommand::climb(std::optional<screen::Frame>& picture, screen::FrameOptions& options,
                                 const Scene& loaded, gl::PassTimer& timer, bool software, screen::Climb& climb,
                                 FrameCommandOptions::Fitted& fitted) {
  TimedFrames timed;
  Image answer;
  for (bool on = true; on;) {
    if (climb.rung() > 0) {
      picture.reset();  // first, so that there are never two
      fitted = fit(loaded, climb.rung(), options);
      picture.emplace(loaded, options);
      timer.reset();
    }
    say(fitted);
    timed = render_still(*picture, loaded, timer, software, answer);
    on = climb.next(answer);
    if (!quiet && !climb.changes_percent().empty())
      fmt::print("rung {}: {:.2f} % of the picture's mean has changed\n", climb.rung() - 1,
                 climb.changes_percent().back());
  }
  if (!climb.agrees())
    warn_once(fmt::format("{}: the last two answers differ by {:.2f} %, more than {:g}", loaded.name,
                          climb.changes_percent().back(), screen::Climb::ENOUGH_PERCENT));
  write_picture(answer, out);
  return timed;
}

/// Renders the same picture `frames` times, to time it.
TimedFrames RenderCommand::render_still(screen::Frame& picture, const Scene& loaded, gl::PassTimer& timer,
                                        bool software, Image& image) {
  const Camera camera = scene.camera(loaded);
  // Two warm-up frames where times of several are wanted. One picture is not rendered twice for its times: they are a
  // cold frame's, and said to be.
  const int warm_up = frames > 1 ? 2 : 0;
  TimedFrames timed{frames, frames > 1, {}};
  for (int f = 0; f < warm_up + frames; ++f) {
    if (f == warm_up) timer.reset();
    timer.begin_frame();
    picture.render(camera, timer);
    timer.end_frame();
    if (f == 0) timed.cold = cold_frame(timer);
  }
  image = all_samples(picture, loaded, camera, software);
  return timed;
}

/// All frames, with whoever shares them.
void RenderCommand::share_frames(int count, const std::function<void(int)>& make) {
  if (writes_png() && !exposure_ev_) {  // one for all of them: the first frame's, whoever makes it
    shared_->work(0, 1, [&](int k) {
      make(k);
      shared_->keep_exposure(exposure_ev_.value());
    });
    exposure_ev_ = shared_->exposure();
  }
  shared_->work(0, count, make);
}

/// Each picture is written, whole, before the next one begins.
TimedFrames RenderCommand::render_animation(std::optional<screen::Frame>& picture, const screen::FrameOptions& options,
                                            const SceneSource& source, Scene& moving, const FrameTimes& times,
                                            const WorldBox& box, gl::PassTimer& timer, bool software) {
  TimedFrames timed{0, false, {}};
  Progress progress("render", std::uint64_t(times.count));
  const auto frame_of = [&](int k) {
    if (timed.count == 1 && !timed.warm) timer.reset();  // the first one's times are those of a cold frame
    timer.begin_frame();
    {
      const auto scope = timer.scope("core/move_scene");
      source.move(moving, times.at(k), box);
      light(moving, scene.camera(moving));
    }
    if (video.show(moving, times.at(k))) {
      picture.emplace(moving, options);  // nothing that is kept follows images
    } else {
      picture->follow_scene(timer);
    }
    picture->render(scene.camera(moving), timer);
    timer.end_frame();
    const bool first = timed.count == 0;
    timed = first ? TimedFrames{1, false, cold_frame(timer)}
                  : TimedFrames{timed.warm ? timed.count + 1 : 1, true, timed.cold};
    write_picture(all_samples(*picture, moving, scene.camera(moving), software), frame_path(out, k));
    progress.advance();
  };
  if (!shared_) {
    for (int k = 0; k < times.count; ++k) frame_of(k);
  } else {
    share_frames(times.count, frame_of);
  }
  return timed;
}

nlohmann::json RenderCommand::numbers(const screen::Frame& picture, const screen::FrameOptions& options,
                                      const Scene& loaded, const gl::Context& context, gl::PassTimer& timer,
                                      const TimedFrames& timed) const {
  auto numbers = frame_stats(loaded.name, frame.technique(), scene.size(), context, timer, timed, picture.report());
  numbers["parameters"] = {{"light", frame.light},
                           {"scheme", frame.volume.scheme},
                           {"grid", options.of<VolumeOptions>().grid_cells},
                           {"set", frame.parameters}};
  for (const screen::Parameter* p : screen::parameters())
    numbers["parameters"][p->name] = screen::value_text(*p, options.settings);
  if (!animate.empty()) numbers["parameters"]["animate"] = animate;
  return numbers;
}

/// Volumes of several ranks: on the CPU, of scenes that stand still.
void RenderCommand::join_ranks(screen::FrameOptions& options) const {
  const Ranks* ranks = program_ranks();
  if (ranks == nullptr) return;
  if (!animate.empty()) throw Error(ExitCode::usage, "--animate is for one rank; processes share frames by --share");
  if (options.backend == screen::Backend::gpu)
    throw Error(ExitCode::usage, "--backend gpu is for one rank; several hold a volume on the CPU");
  options.backend = screen::Backend::cpu;
  options.of<VolumeOptions>().ranks = ranks;
}

/// Of the first of several ranks: the others serve it while this lives.
class LeadsRanks {
 public:
  LeadsRanks() : exceptions_(std::uncaught_exceptions()) {}
  /// Where something has failed, all are ended in another way.
  ~LeadsRanks() {
    if (program_ranks() != nullptr && std::uncaught_exceptions() == exceptions_) end_volume_service(*program_ranks());
  }
  LeadsRanks(const LeadsRanks&) = delete;
  LeadsRanks& operator=(const LeadsRanks&) = delete;

 private:
  int exceptions_;
};

int RenderCommand::run() {
  set_quiet(quiet || !is_first_rank());
  read_exposure();
  if (quality() == screen::Quality::truth && (!animate.empty() || frames > 1))
    throw Error(ExitCode::usage, "--quality truth climbs to one picture: neither --animate nor --frames go with it");
  frame.volume.limit_threads();
  screen::FrameOptions options = frame.frame_options(scene.size());
  join_ranks(options);
  const FrameTimes times = animate.empty() ? FrameTimes{scene.time_s} : parse_frame_times(animate);
  if (is_first_rank()) check_outputs();
  if (!share.empty()) shared_.emplace(share);
  const SceneSource source(scene.scene_path, scene.file.reading);
  const WorldBox box = whole_animation ? source.whole_bounds() : box_of(source, times);
  Scene loaded = animate.empty() && !whole_animation ? source.at(scene.time_s) : source.at(times.at(0), box);
  video.show(loaded, animate.empty() ? scene.time_s : times.at(0));
  const Camera camera = scene.camera(loaded);  // says so now if there is none
  light(loaded, camera);
  if (!is_first_rank()) {
    serve_volume(loaded, *program_ranks());
    return int(ExitCode::done);
  }
  const LeadsRanks leads;
  const gl::Context context(device.context);
  const bool explained = frame.explain;
  const std::optional<Automatic> automatic =
      choose_automatically(frame, loaded, camera, scene.size(), context.device_name());
  if (automatic) {
    frame = automatic->frame;
    options = frame.frame_options(scene.size());
  }
  FrameCommandOptions::Fitted fitted = fit(loaded, 0, options);
  if (!quiet) fmt::print("device: {} ({})\n", context.device_name(), context.version());
  if (automatic && !quiet) fmt::print("{}", automatic->summary());
  if (automatic && explained) fmt::print("{}", automatic->rejected());
  std::optional<screen::Frame> picture(std::in_place, loaded, options);
  warn_of_open_scene(loaded, glm::vec3(camera.world_from_camera[3]));
  for (const std::string& line : picture->announcements()) {
    if (!quiet) fmt::print("{}\n", line);
  }
  const bool timed = !quiet || !stats.empty();  // on a software rasterizer, timing makes passes wait for one another
  gl::PassTimer timer(context.software(), timed);
  TimedFrames timed_frames;
  screen::Climb steps;
  if (quality() == screen::Quality::truth) {
    timed_frames = climb(picture, options, loaded, timer, context.software(), steps, fitted);
  } else {
    say(fitted);
    Image image;
    timed_frames = animate.empty()
                       ? render_still(*picture, loaded, timer, context.software(), image)
                       : render_animation(picture, options, source, loaded, times, box, timer, context.software());
    if (animate.empty()) write_picture(image, out);
  }
  if (timed_frames.count == 0) {
    if (!quiet) fmt::print("all frames were made by others\n");
    return int(ExitCode::done);
  }
  auto figures = numbers(*picture, options, loaded, context, timer, timed_frames);
  figures["quality"] = quality_json(frame.quality, fitted, steps);
  if (automatic) figures["auto"] = automatic->json();
  if (!stats.empty()) write_text_atomically(stats, figures.dump(1) + '\n');
  if (!dump.empty()) write_virtual_lights(lights_file(), picture->virtual_lights());
  if (!quiet) {
    const int last = times.count - 1;
    fmt::print("{}wrote {}\n", pass_table(figures),
               animate.empty() ? out.string()
                               : fmt::format("{} ... {}", frame_path(out, 0).string(), frame_path(out, last).string()));
  }
  return int(ExitCode::done);
}

}  // namespace

void add_render_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<RenderCommand>();
  CLI::App* command = app.add_subcommand("render", "render a scene to EXR (linear) or PNG (tone mapped) pictures");
  options->scene.add_to(*command);
  command->add_option("-o,--output", options->out, "picture to write, .exr or .png")->capture_default_str();
  options->frame.add_to(*command);
  command
      ->add_option("--exposure", options->exposure,
                   "PNG only: stops (powers of two) before the tone map, or auto: middle grey for the geometric mean")
      ->type_name("EV|auto")
      ->capture_default_str();
  command
      ->add_option(
          "--samples", options->samples,
          "pictures that are averaged into one, each of other points of pixels and other virtual lights (1; where "
          "something is half transparent 8, all of pixel centres and the same lights)")
      ->check(CLI::Range(1, 4096));
  command->add_flag("--half", options->half, "EXR in 16-bit floats; refuses values above 65504");
  CLI::Option* animate =
      command
          ->add_option("--animate", options->animate,
                       "a picture for each frame from T0 to T1 [s], OUT.0000.png and so on; where -o has %04d, there")
          ->type_name("T0:T1:FPS")
          ->excludes(command->get_option("--time"));
  options->video.add_to(*command);
  command
      ->add_option(
          "--share", options->share,
          "shares the frames with every process that runs this command, here or on another machine that sees "
          "FOLDER: each frame is made by one, and by another where that one is killed; frames that FOLDER says "
          "are done are not made again")
      ->type_name("FOLDER")
      ->needs(animate);
  command->add_flag("--whole-animation", options->whole_animation,
                    "the volume's grid is around all that moves at any time, not only at those that are rendered");
  command
      ->add_option("--frames", options->frames,
                   "render the same picture this often for times; more than 1: after two warm-up frames")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str()
      ->excludes(animate);
  command->add_flag("--no-default-light", options->scene.no_default_light,
                    "no lamp beside the camera where a scene for a PNG has no light");
  options->device.add_to(*command);
  command->add_option("--stats", options->stats, "write times, grid and memory to this JSON file");
  command
      ->add_option("--dump", options->dump,
                   "folder for what the last frame was lit by: virtual_lights.json, for reference --vpls")
      ->excludes(command->get_option("--share"));
  command->add_flag("--quiet", options->quiet, "print nothing but errors");
  command->footer(
      "Example: volgi render data/cornell.glb -o out/cornell.png --light indirect --grid 32 --size 512x512\n"
      "         volgi render builtin:metaballs -o out/balls.png --gi hybrid --animate 0:8:25\n"
      "         (this twice or more, at the same time:) volgi render builtin:metaballs -o out/balls.png --animate "
      "0:8:25 "
      "--share out/balls.share");
  command->callback([options, &exit_code] { exit_code = options->run(); });
}

}  // namespace volgi::app
