#include "apps/volgi/frame_stats.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "screen/frame/registry.h"

namespace volgi::app {

namespace {

/// Whole numbers without a point.
nlohmann::json json_of(double value) {
  return std::floor(value) == value ? nlohmann::json(std::int64_t(value)) : nlohmann::json(value);
}
nlohmann::json json_of(const std::vector<double>& values) {
  nlohmann::json all = nlohmann::json::array();
  for (const double v : values) all.push_back(json_of(v));
  return all;
}
nlohmann::json json_of(bool value) { return value; }
nlohmann::json json_of(const std::string& value) { return value; }

/// "a.b": member b of a.
void set_figure(nlohmann::json& stats, const screen::FrameReport::Figure& figure) {
  std::string pointer = "/" + figure.name;
  std::replace(pointer.begin(), pointer.end(), '.', '/');
  std::visit([&](const auto& value) { stats[nlohmann::json::json_pointer(pointer)] = json_of(value); }, figure.value);
}

nlohmann::json to_json(const std::vector<gl::PassTimer::PassTime>& passes) {
  nlohmann::json out = nlohmann::json::array();
  for (const auto& pass : passes)
    out.push_back({{"name", pass.name}, {"gpu_ms", pass.gpu_ms}, {"cpu_ms", pass.cpu_ms}});
  return out;
}

std::string frame_line(const nlohmann::json& stats, double sum_of_passes) {
  const double cold_ms = stats["cold"]["frame_ms"];
  if (!stats["warm"].get<bool>()) {
    return fmt::format("  {:<56} {:9.2f} ms  (the first, shader compilation in it; --frames 3 times warm ones)\n",
                       "frame, cold", cold_ms);
  }
  return fmt::format("  {:<56} {:9.2f} ms  (median of {}; sum of passes {:.2f}; cold {:.2f})\n", "frame",
                     stats["frame_ms"]["median"].get<double>(), stats["frames"].get<int>(), sum_of_passes, cold_ms);
}

}  // namespace

ColdFrame cold_frame(gl::PassTimer& timer) { return {timer.frame_time().median_ms, timer.medians()}; }

nlohmann::json frame_stats(const std::string& scene, const std::string& mode, glm::ivec2 size,
                           const gl::Context& context, gl::PassTimer& timer, const TimedFrames& frames,
                           const screen::FrameReport& report) {
  auto frame = timer.frame_time();
  nlohmann::json stats = {
      {"scene", scene},
      {"mode", mode},
      {"size", {size.x, size.y}},
      {"device", context.device_name()},
      {"gl_version", context.version()},
      {"timer", timer.kind() == gl::PassTimer::Kind::gpu ? "gpu" : "wall"},
      {"frames", frames.count},
      {"frame_ms", {{"min", frame.min_ms}, {"median", frame.median_ms}, {"max", frame.max_ms}}},
      {"passes", to_json(timer.medians())},
      {"warm", frames.warm},
      {"cold", {{"frame_ms", frames.cold.frame_ms}, {"passes", to_json(frames.cold.passes)}}},
      {"memory_bytes", report.memory_bytes},
  };
  screen::FrameReport nothing;
  for (const screen::StageType* stage : screen::stage_types()) {
    if (stage->report_nothing != nullptr) stage->report_nothing(nothing);
  }
  for (const auto& figure : nothing.figures()) set_figure(stats, figure);
  for (const auto& figure : report.figures()) set_figure(stats, figure);
  std::string summary;
  for (const auto& figure : report.figures()) {
    if (!figure.words.empty()) summary += figure.words + ", ";
  }
  stats["summary"] = summary + fmt::format("{:.1f} MiB in all", double(report.memory_bytes) / 1048576.0);
  return stats;
}

nlohmann::json quality_json(const std::string& quality, const FrameCommandOptions::Fitted& fitted,
                            const screen::Climb& climb) {
  nlohmann::json chosen = nlohmann::json::object();
  for (const screen::Chosen& c : fitted.chosen) chosen[c.name] = c.value;
  const SceneFacts& f = fitted.facts;
  return {{"name", quality},
          {"scene",
           {{"edge_m", f.edge_m},
            {"cells", f.cells},
            {"feature_m", f.feature_m},
            {"flight_m", f.flight_m},
            {"lit_area_m2", f.lit_area_m2},
            {"lamps", f.lamps}}},
          {"chosen", chosen},
          {"samples", fitted.needs.samples},
          {"rungs", climb.rung()},
          {"changes_percent", climb.changes_percent()}};
}

std::string pass_table(const nlohmann::json& stats) {
  std::string text;
  double sum = 0.0;
  for (const auto& pass : stats["passes"]) {
    double ms = pass["gpu_ms"];
    sum += ms;
    text += fmt::format("  {:<56} {:9.2f} ms\n", pass["name"].get<std::string>(), ms);
  }
  text += frame_line(stats, sum);
  return text + fmt::format("  {}\n", stats["summary"].get<std::string>());
}

}  // namespace volgi::app
