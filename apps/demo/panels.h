#pragma once
#include <array>
#include <deque>
#include <string>

#include "apps/demo/keys.h"
#include "apps/demo/viewer.h"

namespace volgi::demo {

/// Widgets beside the picture, made from the registry, the commands and what a frame says of itself. Each does what a
/// command does; none knows more than a viewer. Needs ImGui's frame to be begun.
class Panels {
 public:
  explicit Panels(Viewer& viewer) : viewer_(viewer) {}

  /// Draws what is open. @param window  its size [pixels].
  void draw(glm::ivec2 window, float scale);
  /// How much of the window's width the panels take [pixels].
  int width(glm::ivec2 window, float scale) const;
  /// Panels "", "keyboard", "palette", "help", or one of the sections by its name.
  void toggle(const std::string& name);
  /// The palette is open, but has not got the keyboard yet, which takes ImGui two frames.
  bool palette_waits() const { return palette_ && !palette_entered_ && !wants_text(); }
  /// Gives it what was typed meanwhile.
  void type_ahead(const KeyPress& press);
  /// The keyboard goes to a text field.
  bool wants_text() const;
  /// For the plot.
  void add_frame_time(double ms);
  bool shown() const { return shown_; }
  void show(bool on) { shown_ = on; }

 private:
  void draw_sections();
  void section(const char* name, void (Panels::*draw_it)());
  void draw_scene();
  void draw_technique();
  void draw_view();
  void draw_camera();
  void draw_light();
  void draw_truth();
  void draw_times();
  void draw_picture();
  void draw_messages(glm::ivec2 window);
  void draw_loading(glm::ivec2 window);
  void draw_palette(glm::ivec2 window);
  void draw_help(glm::ivec2 window);
  void draw_stage(const screen::StageType& stage);
  void draw_parameter(const screen::Parameter& parameter);
  void draw_volume();
  void run(const std::string& command);

  Viewer& viewer_;
  bool shown_ = true, palette_ = false, help_ = false;
  bool take_keyboard_ = false, palette_opened_ = false, palette_entered_ = false;
  std::string open_section_;  // to be unfolded, once
  std::array<char, 256> palette_text_{}, path_text_{}, sky_text_{}, bookmark_text_{};
  int palette_choice_ = 0;
  std::deque<float> frame_ms_;
  screen::FrameReport figures_;  // when they were asked for: that waits for the GPU
};

}  // namespace volgi::demo
