#pragma once
#include <chrono>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/demo/document.h"
#include "apps/demo/motion.h"
#include "apps/demo/picture.h"
#include "apps/demo/scene_loader.h"
#include "apps/demo/settings.h"
#include "apps/demo/undo.h"
#include "apps/demo/view.h"
#include "core/error.h"
#include "core/gl/context.h"
#include "screen/frame/frame.h"

namespace volgi::demo {

/// What a person is told, and for how long.
struct Message {
  std::string text;
  bool error = false;
  std::chrono::steady_clock::time_point when;
};

/// A scene that is looked at: what is open, how it is rendered, from where, and what of it is shown. Knows neither
/// window nor widgets; a window, a benchmark and a test all drive this. Needs a current gl::Context, on one thread.
class Session {
 public:
  Session(const gl::Context& context, Settings settings, app::LightOptions light, SceneReading reading = {});

  // --- What is open.
  /// Begins to read; the old scene stays until the new one is there, and for good where it cannot be read.
  void open(std::vector<std::filesystem::path> files, double time_s = 0.0);
  /// Beside what is there.
  void append(const std::filesystem::path& file);
  const SceneLoader& loader() const { return loader_; }
  /// Until what is being read is there. @throws Error where it cannot be read.
  void wait_for_scene();
  bool has_scene() const { return document_ != nullptr; }
  Document& document() { return *document_; }
  const Document& document() const { return *document_; }

  // --- How it is rendered.
  const Settings& settings() const { return settings_; }
  /// Other settings, as one step that can be undone. What does not go together is refused as a message, and nothing
  /// changes. @param what  for the list of steps: "vpl.count"; steps of the same name in a row are one.
  /// @returns whether it was taken.
  bool change(const std::string& what, const Settings& settings);
  void undo();
  void redo();
  const UndoList<Settings>& undo_list() const { return undo_; }
  /// Options as a frame of this size has them.
  screen::FrameOptions frame_options(glm::ivec2 size) const;
  /// Options of techniques as the recipe has them.
  screen::TypeMap recipe_settings() const;
  /// Reads shaders anew (gl::set_shader_folder); a mistake in them is a message, and the last frame stays.
  void reload_shaders();

  // --- From where.
  const Camera& camera() const { return camera_; }
  void set_camera(const Camera& camera);
  /// One of the file's, which pictures' commands then name. @throws Error(usage) when there is no such one.
  void take_file_camera(size_t index);
  std::optional<size_t> file_camera() const { return file_camera_; }
  /// As `volgi render` takes it (camera_arguments.h).
  const std::string& camera_arguments() const { return camera_arguments_; }

  // --- Light and time.
  /// Something of document()'s light has been changed. @param kinds  which sources there are, what they emit: the frame
  /// is made anew. Else lights have only moved.
  void light_changed(bool kinds);
  bool playing() const { return playing_; }
  void play(bool on) { playing_ = on && has_scene() && document_->animated(); }
  void set_time(double time_s);

  // --- What of it is shown.
  View view() const { return view_of(settings_.view); }
  ViewDetails& details() { return details_; }

  // --- Each frame.
  /// Takes what has been read, and lets time pass.
  void step(double seconds);
  /// Renders what has changed since the last call, or one picture more of an average, or nothing.
  void draw(glm::ivec2 size);
  /// Whether the next draw() would find nothing to do.
  bool settled() const;
  /// Why draw() shows what it showed before, or nothing: it is not tried again until something changes.
  const std::optional<Error>& failure() const { return failure_; }
  bool has_picture() const { return canvas().frame && canvas().picture && canvas().picture->samples() > 0; }
  /// What is shown. While something moves it may be smaller than size(), and of fewer lights (motion.h).
  const Picture& picture() const { return *canvas().picture; }
  Picture& picture() { return *canvas().picture; }
  const screen::Frame& frame() const { return *canvas().frame; }
  /// Shown now is what moves, not yet the picture that the settings ask for.
  bool moving() const { return quick_shown_; }
  /// 0: as the settings have it.
  int motion_level() const { return quick_shown_ ? quick_level_ : 0; }
  /// Its latest times are those of the picture that was rendered last, with all that was drawn for it.
  gl::PassTimer& timer() { return *timer_; }
  /// For what is drawn when nothing has been rendered, or over the picture.
  gl::PassTimer& untimed() { return *untimed_; }
  /// Times of single passes, which on a software rasterizer wait for one another.
  void time_passes(bool on);
  float exposure_ev() const { return canvas().picture ? picture().exposure_ev(settings_.exposure_ev) : 0.0f; }
  /// That draw() was last called for.
  glm::ivec2 size() const { return asked_size_; }
  /// Frames that were rendered so far.
  std::uint64_t frames() const { return frames_; }
  /// Grows whenever document().scene() is another one, or has changed.
  std::uint64_t scene_version() const { return scene_version_; }
  /// Grows whenever the picture that is being averaged is another one.
  std::uint64_t picture_version() const { return picture_version_; }
  /// In the scene's centred frame; none in the background. Waits for the GPU: between frames.
  std::optional<glm::vec3> world_under(glm::vec2 pixel) const;

  // --- What there is to say.
  void say(std::string text, bool error = false);
  /// The latest last; old ones are forgotten.
  const std::vector<Message>& messages() const { return messages_; }
  /// Messages so far, those that are forgotten too.
  size_t said() const { return said_; }

 private:
  void take(SceneLoader::Result result);
  /// Pictures of one size, and what makes them.
  struct Canvas {
    std::unique_ptr<screen::Frame> frame;
    std::unique_ptr<Picture> picture;
    glm::ivec2 size{0};
    bool wanted = true;           // the frame, anew
    bool picture_wanted = false;  // likewise
    bool moved = false;           // the scene, since the frame last followed
    bool other_images = false;    // than the frame was made for
  };
  const Canvas& canvas() const { return quick_shown_ ? quick_ : full_; }
  Canvas& canvas() { return quick_shown_ ? quick_ : full_; }
  void choose_canvas();
  void want_frames();
  std::optional<Canvas> make_frame(glm::ivec2 size);
  void warn_of_view();
  void render();
  void restart();
  void scene_has_changed();

  bool software_;
  Settings settings_, good_settings_;  // the last that made a frame
  app::LightOptions light_;
  SceneReading reading_;
  UndoList<Settings> undo_;
  SceneLoader loader_;
  std::unique_ptr<Document> document_;
  Camera camera_;
  std::optional<size_t> file_camera_;
  std::string camera_arguments_;
  bool playing_ = false;
  bool restart_ = true;  // of the average
  glm::ivec2 asked_size_{0};
  std::optional<Error> failure_;
  std::unique_ptr<gl::PassTimer> timer_, untimed_;
  std::shared_ptr<gl::SceneBuffers> triangles_;
  Canvas full_, quick_;
  bool quick_shown_ = false;
  int quick_level_ = 0;  // that quick_ is made for
  MotionPace pace_;
  MotionPace::Clock::time_point shown_at_{};
  ViewDetails details_;
  std::string warned_view_;  // what is missing in it
  std::uint64_t frames_ = 0, scene_version_ = 0, picture_version_ = 0;
  std::vector<Message> messages_;
  size_t said_ = 0;
};

}  // namespace volgi::demo
