#include "apps/bench/against_path_tracing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "apps/bench/repeated_frame.h"
#include "apps/bench/timing.h"
#include "apps/bench/yardstick.h"
#include "reference/progressive_path_tracer.h"

namespace volgi::app {

namespace {

constexpr double kRequired = 10.0, kGoal = 50.0;  // times faster
constexpr std::uint32_t kSeed = 1, kReferenceSeed = 2;

struct CurvePoint {
  int spp;
  double ms;
  double error_percent;
};

PathTracerOptions tracer_options(const AgainstPathTracingOptions& options, std::uint32_t seed) {
  PathTracerOptions o;
  o.size = glm::ivec2(options.size);
  o.samples_per_pixel = options.reference_spp;
  o.light = PathTracerOptions::Light::indirect;
  o.seed = seed;
  return o;
}

screen::FrameOptions hybrid_options(screen::LightPart light, int size) {
  screen::FrameOptions o;
  o.recipe = "hybrid";
  o.light = light;
  o.size = glm::ivec2(size);
  return o;
}

Metrics::Relative hybrid_error(const Scene& scene, const gl::Context& context, const Yardstick& yardstick, int size) {
  RepeatedFrame picture(scene, context, hybrid_options(screen::LightPart::indirect, size),
                        RepeatedFrame::Timing::whole);
  picture.render();
  return yardstick.measure(picture.image());
}

std::vector<CurvePoint> path_tracing_curve(const Scene& scene, const Yardstick& yardstick, double target_percent,
                                           const AgainstPathTracingOptions& options) {
  ProgressivePathTracer tracer(scene, scene.cameras[0], tracer_options(options, kSeed));
  std::vector<CurvePoint> curve;
  double ms = 0.0;
  for (int spp = 1; spp <= options.max_spp; spp *= 2) {
    ms += time_ms([&] { tracer.trace(spp - tracer.samples_per_pixel()); });
    curve.push_back({spp, ms, yardstick.error_percent(tracer.image())});
    if (curve.back().error_percent <= target_percent) break;
  }
  return curve;
}

struct Reached {
  double ms;
  const char* bound;  // "exact", or what is known of the time: "at most", "at least"
};

Reached time_to(double error_percent, const std::vector<CurvePoint>& curve) {
  const CurvePoint& last = curve.back();
  if (last.error_percent > error_percent) return {last.ms, "at least"};
  if (curve.size() == 1) return {last.ms, "at most"};
  const CurvePoint& before = curve[curve.size() - 2];
  // A reference as noisy as the answer may leave nothing: the end of the step then.
  const double whole = std::log(before.error_percent / std::max(last.error_percent, 1e-6));
  const double part = std::log(before.error_percent / error_percent) / whole;
  return {before.ms * std::pow(last.ms / before.ms, part), "exact"};
}

}  // namespace

nlohmann::json bench_against_path_tracing(const Scene& scene, const gl::Context& context,
                                          const AgainstPathTracingOptions& options) {
  RepeatedFrame picture(scene, context, hybrid_options(screen::LightPart::full, options.size),
                        RepeatedFrame::Timing::whole);
  const Yardstick yardstick(
      cached_reference(scene, scene.cameras[0], tracer_options(options, kReferenceSeed), options.cache), scene.name);
  const Metrics::Relative error = hybrid_error(scene, context, yardstick, options.size);
  const double target = error.rmse_pct_denoised.value();

  picture.render_repeatedly(options.frames);
  std::vector<double> frames_ms = picture.frames_ms();
  const std::vector<CurvePoint> curve = path_tracing_curve(scene, yardstick, target, options);
  picture.render_repeatedly(options.frames);
  frames_ms.insert(frames_ms.end(), picture.frames_ms().begin(), picture.frames_ms().end());
  const auto [smallest, largest] = std::minmax_element(frames_ms.begin(), frames_ms.end());

  const Reached reached = time_to(target, curve);
  nlohmann::json points = nlohmann::json::array();
  for (const CurvePoint& p : curve)
    points.push_back({{"spp", p.spp}, {"ms", p.ms}, {"error_percent", p.error_percent}});
  const double frame_ms = median(frames_ms), ratio = reached.ms / frame_ms;
  return {{"scene", scene.name},
          {"triangles", scene.triangle_count()},
          {"size", {options.size, options.size}},
          {"device", context.device_name()},
          {"reference", {{"spp", options.reference_spp}, {"noise_percent", yardstick.noise_percent()}}},
          {"hybrid",
           {{"frame_ms", {{"min", *smallest}, {"median", frame_ms}, {"max", *largest}}},
            {"frames", frames_ms.size()},
            {"error_percent", target},
            {"energy", error.ratio}}},
          {"path_tracing", points},
          {"path_tracing_ms", reached.ms},
          {"bound", reached.bound},
          {"ratio", ratio},
          {"required", kRequired},
          {"goal", kGoal}};
}

std::string against_path_tracing_table(const nlohmann::json& r) {
  const auto& hybrid = r["hybrid"];
  const double ratio = r["ratio"];
  std::string text = fmt::format("{} ({} triangles), {} x {}, {}; reference {} spp, its noise {:.2f} %\n",
                                 r["scene"].get<std::string>(), r["triangles"].get<size_t>(), r["size"][0].get<int>(),
                                 r["size"][1].get<int>(), r["device"].get<std::string>(),
                                 r["reference"]["spp"].get<int>(), r["reference"]["noise_percent"].get<double>());
  text += fmt::format("  hybrid        {:10.1f} ms ({:.1f} ... {:.1f} in {} frames)   error {:6.2f} %, energy {:.3f}\n",
                      hybrid["frame_ms"]["median"].get<double>(), hybrid["frame_ms"]["min"].get<double>(),
                      hybrid["frame_ms"]["max"].get<double>(), hybrid["frames"].get<int>(),
                      hybrid["error_percent"].get<double>(), hybrid["energy"].get<double>());
  for (const auto& p : r["path_tracing"])
    text += fmt::format("  {:5} spp     {:10.1f} ms   error {:6.2f} %\n", p["spp"].get<int>(), p["ms"].get<double>(),
                        p["error_percent"].get<double>());
  const std::string bound = r["bound"] == "exact" ? "" : r["bound"].get<std::string>() + " ";
  text += fmt::format(
      "  path tracing takes {}{:.1f} ms to hybrid's error: {}{:.1f} frames of hybrid ({} {:.0f}, {} {:.0f})\n", bound,
      r["path_tracing_ms"].get<double>(), bound, ratio,
      ratio > kRequired ? "over the required" : "NOT over the required", kRequired,
      ratio > kGoal ? "over the goal" : "not over the goal", kGoal);
  return text;
}

}  // namespace volgi::app
