#include "apps/volgi/frame_stats.h"

#include <fmt/format.h>

namespace volgi::app {

namespace {

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
  auto rgb = [](glm::vec3 v) { return nlohmann::json::array({v.x, v.y, v.z}); };
  return {
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
      {"grid", {report.volume.grid.x, report.volume.grid.y, report.volume.grid.z}},
      {"iterations", report.volume.bounces.passes},
      {"orders", report.volume.bounces.orders},
      {"converged", report.volume.bounces.converged},
      {"sides", report.volume.sides},
      {"vpls", report.virtual_lights},
      {"negative_lights", report.negative_lights},
      {"coarse_share", report.coarse_share},
      {"vals", report.area_lights},
      {"backend", report.volume.on_gpu ? "gpu" : "cpu"},
      {"memory_bytes", report.memory_bytes},
      {"power_W",
       {{"injected", rgb(report.volume.injected)},
        {"sent", rgb(report.volume.bounces.sent)},
        {"left", rgb(report.volume.bounces.left)},
        {"lost", rgb(report.volume.lost)}}},
  };
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
  if (stats["grid"][0] != 0) {
    text += fmt::format(
        "  grid {}x{}x{}, {} sides, {} orders in {} passes over the volume, volume on the {}, {:.1f} MiB in all\n",
        stats["grid"][0].get<int>(), stats["grid"][1].get<int>(), stats["grid"][2].get<int>(),
        stats["sides"].get<unsigned>(), stats["orders"].get<int>(), stats["iterations"].get<int>(),
        stats["backend"] == "gpu" ? "GPU" : "CPU", stats["memory_bytes"].get<double>() / 1048576.0);
  }
  if (stats["vpls"] != 0) {
    text += fmt::format("  {} virtual lights", stats["vpls"].get<int>());
    if (stats["negative_lights"] != 0) text += fmt::format(", {} negative", stats["negative_lights"].get<int>());
    text += fmt::format(", {:.1f} % of the pixels from coarse ones, {:.1f} MiB in all\n",
                        100.0 * stats["coarse_share"].get<double>(), stats["memory_bytes"].get<double>() / 1048576.0);
  }
  return text;
}

}  // namespace volgi::app
