#include "apps/demo/run_headless.h"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <iostream>
#include <nlohmann/json.hpp>

#include "apps/demo/commands.h"
#include "apps/demo/film.h"
#include "apps/demo/render_command.h"
#include "apps/demo/viewer.h"
#include "core/atomic_file.h"
#include "core/error.h"
#include "core/gl/shader_source.h"
#include "volgi_version.h"

namespace volgi::demo {

namespace {

using Clock = std::chrono::steady_clock;

std::vector<unsigned char> display_bytes(const Picture& picture) {
  std::vector<unsigned char> bytes(size_t(picture.size().x) * size_t(picture.size().y) * 4);
  glGetTextureImage(picture.display().id(), 0, GL_RGBA, GL_UNSIGNED_BYTE, GLsizei(bytes.size()), bytes.data());
  return bytes;
}

/// What was said and has not been printed yet. An error ends the program: nobody is there to mend it.
void print_messages(const Session& session, size_t& printed) {
  if (session.failure()) throw Error(*session.failure());
  const auto& messages = session.messages();
  for (size_t k = messages.size() - std::min(messages.size(), session.said() - printed); k < messages.size(); ++k) {
    if (messages[k].error) throw Error(ExitCode::usage, messages[k].text);
    std::cerr << "volgi-demo: " << messages[k].text << '\n';
  }
  printed = session.said();
}

/// The same viewer as a window's, at fixed steps of time.
class Headless {
 public:
  explicit Headless(const DemoOptions& options);
  int run();

 private:
  void draw();
  void run_commands();
  void picture();
  void along_path();
  void benchmark();
  CameraPath path() const;

  const DemoOptions& options_;
  glm::ivec2 size_;
  gl::Context context_;
  std::vector<std::string> unknown_;
  Viewer viewer_;
  size_t printed_ = 0;
};

Settings settings_of(const DemoOptions& options, std::vector<std::string>& unknown) {
  Settings settings = options.settings(unknown);
  settings.progressive = options.samples > 1;
  settings.most_samples = options.samples;
  settings.post_filter = false;
  settings.motion_fps = 0.0;
  return settings;
}

Headless::Headless(const DemoOptions& options)
    : options_(options),
      size_(options.picture_size()),
      context_(options.device.context),
      viewer_(context_, options.with_choice(settings_of(options, unknown_), context_.device_name()), {}, options.light,
              options.reading.reading) {
  gl::set_shader_folder(options.shaders);
  viewer_.picture_folder = options.pictures;
  viewer_.session.open(options.scenes, options.time_s);
  viewer_.session.wait_for_scene();
}

/// All samples of a picture.
void Headless::draw() {
  do {
    viewer_.draw(size_);
    print_messages(viewer_.session, printed_);
  } while (!viewer_.session.settled());
}

/// Each sees the picture that those before have made.
void Headless::run_commands() {
  viewer_.session.picture().settle_exposure();
  for (const std::string& line : options_.commands) {
    execute(viewer_, line);
    draw();
    viewer_.session.picture().settle_exposure();
  }
}

void Headless::picture() {
  const bool png = options_.out.extension() == ".png";
  if (!png && options_.out.extension() != ".exr")
    throw Error(ExitCode::usage, "--headless: -o needs a name that ends in .png or .exr");
  check_writable(options_.out);
  draw();
  run_commands();
  viewer_.draw(size_);  // as bright as that
  if (!png) {
    write_exr(options_.out, viewer_.session.picture().image());
  } else {
    const std::vector<unsigned char> bytes = display_bytes(viewer_.session.picture());
    Image display(size_.x, size_.y);
    for (size_t k = 0; k < display.pixels.size(); ++k) {
      const size_t row = k / size_t(size_.x),
                   from = ((size_t(size_.y) - 1 - row) * size_t(size_.x) + k % size_t(size_.x)) * 4;
      display.pixels[k] = glm::vec3(bytes[from], bytes[from + 1], bytes[from + 2]) / 255.0f;
    }
    write_png_display(options_.out, display);
  }
  fmt::print("wrote {} ({})\n", options_.out.string(), info(viewer_.session.view()).title);
}

CameraPath Headless::path() const {
  CameraPath read = read_camera_path(options_.path.empty() ? options_.benchmark : options_.path);
  return read;
}

void Headless::along_path() {
  const CameraPath keys = path();
  const double duration = keys.last_time_s() - keys.first_time_s();
  const int frames = options_.frames > 0 ? options_.frames : int(std::floor(duration * options_.fps + 1e-9)) + 1;
  PictureSequence sequence(options_.out, size_, options_.fps);
  for (int k = 0; k < frames; ++k) {
    const CameraKey key = keys.at(keys.first_time_s() + k / options_.fps);
    viewer_.session.set_time(key.scene_time_s);
    viewer_.session.set_camera(camera_of(key.pose, viewer_.session.document().scene()));
    draw();
    if (k == 0) {
      run_commands();
    } else {
      viewer_.session.picture().adapt(1.0 / options_.fps, true);
    }
    viewer_.draw(size_);
    const bool linear = options_.out.extension() == ".exr";
    sequence.add(display_bytes(viewer_.session.picture()), linear ? viewer_.session.picture().image() : Image());
  }
  sequence.finish();
  fmt::print("wrote {}: {} frames\n", options_.out.string(), frames);
}

/// The path from end to end in so many frames, whatever they take.
void Headless::benchmark() {
  const CameraPath keys = path();
  const int frames = options_.frames > 0 ? options_.frames : viewer_.session.settings().benchmark.frames;
  const int warm_up = std::min(viewer_.session.settings().benchmark.warm_up_frames, 3);
  const std::filesystem::path folder = options_.out.empty() ? "benchmark" : options_.out;
  std::filesystem::create_directories(folder);
  PictureSequence sequence(folder / "frame.%04d.png", size_, options_.fps);
  viewer_.time_passes(true);
  for (int k = -warm_up; k < frames; ++k) {
    const double share = frames > 1 ? double(std::max(k, 0)) / (frames - 1) : 0.0;
    const CameraKey key = keys.at(keys.first_time_s() + share * (keys.last_time_s() - keys.first_time_s()));
    viewer_.session.set_time(key.scene_time_s);
    viewer_.session.set_camera(camera_of(key.pose, viewer_.session.document().scene()));
    const auto start = Clock::now();
    draw();
    glFinish();
    const double ms = std::chrono::duration<double, std::milli>(Clock::now() - start).count();
    if (k < 0) {
      viewer_.session.picture().settle_exposure();
      continue;
    }
    viewer_.times.add(ms, viewer_.session.timer().latest());
    sequence.add(display_bytes(viewer_.session.picture()), Image());
  }
  viewer_.times.write_csv(folder / "times.csv");
  write_settings(folder / "settings.json", viewer_.session.settings());
  const nlohmann::json summary = {
      {"program", VOLGI_VERSION},
      {"device", context_.device_name()},
      {"scene", viewer_.session.document().title()},
      {"path", options_.benchmark.string()},
      {"size", {size_.x, size_.y}},
      {"frames", frames},
      {"median_ms", viewer_.times.median_ms()},
      {"arguments", frame_arguments(viewer_.session.settings().frame, viewer_.session.settings().grid_fits_scene)}};
  write_text_atomically(folder / "benchmark.json", summary.dump(1) + '\n');
  fmt::print("{}: {} frames, median {:.1f} ms; wrote {}\n", context_.device_name(), frames, viewer_.times.median_ms(),
             folder.string());
}

int Headless::run() {
  for (const std::string& line : unknown_) std::cerr << "volgi-demo: " << line << '\n';
  if (!options_.benchmark.empty()) {
    benchmark();
  } else if (options_.out.empty()) {
    throw Error(ExitCode::usage, "--headless: where to? -o FILE");
  } else if (!options_.path.empty()) {
    along_path();
  } else {
    picture();
  }
  gl::throw_on_error();
  return int(ExitCode::done);
}

}  // namespace

int run_headless(const DemoOptions& options) { return Headless(options).run(); }

}  // namespace volgi::demo
