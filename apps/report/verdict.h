#pragma once
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace volgi::app {

/// A measured point as verdicts see it. Error: the noise-removed rmse_percent where the reference has its noise, region
/// noedge; time: the median of a frame.
struct Judged {
  const nlohmann::ordered_json* point;
  std::string label;
  double time_ms, error_percent;
  bool is_default;   // the technique's own line of the sweep
  bool path_tracer;  // renderer "reference"
  bool baseline;     // of the technique that others are held against (Setting::baseline)
};

/// What one scene and light comes to.
struct Verdict {
  std::string scene, light;
  std::vector<Judged> judged;  // by time; those with an error message, or without figures or times, are left out
  std::vector<size_t> front;   // of `judged`: no other is both faster and more accurate. By time

  /// The fastest at or under an error; and the most accurate among those that the path tracer needs at least `speedup`
  /// times as long for, to the same error. Null where there is none.
  struct Choice {
    double limit;
    const Judged* any;          // path tracer included; null for `by_speedup`
    const Judged* realtime;     // path tracer left out
    bool extrapolated = false;  // of `by_speedup`: the path tracer was not measured to this error
  };
  std::vector<Choice> by_error;        // limits in percent
  std::vector<Choice> by_speedup;      // limits: how many times faster
  const Judged* baseline = nullptr;    // at its defaults; none: the sweep marks no technique
  std::vector<const Judged*> beating;  // both faster and lower in error than that
  std::vector<std::string> findings;   // what stands out as wrong: errors, black, a constant factor, energy

  Verdict() = default;
  Verdict(Verdict&&) = default;  // a move leaves `judged` where the pointers point
  Verdict& operator=(Verdict&&) = default;
  Verdict(const Verdict&) = delete;
  Verdict& operator=(const Verdict&) = delete;
};

Verdict judge_points(const std::vector<nlohmann::ordered_json>& points, const std::string& scene,
                     const std::string& light);

struct TracerTime {
  double ms;
  bool extrapolated;  // beyond its best point: not measured
};
/// Time the path tracer needs to an error: between its points straight in log-log; beyond its best one by 1/error²,
/// which is how its error falls; never less than its cheapest point. None where it was not measured at all.
std::optional<TracerTime> path_tracer_time(const Verdict& verdict, double error_percent);

/// Technique and what it differs in: "volume --grid 16".
std::string label_of(const nlohmann::ordered_json& point);

}  // namespace volgi::app
