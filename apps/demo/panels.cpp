#include "apps/demo/panels.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cstring>

#include "apps/demo/commands.h"
#include "apps/demo/keys.h"
#include "core/error.h"

namespace volgi::demo {

namespace {

constexpr float PANEL_WIDTH = 360.0f;  // in text's pixels

/// A text that gets the keyboard is selected: the next letter would take the place of those typed ahead.
int caret_to_end(ImGuiInputTextCallbackData* data) {
  data->CursorPos = data->SelectionStart = data->SelectionEnd = data->BufTextLen;
  return 0;
}
int leave_caret(ImGuiInputTextCallbackData* /*data*/) { return 0; }

const ImVec4 WARNING_COLOUR{1.0f, 0.62f, 0.35f, 1.0f};

}  // namespace

void Panels::run(const std::string& command) {
  try {
    execute(viewer_, command);
  } catch (const Error& error) {
    viewer_.session.say(error.what(), true);
  }
}

int Panels::width(glm::ivec2 window, float scale) const {
  return shown_ ? std::min(int(PANEL_WIDTH * scale), window.x / 2) : 0;
}

void Panels::toggle(const std::string& name) {
  if (name.empty()) {
    shown_ = !shown_;
  } else if (name == "keyboard") {
    shown_ = true;
    take_keyboard_ = true;
  } else if (name == "palette") {
    palette_ = !palette_;
    palette_opened_ = palette_;
    palette_entered_ = false;
    palette_text_.fill('\0');
    palette_choice_ = 0;
  } else if (name == "help") {
    help_ = !help_;
  } else {
    shown_ = true;
    open_section_ = name;
  }
}

void Panels::type_ahead(const KeyPress& press) {
  ImGui::GetIO().ClearInputCharacters();  // it is the same text
  std::string line = palette_text_.data();
  if (press.key.key == GLFW_KEY_ENTER || press.key.key == GLFW_KEY_KP_ENTER) palette_entered_ = true;
  if (press.key.key == GLFW_KEY_ESCAPE) palette_ = false;
  if (press.key.key == GLFW_KEY_BACKSPACE && !line.empty()) line.pop_back();
  if (!palette_entered_ && !press.key.control) line += press.text;
  line.resize(std::min(line.size(), palette_text_.size() - 1));
  palette_text_.fill('\0');
  std::copy(line.begin(), line.end(), palette_text_.begin());
}

bool Panels::wants_text() const { return ImGui::GetIO().WantTextInput; }

void Panels::add_frame_time(double ms) {
  constexpr size_t KEPT = 240;
  frame_ms_.push_back(float(ms));
  if (frame_ms_.size() > KEPT) frame_ms_.pop_front();
}

void Panels::draw(glm::ivec2 window, float scale) {
  if (shown_) {
    const float wide = float(width(window, scale));
    ImGui::SetNextWindowPos({float(window.x) - wide, 0.0f});
    ImGui::SetNextWindowSize({wide, float(window.y)});
    if (take_keyboard_) ImGui::SetNextWindowFocus();
    constexpr ImGuiWindowFlags FIXED =
        ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoTitleBar;
    if (ImGui::Begin("volgi", nullptr, FIXED)) {
      if (take_keyboard_) ImGui::SetKeyboardFocusHere();
      draw_sections();
    }
    ImGui::End();
    take_keyboard_ = false;
  }
  draw_loading(window);
  draw_messages(window);
  if (palette_) draw_palette(window);
  if (help_) draw_help(window);
}

void Panels::section(const char* name, void (Panels::*draw_it)()) {
  Settings& settings = const_cast<Settings&>(viewer_.session.settings());
  bool& open =
      settings.panels.try_emplace(name, std::string(name) == "View" || std::string(name) == "Technique").first->second;
  if (open_section_ == name) open = true;
  ImGui::SetNextItemOpen(open);
  open = ImGui::CollapsingHeader(name);
  if (open && (viewer_.session.has_scene() || std::string(name) == "Scene")) (this->*draw_it)();
}

void Panels::draw_sections() {
  section("Scene", &Panels::draw_scene);
  section("View", &Panels::draw_view);
  section("Technique", &Panels::draw_technique);
  section("Light", &Panels::draw_light);
  section("Camera", &Panels::draw_camera);
  section("Picture", &Panels::draw_picture);
  section("Reference", &Panels::draw_truth);
  section("Times", &Panels::draw_times);
  open_section_.clear();
}

void Panels::draw_messages(glm::ivec2 window) {
  constexpr auto SHOWN_FOR = std::chrono::seconds(6);
  const auto now = std::chrono::steady_clock::now();
  ImGui::SetNextWindowPos({8.0f, float(window.y) - 8.0f}, ImGuiCond_Always, {0.0f, 1.0f});
  constexpr ImGuiWindowFlags QUIET = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_AlwaysAutoResize |
                                     ImGuiWindowFlags_NoInputs | ImGuiWindowFlags_NoFocusOnAppearing |
                                     ImGuiWindowFlags_NoNav | ImGuiWindowFlags_NoMove;
  const auto& messages = viewer_.session.messages();
  const auto recent = [&](const Message& m) { return now - m.when < SHOWN_FOR * (m.error ? 3 : 1); };
  if (std::none_of(messages.begin(), messages.end(), recent)) return;
  if (ImGui::Begin("messages", nullptr, QUIET)) {
    ImGui::PushTextWrapPos(std::max(float(window.x) * 0.6f, 200.0f));
    for (const Message& m : messages) {
      if (!recent(m)) continue;
      if (m.error) ImGui::PushStyleColor(ImGuiCol_Text, WARNING_COLOUR);
      ImGui::TextUnformatted(m.text.c_str());
      if (m.error) ImGui::PopStyleColor();
    }
    ImGui::PopTextWrapPos();
  }
  ImGui::End();
}

void Panels::draw_loading(glm::ivec2 window) {
  const SceneLoader& loader = viewer_.session.loader();
  const bool first_frame = viewer_.session.has_scene() && !viewer_.session.has_picture() && !viewer_.session.failure();
  if (!loader.busy() && !first_frame) return;
  ImGui::SetNextWindowPos({0.5f * float(window.x), 0.5f * float(window.y)}, ImGuiCond_Always, {0.5f, 0.5f});
  constexpr ImGuiWindowFlags QUIET = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_AlwaysAutoResize |
                                     ImGuiWindowFlags_NoInputs | ImGuiWindowFlags_NoFocusOnAppearing |
                                     ImGuiWindowFlags_NoNav;
  if (ImGui::Begin("loading", nullptr, QUIET)) {
    if (loader.busy()) {
      ImGui::Text("reading %s: %.1f s", loader.title().c_str(), loader.seconds());
    } else {
      ImGui::Text("%s: the first frame: shaders, maps and voxels", viewer_.session.document().title().c_str());
    }
  }
  ImGui::End();
}

void Panels::draw_palette(glm::ivec2 window) {
  const float wide = std::min(640.0f, 0.9f * float(window.x));
  ImGui::SetNextWindowPos({0.5f * float(window.x), 0.15f * float(window.y)}, ImGuiCond_Always, {0.5f, 0.0f});
  ImGui::SetNextWindowSize({wide, 0.0f});
  ImGui::SetNextWindowFocus();
  if (ImGui::Begin("command", nullptr, ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove)) {
    if (palette_opened_) ImGui::SetKeyboardFocusHere();
    palette_opened_ = false;
    ImGui::SetNextItemWidth(-1.0f);
    const bool entered =
        ImGui::InputTextWithHint("##line", "a command, such as set vpl.count=2048 or view albedo", palette_text_.data(),
                                 palette_text_.size(),
                                 ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_CallbackAlways,
                                 palette_waits() ? caret_to_end : leave_caret) ||
        palette_entered_;
    const std::string line = palette_text_.data();
    const std::vector<std::string> lines = completions(viewer_, line);
    constexpr size_t MOST_LINES = 12;
    for (size_t k = 0; k < std::min(lines.size(), MOST_LINES); ++k) ImGui::TextDisabled("%s", lines[k].c_str());
    if (entered) {
      if (!line.empty()) run(line);
      palette_ = palette_entered_ = false;
    }
    if (ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape))) palette_ = false;
  }
  ImGui::End();
}

void Panels::draw_help(glm::ivec2 window) {
  ImGui::SetNextWindowPos({20.0f, 20.0f}, ImGuiCond_Appearing);
  ImGui::SetNextWindowSize({0.6f * float(window.x), 0.85f * float(window.y)}, ImGuiCond_Appearing);
  if (ImGui::Begin("Keys and commands", &help_)) {
    ImGui::TextUnformatted(
        "left drag: turns around what is under the cursor   middle drag: moves along   right drag: looks around\n"
        "wheel: nearer and farther   W A S D Q E: flies (Shift faster)   drop a file: opens it (Shift: beside)");
    for (const KeyBinding& binding : key_bindings()) ImGui::Text("%-14s %s", binding.key, binding.help);
    ImGui::Separator();
    for (const Command& command : commands()) {
      ImGui::Text("%s %s", command.name, command.arguments);
      ImGui::SameLine(0.0f, 12.0f);
      ImGui::TextDisabled("%s", command.help);
    }
  }
  ImGui::End();
}

}  // namespace volgi::demo
