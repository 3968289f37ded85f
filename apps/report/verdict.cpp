#include "apps/report/verdict.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace volgi::app {
namespace {

using Json = nlohmann::ordered_json;

// What "stands out" means. A wrong unit or a light counted twice is a factor: with the best factor applied little error
// is left. Nothing that carries all bounces should be half as bright again as the reference.
constexpr double kMinConstantFactor = 1.2, kMaxErrorLeftByFactor = 1.0 / 3.0, kMaxEnergyFactor = 1.5;
constexpr double kMaxPercentLeftByFactor = 100.0 / 3.0;  // of the reference: the factor 0 leaves 100

std::optional<double> error_of(const Json& point) {
  if (point.contains("error") || !point.contains("metrics")) return std::nullopt;
  const Json& metrics = point["metrics"];
  for (const char* key : {"rmse_pct_denoised", "rmse_pct"}) {
    if (metrics.contains(key)) return metrics[key].get<double>();
  }
  return std::nullopt;
}

std::vector<size_t> front_of(const std::vector<Judged>& by_time) {
  std::vector<size_t> front;
  double best = std::numeric_limits<double>::infinity();
  for (size_t i = 0; i < by_time.size(); ++i) {
    if (by_time[i].error_percent >= best) continue;
    best = by_time[i].error_percent;
    front.push_back(i);
  }
  return front;
}

void choose(Verdict& v) {
  for (const double limit : {2.0, 5.0, 10.0}) {
    Verdict::Choice choice{limit, nullptr, nullptr};
    for (const Judged& j : v.judged) {  // by time: the first one is the fastest
      if (j.error_percent > limit) continue;
      if (choice.any == nullptr) choice.any = &j;
      if (choice.realtime == nullptr && !j.path_tracer) choice.realtime = &j;
    }
    v.by_error.push_back(choice);
  }
  for (const double speedup : {10.0, 100.0}) {
    Verdict::Choice choice{speedup, nullptr, nullptr};
    for (const Judged& j : v.judged) {
      const std::optional<TracerTime> tracer = path_tracer_time(v, j.error_percent);
      if (j.path_tracer || !tracer || tracer->ms < speedup * j.time_ms) continue;
      if (choice.realtime != nullptr && j.error_percent >= choice.realtime->error_percent) continue;
      choice.realtime = &j;
      choice.extrapolated = tracer->extrapolated;
    }
    v.by_speedup.push_back(choice);
  }
}

void hold_against_baseline(Verdict& v) {
  for (const Judged& j : v.judged) {
    if (j.is_default && j.baseline) v.baseline = &j;
  }
  if (v.baseline == nullptr) return;
  for (const Judged& j : v.judged) {
    if (j.baseline) continue;
    if (j.time_ms < v.baseline->time_ms && j.error_percent < v.baseline->error_percent) v.beating.push_back(&j);
  }
}

// What is wrong with a picture as a whole, or nothing.
std::string finding_of(const Json& metrics) {
  const double mean = metrics.at("test_mean").get<double>();
  if (!metrics.contains("ratio")) {
    return mean > 0 ? "the reference is black there, the picture is not" : "";
  }
  const double ratio = metrics.at("ratio").get<double>(), factor = 1.0 / metrics.at("scale").get<double>();
  const double error = metrics.contains("rmse_pct_denoised") ? metrics["rmse_pct_denoised"].get<double>()
                                                             : metrics.at("rmse_pct").get<double>();
  if (ratio < 1e-6) return "black: it returns no light";
  const bool far = factor > kMinConstantFactor || factor < 1.0 / kMinConstantFactor;
  const double left = metrics.value("rmse_pct_scaled", error);
  if (far && left < kMaxErrorLeftByFactor * error && left < kMaxPercentLeftByFactor) {
    return fmt::format(
        "wrong by a constant factor: {:.2f} times the light; without it {:.1f} % error instead of {:.1f}", factor, left,
        error);
  }
  if (ratio > kMaxEnergyFactor || ratio < 1.0 / kMaxEnergyFactor)
    return fmt::format("{:.2f} times the reference's light", ratio);
  return "";
}

void find(Verdict& v, const Json& point) {
  const auto add = [&](const std::string& text) { v.findings.push_back(label_of(point) + ": " + text); };
  if (point.contains("error")) {
    const std::string error = point["error"].get<std::string>();
    return add("error: " + error.substr(0, error.find('\n')));  // a driver's log is long, and stays in the line
  }
  const bool one_bounce = point.value("one_bounce", false);
  // What carries one bounce is short of light by nature: it is judged by the reference of one bounce, if there is one.
  const char* by = one_bounce ? "one_bounce_metrics" : "metrics";
  if (point.contains(by)) {
    const std::string finding = finding_of(point[by]);
    if (!finding.empty()) add(finding + (one_bounce ? " (against one bounce)" : ""));
  }
  const int negative = point["metrics"].value("negative", 0);
  if (negative > 0) add(fmt::format("{} pixels below zero", negative));
}

}  // namespace

std::string label_of(const Json& point) {
  const std::string varied = point.value("varied", std::string());
  return point.at("technique").get<std::string>() + (varied.empty() ? "" : " " + varied);
}

Verdict judge_points(const std::vector<Json>& points, const std::string& scene, const std::string& light) {
  Verdict v;
  v.scene = scene;
  v.light = light;
  for (const Json& point : points) {
    if (point.at("scene") != scene || point.at("light") != light) continue;
    find(v, point);
    const std::optional<double> error = error_of(point);
    if (!error || !point.contains("frame_ms")) continue;  // of another renderer, without its time
    v.judged.push_back({&point, label_of(point), point.at("frame_ms").at("median").get<double>(), *error,
                        point.value("varied", std::string()).empty(), point.at("renderer") == "reference",
                        point.value("baseline", false)});
  }
  std::stable_sort(v.judged.begin(), v.judged.end(), [](const Judged& a, const Judged& b) {
    return a.time_ms != b.time_ms ? a.time_ms < b.time_ms : a.error_percent < b.error_percent;
  });
  v.front = front_of(v.judged);
  choose(v);
  hold_against_baseline(v);
  return v;
}

std::optional<TracerTime> path_tracer_time(const Verdict& verdict, double error_percent) {
  std::vector<const Judged*> tracer;  // from the cheapest on, each better than the last
  for (const Judged& j : verdict.judged) {
    if (j.path_tracer && (tracer.empty() || j.error_percent < tracer.back()->error_percent)) tracer.push_back(&j);
  }
  if (tracer.empty()) return std::nullopt;
  if (error_percent >= tracer.front()->error_percent) return TracerTime{tracer.front()->time_ms, false};
  for (size_t i = 1; i < tracer.size(); ++i) {
    if (error_percent < tracer[i]->error_percent) continue;
    const double from = std::log(tracer[i - 1]->error_percent), to = std::log(std::max(tracer[i]->error_percent, 1e-9));
    const double share = (std::log(error_percent) - from) / (to - from);
    return TracerTime{std::exp(std::lerp(std::log(tracer[i - 1]->time_ms), std::log(tracer[i]->time_ms), share)),
                      false};
  }
  const double ratio = tracer.back()->error_percent / std::max(error_percent, 1e-9);
  return TracerTime{tracer.back()->time_ms * ratio * ratio, true};
}

}  // namespace volgi::app
