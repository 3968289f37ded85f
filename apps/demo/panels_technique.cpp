// Panels made from the registry: recipe, stages, parameters, the volume.
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>

#include "apps/demo/panels.h"
#include "apps/demo/presets.h"
#include "apps/volgi/volume_options.h"
#include "core/error.h"
#include "core/surface.h"
#include "screen/frame/plan.h"
#include "screen/frame/registry.h"

namespace volgi::demo {

namespace {

constexpr float GREYED = 0.45f;

void tooltip(const std::string& text) {
  if (!ImGui::IsItemHovered()) return;
  ImGui::BeginTooltip();
  ImGui::PushTextWrapPos(ImGui::GetFontSize() * 30.0f);
  ImGui::TextUnformatted(text.c_str());
  ImGui::PopTextWrapPos();
  ImGui::EndTooltip();
}

/// Why these options make no picture of a scene; empty where they do.
std::string refusal(const Session& session, screen::FrameOptions options) {
  options.size = glm::max(session.size(), glm::ivec2(1));
  try {
    screen::plan_picture(screen::recipe_of(options), options, screen::paths_in(session.document().scene()),
                         shines(session.document().scene()));
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

bool is_off(const Session& session, const screen::StageType& stage) {
  const auto& without = session.settings().frame.without;
  return std::find(without.begin(), without.end(), stage.name) != without.end();
}

}  // namespace

void Panels::draw_technique() {
  const Settings& settings = viewer_.session.settings();
  const screen::Recipe now = screen::recipe_of(settings.frame);
  if (ImGui::BeginCombo("recipe", now.name)) {
    for (const screen::Recipe& recipe : screen::recipes()) {
      screen::FrameOptions options = settings.frame;
      take_recipe(recipe.name, options);
      const std::string why = refusal(viewer_.session, options);
      const bool chosen = std::string(recipe.name) == now.name;
      const ImGuiSelectableFlags flags = why.empty() ? 0 : ImGuiSelectableFlags_Disabled;
      if (ImGui::Selectable(recipe.name, chosen, flags)) run(fmt::format("recipe {}", recipe.name));
      tooltip(why.empty() ? recipe.help : why);
    }
    ImGui::EndCombo();
  }
  tooltip(now.help);
  for (const Preset& preset : presets()) {
    if (ImGui::Button(preset.name)) run(fmt::format("preset {}", preset.name));
    tooltip(preset.help);
    ImGui::SameLine();
  }
  if (ImGui::Button("reset")) run("reset");
  tooltip("all parameters as the recipe has them");
  ImGui::SameLine();
  if (ImGui::Button("undo")) run("undo");
  ImGui::SameLine();
  if (ImGui::Button("redo")) run("redo");
  for (const screen::StageType* stage : screen::find_recipe(now.name).stages) draw_stage(*stage);
  if (ImGui::TreeNode("shadow maps")) {
    for (const screen::Parameter* p : screen::parameters()) {
      if (std::string(p->name).starts_with("shadow.")) draw_parameter(*p);
    }
    ImGui::TreePop();
  }
  draw_volume();
}

/// A switch, and the stage's parameters behind it.
void Panels::draw_stage(const screen::StageType& stage) {
  const bool off = is_off(viewer_.session, stage);
  screen::FrameOptions other = viewer_.session.settings().frame;
  if (off) {
    std::erase(other.without, stage.name);
  } else {
    other.without.emplace_back(stage.name);
  }
  std::string why = idle_stage(viewer_.session.settings().frame, viewer_.session.document().scene(), stage.name);
  if (why.empty()) why = refusal(viewer_.session, other);
  bool on = !off;
  if (!why.empty()) ImGui::PushStyleVar(ImGuiStyleVar_Alpha, ImGui::GetStyle().Alpha * GREYED);
  ImGui::PushID(stage.name);
  if (ImGui::Checkbox("##on", &on) && why.empty()) run(fmt::format("stage {} toggle", stage.name));
  if (!why.empty()) ImGui::PopStyleVar();
  tooltip(why.empty() ? fmt::format("{}: slot {}", stage.name, slot_name(stage.slot)) : why);
  ImGui::SameLine();
  if (ImGui::TreeNode(stage.name)) {
    for (const screen::Parameter& p : stage.parameters) draw_parameter(p);
    ImGui::TreePop();
  }
  ImGui::PopID();
}

void Panels::draw_parameter(const screen::Parameter& p) {
  const screen::TypeMap& options = viewer_.session.settings().frame.settings;
  const std::string text = value_text(p, options);
  const std::optional<double> value = p.get(options);
  ImGui::PushID(p.name);
  ImGui::SetNextItemWidth(ImGui::GetFontSize() * 9.0f);
  const std::string label = *p.unit != '\0' ? fmt::format("{} [{}]", p.name, p.unit) : std::string(p.name);
  if (!p.value_names.empty()) {
    if (ImGui::BeginCombo(label.c_str(), text.c_str())) {
      for (const char* name : p.value_names) {
        if (ImGui::Selectable(name, text == name)) run(fmt::format("set {}={}", p.name, name));
      }
      ImGui::EndCombo();
    }
  } else if (p.whole) {
    int number = int(value.value_or(p.least));
    const std::string format = value ? std::string("%d") : text;
    if (ImGui::DragInt(label.c_str(), &number, std::max(1.0f, float(number) * 0.01f), int(p.least), int(p.most),
                       format.c_str(), ImGuiSliderFlags_AlwaysClamp))
      run(fmt::format("set {}={}", p.name, number));
  } else {
    float number = float(value.value_or(p.least));
    const std::string format = value ? std::string("%.4g") : text;
    if (ImGui::DragFloat(label.c_str(), &number, float(p.most - p.least) * 0.002f, float(p.least), float(p.most),
                         format.c_str(), ImGuiSliderFlags_AlwaysClamp))
      run(fmt::format("set {}={}", p.name, number));
  }
  tooltip(screen::help_line(p));
  if (text != value_text(p, viewer_.session.recipe_settings())) {
    ImGui::SameLine();
    if (ImGui::SmallButton("reset")) run(fmt::format("reset {}", p.name));
  }
  ImGui::PopID();
}

void Panels::draw_volume() {
  if (!ImGui::TreeNode("volume and light")) return;
  const Settings& settings = viewer_.session.settings();
  const auto choose = [&](const char* command, const char* now, std::initializer_list<const char*> names,
                          const char* help) {
    ImGui::SetNextItemWidth(ImGui::GetFontSize() * 9.0f);
    if (ImGui::BeginCombo(command, now)) {
      for (const char* name : names) {
        if (ImGui::Selectable(name, std::string(now) == name)) run(fmt::format("{} {}", command, name));
      }
      ImGui::EndCombo();
    }
    tooltip(help);
  };
  const VolumeOptions& volume = settings.frame.of<VolumeOptions>();
  int cells = viewer_.session.frame_options(glm::ivec2(1)).of<VolumeOptions>().grid_cells;
  ImGui::SetNextItemWidth(ImGui::GetFontSize() * 9.0f);
  if (ImGui::SliderInt("grid", &cells, 4, 128)) run(fmt::format("grid {}", cells));
  tooltip("cells along the scene's longest axis");
  ImGui::SameLine();
  if (ImGui::SmallButton(settings.grid_fits_scene ? "by the scene" : "fit")) run("grid auto");
  choose("scheme", app::scheme_name(volume.scheme.scheme), {"ordinates", "conservative", "gaitatzes2010", "lpv2009"},
         "how the volume propagates light");
  choose("directions", volume.scheme.directions ? std::to_string(*volume.scheme.directions).c_str() : "auto",
         {"auto", "8", "24", "48", "80", "128"}, "of ordinates");
  choose("sh-order", std::to_string(volume.scheme.sh_order).c_str(), {"1", "2"}, "of the other schemes");
  choose("bounces", settings.frame.bounces ? std::to_string(*settings.frame.bounces).c_str() : "all",
         {"all", "0", "1", "2", "3", "4", "8"}, "reflections that are followed");
  choose("part",
         settings.frame.light == screen::LightPart::full     ? "full"
         : settings.frame.light == screen::LightPart::direct ? "direct"
                                                             : "indirect",
         {"full", "direct", "indirect"}, "light that is computed");
  choose("backend",
         settings.frame.backend == screen::Backend::automatic ? "auto"
         : settings.frame.backend == screen::Backend::gpu     ? "gpu"
                                                              : "cpu",
         {"auto", "gpu", "cpu"}, "where the volume is computed; auto: the CPU where OpenGL is software");
  ImGui::TreePop();
}

}  // namespace volgi::demo
