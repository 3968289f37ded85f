#include "screen/frame/choice.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <numeric>

#include "core/error.h"
#include "screen/frame/quality.h"

namespace volgi::screen {

namespace {

using Row = std::vector<double>;
using PointValue = std::optional<double> FrontPoint::*;

constexpr double WITHIN = 1.3;               // of a budget: what counts as kept
constexpr double HOW_OFTEN = 0.9;            // it is to be kept
constexpr double ALIKE = 1.1;                // errors
constexpr size_t FEWEST_SCENES = 4;          // that a prediction is made of
constexpr double ALIKE_WITHIN = 0.5;         // of logarithms of facts
constexpr double STRANGER = 0.2;             // weight of no correction
constexpr double LEAST_ERROR = 0.05;         // %: below, references are as wrong
constexpr double CLUSTERS_BY_DEFAULT = 4.0;  // of a room's, at most (quality.cpp)

/// Least squares of `rows` · x = `values`, each coefficient pulled to 0 by `pull` of its own square sum; by descent
/// along one coefficient after another, which ends where a bound or the pull says. Deterministic.
Row least_squares(const std::vector<Row>& rows, const Row& values, double pull, bool not_negative) {
  const size_t n = rows.front().size();
  std::vector<Row> squares(n, Row(n, 0.0));
  Row products(n, 0.0), x(n, 0.0);
  for (size_t r = 0; r < rows.size(); ++r)
    for (size_t i = 0; i < n; ++i) {
      products[i] += rows[r][i] * values[r];
      for (size_t j = 0; j < n; ++j) squares[i][j] += rows[r][i] * rows[r][j];
    }
  constexpr int ROUNDS = 500;
  double change = 1.0;  // of what a coefficient adds, to all
  for (int k = 0; k < ROUNDS && change > 1e-9; ++k) {
    change = 0.0;
    for (size_t i = 0; i < n; ++i) {
      const double own = squares[i][i] * (1.0 + pull);
      if (!(own > 1e-12)) continue;
      double rest = products[i];
      for (size_t j = 0; j < n; ++j)
        if (j != i) rest -= squares[i][j] * x[j];
      const double next = not_negative ? std::max(0.0, rest / own) : rest / own;
      change = std::max(change, std::abs(next - x[i]) * std::sqrt(squares[i][i] / double(rows.size())));
      x[i] = next;
    }
  }
  return x;
}

double dot(const Row& a, const Row& b) { return std::inner_product(a.begin(), a.end(), b.begin(), 0.0); }

/// What a frame's time is a sum of: triangles, cells, those that surfaces shine into, clusters, triangles in clusters'
/// maps, texels of shadow maps, those that are drawn more than once where walls are all around, and that there are
/// punctual lights at all, or a sky.
Row costs(const PictureFacts& f) {
  const double clusters = std::min(lights_for(f.scene), CLUSTERS_BY_DEFAULT), triangles = f.triangles / 1e4;
  const double cells = f.cells / 1e6, texels = f.shadow_texels / 1e6;
  return {1.0,
          triangles,
          cells,
          f.emits ? cells : 0.0,
          clusters - 1.0,
          clusters * triangles,
          texels,
          texels * (1.0 - std::clamp(f.openness, 0.0, 1.0)),
          texels > 0.0 ? 1.0 : 0.0,
          f.sky ? 1.0 : 0.0};
}

/// What an error goes by, as logarithms: how concentrated light is, how many lights stand for the lit area, how little
/// of what is seen has been reflected only once, and how fine the scene is.
Row difficulties(const PictureFacts& f) {
  const double flight = std::max(1e-6, double(f.scene.flight_m));
  return {std::log(f.noise + 0.05), std::log(std::max(0.1, double(f.scene.lit_area_m2) / (flight * flight))),
          -std::log(std::max(0.02, f.first_share)),
          std::log(std::max(1.0, double(f.scene.edge_m) / std::max(1e-6, double(f.scene.feature_m)))),
          f.shadow_texels > 0.0 ? 1.0 : 0.0};
}

struct Scale {
  Row mean, deviation;

  /// Within what has been seen: farther out a straight line says nothing.
  Row operator()(const Row& row) const {
    constexpr double FARTHEST = 2.5;
    Row out(row.size());
    for (size_t i = 0; i < row.size(); ++i) out[i] = std::clamp((row[i] - mean[i]) / deviation[i], -FARTHEST, FARTHEST);
    return out;
  }
};

Scale scale_of(const std::vector<Row>& rows) {
  const size_t n = rows.front().size();
  Scale scale{Row(n, 0.0), Row(n, 0.0)};
  for (const Row& row : rows)
    for (size_t i = 0; i < n; ++i) scale.mean[i] += row[i] / double(rows.size());
  for (const Row& row : rows)
    for (size_t i = 0; i < n; ++i) scale.deviation[i] += std::pow(row[i] - scale.mean[i], 2) / double(rows.size());
  for (double& d : scale.deviation) d = std::sqrt(d) + 1e-9;
  return scale;
}

/// Scenes of the front but one.
class Scenes {
 public:
  Scenes(const MeasuredFront& front, size_t without) : front_(front), without_(without) {}
  template <class Each>
  void each(const Each& run) const {
    for (size_t k = 0; k < front_.scenes.size(); ++k)
      if (k != without_) run(front_.scenes[k]);
  }

 private:
  const MeasuredFront& front_;
  size_t without_;
};
constexpr size_t NONE_LEFT_OUT = size_t(-1);

/// How alike two scenes are: 1 where all that predictions go by is the same.
double likeness(const PictureFacts& a, const PictureFacts& b) {
  const auto logs = [](const PictureFacts& f) {
    Row row = difficulties(f);
    for (const double c : {f.triangles / 1e3 + 1.0, f.cells / 1e4 + 1.0, f.shadow_texels / 1e5 + 1.0})
      row.push_back(std::log(c));
    return row;
  };
  const Row of_a = logs(a), of_b = logs(b);
  double squares = 0.0;
  for (size_t i = 0; i < of_a.size(); ++i) squares += std::pow(of_a[i] - of_b[i], 2);
  return std::exp(-squares / (2.0 * ALIKE_WITHIN * ALIKE_WITHIN));
}

/// What measured scenes near this one differ by from their predictions, as a factor.
template <class Ratio>
double correction(const Scenes& scenes, const PictureFacts& facts, const Ratio& ratio) {
  double weights = STRANGER, logs = 0.0;
  scenes.each([&](const FrontScene& scene) {
    const std::optional<double> r = ratio(scene);
    if (!r) return;
    const double w = likeness(scene.facts, facts);
    weights += w;
    logs += w * std::log(*r);
  });
  return std::exp(logs / weights);
}

/// Sums of costs, none below nothing, right to as many per cent everywhere.
std::optional<double> time_of(const Scenes& scenes, size_t setting, PointValue size, const PictureFacts& facts) {
  std::vector<Row> rows;
  scenes.each([&](const FrontScene& scene) {
    const std::optional<double>& ms = scene.points[setting].*size;
    if (!ms || !(*ms > 0.0)) return;
    Row row = costs(scene.facts);
    for (double& c : row) c /= *ms;
    rows.push_back(std::move(row));
  });
  if (rows.size() < FEWEST_SCENES) return std::nullopt;
  constexpr double PULL = 1e-3;
  const Row x = least_squares(rows, Row(rows.size(), 1.0), PULL, true);
  const double ms = dot(x, costs(facts));
  if (!(ms > 0.0)) return std::nullopt;
  return ms * correction(scenes, facts, [&](const FrontScene& scene) -> std::optional<double> {
           const std::optional<double>& truth = scene.points[setting].*size;
           const double guess = dot(x, costs(scene.facts));
           if (!truth || !(*truth > 0.0) || !(guess > 0.0)) return std::nullopt;
           return *truth / guess;
         });
}

std::optional<double> indirect_error_of(const Scenes& scenes, size_t setting, const PictureFacts& facts) {
  std::vector<Row> rows;
  Row logs;
  scenes.each([&](const FrontScene& scene) {
    const std::optional<double>& error = scene.points[setting].indirect_error_percent;
    if (!error) return;
    rows.push_back(difficulties(scene.facts));
    logs.push_back(std::log(std::max(LEAST_ERROR, *error)));
  });
  if (rows.size() < FEWEST_SCENES) return std::nullopt;
  const Scale scale = scale_of(rows);
  for (Row& row : rows) row = scale(row);
  const double mean = std::accumulate(logs.begin(), logs.end(), 0.0) / double(logs.size());
  for (double& l : logs) l -= mean;
  constexpr double PULL = 0.2;
  const Row x = least_squares(rows, logs, PULL, false);
  const auto guess = [&](const PictureFacts& f) { return std::exp(mean + dot(x, scale(difficulties(f)))); };
  return guess(facts) * correction(scenes, facts, [&](const FrontScene& scene) -> std::optional<double> {
           const std::optional<double>& truth = scene.points[setting].indirect_error_percent;
           if (!truth) return std::nullopt;
           return std::max(LEAST_ERROR, *truth) / guess(scene.facts);
         });
}

/// What light straight from surfaces adds to the error of a picture, as a factor, where some shine; else 1.
double direct_factor(const Scenes& scenes, size_t setting) {
  double sum = 0.0;
  int count = 0;
  scenes.each([&](const FrontScene& scene) {
    const FrontPoint& p = scene.points[setting];
    if (!scene.facts.emits || !p.error_percent || !p.indirect_error_percent) return;
    const double by_share = std::max(LEAST_ERROR, *p.indirect_error_percent) * scene.facts.indirect_share;
    if (!(by_share > 0.0)) return;
    sum += std::log(std::max(LEAST_ERROR, *p.error_percent) / by_share);
    ++count;
  });
  return count > 0 ? std::max(1.0, std::exp(sum / count)) : 1.0;
}

/// As measured, or of its indirect light, whose share is known: direct light of punctual lights is right.
std::optional<double> measured_error(const FrontScene& scene, size_t setting, LightPart light) {
  const FrontPoint& p = scene.points[setting];
  if (light == LightPart::indirect || !p.indirect_error_percent) return p.indirect_error_percent;
  return p.error_percent ? *p.error_percent : *p.indirect_error_percent * scene.facts.indirect_share;
}

double at_pixels(const MeasuredFront& front, double ms, double large_ms, double pixels) {
  const double slope = std::max(0.0, (large_ms - ms) / (front.large_pixels - front.pixels));
  return std::max(ms + slope * (pixels - front.pixels), ms * std::min(1.0, pixels / front.pixels));
}

std::vector<Prediction> predict_without(const MeasuredFront& front, size_t without, const PictureFacts& facts,
                                        double pixels, LightPart light) {
  const Scenes scenes(front, without);
  std::vector<Prediction> out(front.settings.size());
  std::vector<std::optional<double>> large(out.size());
  double log_growth = 0.0;
  int grown = 0;
  for (size_t s = 0; s < out.size(); ++s) {
    out[s].ms = time_of(scenes, s, &FrontPoint::ms, facts);
    large[s] = time_of(scenes, s, &FrontPoint::large_ms, facts);
    if (out[s].ms && large[s]) {
      log_growth += std::log(*large[s] / *out[s].ms);
      ++grown;
    }
    out[s].error_percent = indirect_error_of(scenes, s, facts);
    if (out[s].error_percent && light == LightPart::full)
      *out[s].error_percent *= facts.indirect_share * (facts.emits ? direct_factor(scenes, s) : 1.0);
  }
  const double growth = std::exp(log_growth / std::max(1, grown));  // of a setting whose larger pictures nobody timed
  for (size_t s = 0; s < out.size(); ++s)
    if (out[s].ms) out[s].ms = at_pixels(front, *out[s].ms, large[s].value_or(*out[s].ms * growth), pixels);
  return out;
}

/// How predictions of scenes that were left out stand to what was measured.
struct Trust {
  double time = 1.0, error = 1.0;  // what predictions are multiplied by, for HOW_OFTEN of them to be within WITHIN
  Row time_spread, error_spread;   // of each setting: e to the root mean square of the logarithms of the ratios
};

double margin(Row ratios) {
  if (ratios.empty()) return 1.0;
  std::sort(ratios.begin(), ratios.end());
  return std::max(1.0, ratios[size_t(HOW_OFTEN * double(ratios.size() - 1))] / WITHIN);
}

double spread(const Row& ratios) {
  double squares = 0.0;
  for (const double r : ratios) squares += std::log(r) * std::log(r);
  return std::exp(std::sqrt(squares / double(std::max<size_t>(1, ratios.size()))));
}

Trust trust_of(const MeasuredFront& front, LightPart light) {
  std::vector<Row> times(front.settings.size()), errors(front.settings.size());
  for (size_t k = 0; k < front.scenes.size(); ++k) {
    const FrontScene& scene = front.scenes[k];
    const std::vector<Prediction> predicted = predict_without(front, k, scene.facts, front.pixels, light);
    for (size_t s = 0; s < front.settings.size(); ++s) {
      const auto error = measured_error(scene, s, light);
      if (predicted[s].ms && scene.points[s].ms) times[s].push_back(*scene.points[s].ms / *predicted[s].ms);
      if (predicted[s].error_percent && error)
        errors[s].push_back(std::max(LEAST_ERROR, *error) / *predicted[s].error_percent);
    }
  }
  Trust trust;
  Row all_times, all_errors;
  for (size_t s = 0; s < front.settings.size(); ++s) {
    trust.time_spread.push_back(spread(times[s]));
    trust.error_spread.push_back(spread(errors[s]));
    all_times.insert(all_times.end(), times[s].begin(), times[s].end());
    all_errors.insert(all_errors.end(), errors[s].begin(), errors[s].end());
  }
  trust.time = margin(std::move(all_times));
  trust.error = margin(std::move(all_errors));
  return trust;
}

/// The quickest of those that err as little as `best`, to what predictions can tell.
size_t quickest_alike(const Choice& choice, const Trust& trust, size_t best) {
  size_t quickest = best;
  const auto error = [&](size_t s) { return *choice.predictions[s].error_percent * trust.error_spread[s]; };
  for (size_t s = 0; s < choice.allowed.size(); ++s)
    if (choice.allowed[s] && error(s) <= ALIKE * error(best) &&
        *choice.predictions[s].ms < *choice.predictions[quickest].ms)
      quickest = s;
  return quickest;
}

std::vector<std::string> nearest_scenes(const MeasuredFront& front, const PictureFacts& facts) {
  std::vector<Row> rows;
  for (const FrontScene& scene : front.scenes) rows.push_back(difficulties(scene.facts));
  const Scale scale = scale_of(rows);
  const Row here = scale(difficulties(facts));
  std::vector<std::pair<double, std::string>> all;
  for (size_t k = 0; k < rows.size(); ++k) {
    const Row there = scale(rows[k]);
    double squares = 0.0;
    for (size_t i = 0; i < here.size(); ++i) squares += std::pow(here[i] - there[i], 2);
    all.emplace_back(squares, front.scenes[k].name);
  }
  std::sort(all.begin(), all.end());
  std::vector<std::string> names;
  for (size_t k = 0; k < std::min<size_t>(2, all.size()); ++k) names.push_back(all[k].second);
  return names;
}

}  // namespace

MeasuredFront on_device(MeasuredFront front, const DeviceFactors& factors) {
  front.device = factors.device;
  front.date = factors.date;
  for (FrontScene& scene : front.scenes)
    for (size_t s = 0; s < scene.points.size(); ++s) {
      FrontPoint& p = scene.points[s];
      if (p.ms) *p.ms *= factors.small.at(s);
      if (p.large_ms) *p.large_ms *= factors.large.at(s);
    }
  return front;
}

std::string Budget::text() const { return fmt::format("{:g}{}", amount, kind == Kind::time ? " ms" : " %"); }

Budget parse_budget(const std::string& text) {
  Budget budget;
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, budget.amount);
  const std::string unit(stop, end);
  const bool known = unit == "ms" || unit == "s" || unit == "%";
  if (error != std::errc() || !known || !std::isfinite(budget.amount) || !(budget.amount > 0.0))
    throw Error(ExitCode::usage,
                fmt::format("--budget '{}': give a time or an error above nothing, such as 50ms, 0.2s or 3%", text));
  if (unit == "s") budget.amount *= 1000.0;
  budget.kind = unit == "%" ? Budget::Kind::error : Budget::Kind::time;
  return budget;
}

std::vector<Prediction> predict(const MeasuredFront& front, const PictureFacts& facts, double pixels, LightPart light) {
  return predict_without(front, NONE_LEFT_OUT, facts, pixels, light);
}

Choice choose(const MeasuredFront& front, const PictureFacts& facts, double pixels, LightPart light,
              const Budget& budget, const std::function<bool(const FrontSetting&)>& allowed) {
  const bool by_time = budget.kind == Budget::Kind::time;
  Choice choice;
  choice.predictions = predict(front, facts, pixels, light);
  const Trust trust = trust_of(front, light);
  choice.margin = by_time ? trust.time : trust.error;
  choice.nearest = nearest_scenes(front, facts);
  // What is asked of the budget's side first, then the other side.
  std::optional<size_t> best, nearest;
  for (size_t s = 0; s < front.settings.size(); ++s) {
    const Prediction& p = choice.predictions[s];
    choice.allowed.push_back(p.ms && p.error_percent && (!allowed || allowed(front.settings[s])));
    if (!choice.allowed.back()) continue;
    const auto asked = [&](size_t k) {
      return by_time ? *choice.predictions[k].ms : *choice.predictions[k].error_percent;
    };
    const auto other = [&](size_t k) {  // what is less sure counts as more
      return by_time ? *choice.predictions[k].error_percent * trust.error_spread[k]
                     : *choice.predictions[k].ms * trust.time_spread[k];
    };
    if (!nearest || asked(s) < asked(*nearest)) nearest = s;
    if (asked(s) * choice.margin > budget.amount) continue;
    if (!best || other(s) < other(*best)) best = s;
  }
  if (!nearest) throw Error(ExitCode::usage, "--gi auto: no technique of the front goes with these options");
  choice.reached = best.has_value();
  choice.setting = by_time || !best ? quickest_alike(choice, trust, best.value_or(*nearest)) : *best;
  return choice;
}

}  // namespace volgi::screen
