// Panels of what is shown: views, picture, reference, times.
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <map>

#include "apps/demo/panels.h"

namespace volgi::demo {

namespace {

constexpr float GREYED = 0.45f;

void tooltip(const std::string& text) {
  if (!text.empty() && ImGui::IsItemHovered()) ImGui::SetTooltip("%s", text.c_str());
}

}  // namespace

void Panels::draw_view() {
  Session& session = viewer_.session;
  if (!session.has_picture()) return;
  for (const ViewInfo& v : views()) {
    const std::string why = why_not(v.view, session.frame());
    if (!why.empty()) ImGui::PushStyleVar(ImGuiStyleVar_Alpha, ImGui::GetStyle().Alpha * GREYED);
    const std::string label = fmt::format("{:<22}{}", v.title, v.key);
    if (ImGui::Selectable(label.c_str(), session.view() == v.view)) run(fmt::format("view {}", v.name));
    if (!why.empty()) ImGui::PopStyleVar();
    tooltip(why.empty() ? std::string(v.help) : why);
  }
  ViewDetails& details = session.details();
  ImGui::Separator();
  if (session.view() == View::texture) {
    if (ImGui::BeginCombo("##texture", details.texture.empty() ? "which" : details.texture.c_str())) {
      for (const screen::NamedTexture& t : session.frame().textures()) {
        if (ImGui::Selectable(t.name.c_str(), details.texture == t.name)) run("texture " + t.name);
      }
      ImGui::EndCombo();
    }
    constexpr const char* CHANNELS[] = {"rgb", "r", "g", "b", "a", "length"};
    if (ImGui::BeginCombo("channel", CHANNELS[details.channel])) {
      for (const char* name : CHANNELS) {
        if (ImGui::Selectable(name)) run(fmt::format("channel {}", name));
      }
      ImGui::EndCombo();
    }
    bool log_scale = details.log_scale;
    if (ImGui::Checkbox("log", &log_scale)) run("log");
    glm::vec2 range = details.range.value_or(glm::vec2(0.0f, 1.0f));
    if (ImGui::DragFloat2("range", &range.x, 0.01f) && range.x < range.y)
      run(fmt::format("range {},{}", range.x, range.y));
    ImGui::SameLine();
    if (ImGui::SmallButton("auto")) run("range auto");
  }
  if (session.view() == View::texture || session.view() == View::cluster_maps) {
    int layer = details.layer;
    if (ImGui::InputInt("layer", &layer) && layer >= 0) run(fmt::format("layer {}", layer));
  }
  if (session.view() == View::voxels) {
    constexpr const char* COLOURS[] = {"irradiance", "direct", "indirect", "albedo", "coverage", "normal", "emission"};
    if (ImGui::BeginCombo("colour", COLOURS[details.voxel_colour])) {
      for (const char* name : COLOURS) {
        if (ImGui::Selectable(name)) run(fmt::format("voxels {}", name));
      }
      ImGui::EndCombo();
    }
  }
  if (!viewer_.under_cursor.empty()) ImGui::TextWrapped("%s", viewer_.under_cursor.c_str());
}

void Panels::draw_picture() {
  Session& session = viewer_.session;
  const Settings& settings = session.settings();
  float ev = session.exposure_ev();
  ImGui::SetNextItemWidth(ImGui::GetFontSize() * 9.0f);
  if (ImGui::SliderFloat("exposure", &ev, -12.0f, 12.0f, "%.2f EV")) run(fmt::format("exposure {}", ev));
  ImGui::SameLine();
  if (ImGui::SmallButton(settings.exposure_ev ? "auto" : "is auto")) run("exposure auto");
  bool filter = settings.post_filter, average = settings.progressive;
  if (ImGui::Checkbox("smooth edges while moving (FXAA)", &filter)) run("filter");
  if (ImGui::Checkbox("average while nothing moves", &average)) run("average");
  float fps = float(settings.motion_fps);
  ImGui::SetNextItemWidth(ImGui::GetFontSize() * 9.0f);
  if (ImGui::SliderFloat("fps while moving", &fps, 0.0f, 60.0f, fps > 0.0f ? "%.0f" : "full quality"))
    run(fmt::format("motion {}", fps));
  tooltip("where frames are slower, what moves is shown with half the pixels and fewer virtual lights");
  int most = settings.most_samples;
  ImGui::SetNextItemWidth(ImGui::GetFontSize() * 9.0f);
  if (ImGui::InputInt("pictures at most", &most) && most > 0) run(fmt::format("average {}", most));
  if (ImGui::Button("screenshot")) run("screenshot");
  ImGui::SameLine();
  if (ImGui::Button("copy command")) run("copy command");
  ImGui::SameLine();
  if (ImGui::Button("save settings")) run("settings save");
}

void Panels::draw_truth() {
  constexpr const char* MODES[] = {"off", "beside", "alone", "error"};
  for (int k = 0; k < 4; ++k) {
    if (k > 0) ImGui::SameLine();
    if (ImGui::RadioButton(MODES[k], int(viewer_.truth.mode()) == k)) {
      run("reference off");
      if (k > 0) run(fmt::format("reference {}", MODES[k]));
    }
  }
  if (viewer_.truth.mode() == TruthMode::off) return;
  if (const std::string failure = viewer_.truth.failure(); !failure.empty()) {
    ImGui::TextWrapped("%s", failure.c_str());
    return;
  }
  float wipe = viewer_.truth.wipe();
  if (viewer_.truth.mode() == TruthMode::beside && ImGui::SliderFloat("line", &wipe, 0.0f, 1.0f))
    run(fmt::format("wipe {}", wipe));
  ImGui::Text("%d samples in %.1f s", viewer_.truth.samples(), viewer_.truth.seconds());
  const auto& measured = viewer_.truth.measured(viewer_.session);
  if (!measured || !measured->relative) return;
  const Metrics::Relative& r = *measured->relative;
  ImGui::Text("ratio of means  %.4f", r.ratio);
  ImGui::Text("rmse            %.2f %%", r.rmse_pct);
  if (r.rmse_pct_denoised) ImGui::Text("without noise   %.2f %%", *r.rmse_pct_denoised);
}

void Panels::draw_times() {
  Session& session = viewer_.session;
  std::vector<float> ms(frame_ms_.begin(), frame_ms_.end());
  if (!ms.empty()) {
    std::vector<float> sorted = ms;
    std::nth_element(sorted.begin(), sorted.begin() + std::ptrdiff_t(sorted.size() / 2), sorted.end());
    const float median = sorted[sorted.size() / 2];
    ImGui::PlotLines("##frames", ms.data(), int(ms.size()), 0, nullptr, 0.0f, 2.0f * median, {-1.0f, 60.0f});
    ImGui::Text("%.1f ms a frame (median of %zu), %.1f fps", double(median), ms.size(), 1000.0 / double(median));
  }
  bool timed = viewer_.times_passes;
  if (ImGui::Checkbox("time passes", &timed)) run("times");
  tooltip("on a software rasterizer passes then wait for one another");
  std::string room;
  bool open = false;
  double sum = 0.0;
  std::map<std::string, double> of_room;
  const auto times = session.timer().latest();
  for (const auto& t : times) of_room[t.name.substr(0, t.name.rfind('/'))] += t.gpu_ms;
  for (const auto& t : times) {
    sum += t.gpu_ms;
    const size_t slash = t.name.rfind('/');
    const std::string folder = t.name.substr(0, slash);
    if (folder != room) {
      if (open) ImGui::TreePop();
      room = folder;
      open = ImGui::TreeNodeEx(fmt::format("{:<34} {:7.2f}##{}", folder, of_room[folder], t.name).c_str());
    }
    if (open) ImGui::Text("%-30s %7.2f  cpu %6.2f", t.name.substr(slash + 1).c_str(), t.gpu_ms, t.cpu_ms);
  }
  if (open) ImGui::TreePop();
  if (!times.empty()) ImGui::Text("sum of passes %.1f ms", sum);
  if (ImGui::Button("export CSV")) run("times save times.csv");
  ImGui::SameLine();
  if (ImGui::Button("figures")) figures_ = session.has_picture() ? session.frame().report() : screen::FrameReport();
  for (const auto& figure : figures_.figures()) {
    if (!figure.words.empty()) ImGui::TextWrapped("%s", figure.words.c_str());
  }
  if (figures_.memory_bytes > 0) ImGui::Text("%.1f MiB", double(figures_.memory_bytes) / 1048576.0);
}

}  // namespace volgi::demo
