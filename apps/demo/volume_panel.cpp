#include "apps/demo/volume_panel.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace volgi::demo {

namespace {

constexpr float PANEL_WIDTH = 320.0f;  // in text's pixels

void choose(VolumeViewer& v, const char* label, const char* command, const std::string& now,
            const std::vector<std::string>& names) {
  if (!ImGui::BeginCombo(label, now.c_str())) return;
  for (const std::string& name : names) {
    if (ImGui::Selectable(name.c_str(), name == now)) run_or_say(v, fmt::format("{} {}", command, name));
  }
  ImGui::EndCombo();
}

void draw_values(VolumeViewer& v) {
  const VolumeLook& look = v.look();
  choose(v, "grid", "grid", v.shows_radiance() ? v.grids().back() : v.field().name, v.grids());
  const auto channels = channels_of(v.field().kind);
  choose(v, "channel", "channel", look.channel, {channels.begin(), channels.end()});
  choose(v, "colours", "colours", kVolumeMapNames[size_t(look.map)], {kVolumeMapNames.begin(), kVolumeMapNames.end()});
  double ends[2] = {look.low, look.high};
  if (ImGui::InputScalarN("range", ImGuiDataType_Double, ends, 2, nullptr, nullptr, "%.4g",
                          ImGuiInputTextFlags_EnterReturnsTrue))
    run_or_say(v, fmt::format("range {},{}", ends[0], ends[1]));
  if (ImGui::Button("whole")) run_or_say(v, "range whole");
  ImGui::SameLine();
  if (ImGui::Button("auto")) run_or_say(v, "range auto");
  ImGui::SameLine();
  bool logarithmic = look.logarithmic;
  if (ImGui::Checkbox("logarithmic", &logarithmic)) run_or_say(v, logarithmic ? "log on" : "log off");
}

void draw_direction(VolumeViewer& v) {
  if (v.grids().back() != "radiance") return;
  glm::vec2 deg = v.direction_deg();
  ImGui::TextUnformatted("light that travels towards");
  bool changed = ImGui::SliderFloat("azimuth", &deg.x, -180.0f, 180.0f, "%.0f");
  changed = ImGui::SliderFloat("height", &deg.y, -90.0f, 90.0f, "%.0f") || changed;
  if (changed) run_or_say(v, fmt::format("direction {},{}", deg.x, deg.y));
}

void draw_slices(VolumeViewer& v) {
  const glm::ivec3 first(v.field().first.x(), v.field().first.y(), v.field().first.z());
  const glm::ivec3 last = first + v.field().step * v.field().cells - 1;
  for (int axis = 0; axis < 3; ++axis) {
    int index = v.cell()[axis];
    const std::string name(1, "xyz"[axis]);
    if (ImGui::SliderInt(name.c_str(), &index, first[axis], last[axis]))
      run_or_say(v, fmt::format("slice {}={}", name, index));
  }
  ImGui::TextWrapped("%s", cell_text(v.field(), v.look().cell).c_str());
}

void draw_histogram(const VolumeViewer& v) {
  constexpr int BINS = 64;
  std::vector<float> counts = v.histogram(BINS);
  for (float& count : counts) count = std::log1p(count);
  ImGui::PlotHistogram("##histogram", counts.data(), BINS, 0, "cells by value (logarithm)", 0.0f,
                       std::max(*std::max_element(counts.begin(), counts.end()), 1e-6f), {0.0f, 90.0f});
  const VolumeScalars& s = v.scalars();
  ImGui::TextWrapped(
      "%s", fmt::format("{} cells, {:.4g} to {:.4g}, mean {:.4g} {}", s.count, s.low, s.high, s.mean, v.field().unit)
                .c_str());
}

void draw_help(VolumeViewer& v, glm::ivec2 window) {
  ImGui::SetNextWindowPos({20.0f, 20.0f}, ImGuiCond_Appearing);
  ImGui::SetNextWindowSize({0.5f * float(window.x), 0.85f * float(window.y)}, ImGuiCond_Appearing);
  if (ImGui::Begin("Keys and commands", &v.help_shown)) {
    ImGui::TextUnformatted(
        "on a slice, left drag: the cell   wheel: the slice\n"
        "in space, left drag: turns   wheel: nearer and farther   right click: the cell");
    for (const KeyBinding& binding : volume_key_bindings()) ImGui::Text("%-10s %s", binding.key, binding.help);
    ImGui::Separator();
    for (const VolumeCommand& command : volume_commands()) {
      ImGui::Text("%s %s", command.name, command.arguments);
      ImGui::SameLine(0.0f, 12.0f);
      ImGui::TextDisabled("%s", command.help);
    }
  }
  ImGui::End();
}

}  // namespace

void run_or_say(VolumeViewer& viewer, std::string_view command) {
  try {
    execute(viewer, command);
    viewer.message.clear();
  } catch (const Error& error) {
    viewer.message = error.what();
  }
}

int volume_panel_width(const VolumeViewer& viewer, glm::ivec2 window, float scale) {
  return viewer.panel_shown ? std::min(int(PANEL_WIDTH * scale), window.x / 2) : 0;
}

void draw_volume_panel(VolumeViewer& v, glm::ivec2 window, float scale) {
  if (v.panel_shown) {
    const float wide = float(volume_panel_width(v, window, scale));
    ImGui::SetNextWindowPos({float(window.x) - wide, 0.0f});
    ImGui::SetNextWindowSize({wide, float(window.y)});
    constexpr ImGuiWindowFlags FIXED =
        ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoTitleBar;
    if (ImGui::Begin("volume", nullptr, FIXED)) {
      ImGui::PushItemWidth(0.68f * wide);
      ImGui::TextWrapped("%s", v.file().filename().c_str());
      if (!v.field().description.empty()) ImGui::TextWrapped("%s", v.field().description.c_str());
      draw_values(v);
      draw_direction(v);
      ImGui::Separator();
      draw_slices(v);
      ImGui::Separator();
      draw_histogram(v);
      choose(v, "view", "view", v.view(), {"sheet", "x", "y", "z", "orbit"});
      bool cut = v.look().cut;
      if (ImGui::Checkbox("cut open", &cut)) run_or_say(v, cut ? "cut on" : "cut off");
      if (!v.message.empty()) ImGui::TextWrapped("%s", v.message.c_str());
      ImGui::TextDisabled("F1: keys and commands");
      ImGui::PopItemWidth();
    }
    ImGui::End();
  }
  if (v.help_shown) draw_help(v, window);
}

}  // namespace volgi::demo
