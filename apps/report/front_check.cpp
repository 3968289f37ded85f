#include "apps/report/front_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>

namespace volgi::app {

namespace {

using screen::Budget;
using screen::FrontPoint;
using screen::MeasuredFront;

constexpr double WITHIN = 1.3;
constexpr double LEAST_ERROR = 0.2;  // %: below, references are as wrong
constexpr double NEAREST = 1.15;     // of the best where a budget cannot be reached

bool measured(const FrontPoint& p) { return p.ms && p.indirect_error_percent; }
double side(const FrontPoint& p, Budget::Kind kind) {
  return kind == Budget::Kind::time ? *p.ms : *p.indirect_error_percent;
}

/// The least of a figure over the settings that a scene was measured with.
template <class Figure>
double least(const screen::FrontScene& scene, const Figure& figure) {
  double best = std::numeric_limits<double>::infinity();
  for (const FrontPoint& p : scene.points)
    if (measured(p)) best = std::min(best, figure(p));
  return best;
}

MeasuredFront without(const MeasuredFront& front, size_t scene) {
  MeasuredFront out = front;
  out.scenes.erase(out.scenes.begin() + std::ptrdiff_t(scene));
  return out;
}

/// The setting that is best in the geometric mean of all scenes, of those that take no longer than `ms` on the mean.
std::optional<size_t> best_fixed(const MeasuredFront& front, double ms) {
  std::optional<size_t> best;
  double best_error = 0.0;
  for (size_t s = 0; s < front.settings.size(); ++s) {
    double log_ms = 0.0, log_error = 0.0;
    int count = 0;
    for (const screen::FrontScene& scene : front.scenes) {
      const FrontPoint& p = scene.points[s];
      if (!measured(p)) continue;
      log_ms += std::log(*p.ms);
      log_error += std::log(std::max(LEAST_ERROR, *p.indirect_error_percent));
      ++count;
    }
    if (count == 0 || std::exp(log_ms / count) > ms) continue;
    if (!best || log_error / count < best_error) {
      best = s;
      best_error = log_error / count;
    }
  }
  return best;
}

FrontCheck check(const MeasuredFront& front, size_t left_out, const Budget& budget) {
  const screen::FrontScene& scene = front.scenes[left_out];
  const auto allowed = [&](const screen::FrontSetting& setting) {  // what was measured, so that it can be judged
    for (size_t s = 0; s < front.settings.size(); ++s)
      if (front.settings[s].name == setting.name) return measured(scene.points[s]);
    return false;
  };
  const screen::Choice choice =
      screen::choose(without(front, left_out), scene.facts, front.pixels, screen::LightPart::indirect, budget, allowed);
  const FrontPoint& p = scene.points[choice.setting];
  FrontCheck out{scene.name, front.settings[choice.setting].name, budget};
  out.reachable = least(scene, [&](const FrontPoint& q) { return side(q, budget.kind); }) <= budget.amount;
  out.said_so = choice.reached == out.reachable;
  out.ms = *p.ms;
  out.error_percent = *p.indirect_error_percent;
  out.times_budget = side(p, budget.kind) / budget.amount;
  const double error = std::max(LEAST_ERROR, out.error_percent);
  out.times_best = error / least(scene, [&](const FrontPoint& q) {
                     return *q.ms <= *p.ms ? std::max(LEAST_ERROR, *q.indirect_error_percent)
                                           : std::numeric_limits<double>::infinity();
                   });
  const std::optional<size_t> fixed = best_fixed(front, out.ms);
  if (fixed && measured(scene.points[*fixed]) && *scene.points[*fixed].ms <= out.ms)
    out.times_fixed = error / std::max(LEAST_ERROR, *scene.points[*fixed].indirect_error_percent);
  return out;
}

}  // namespace

std::vector<FrontCheck> leave_one_out(const MeasuredFront& front, const std::vector<Budget>& budgets) {
  std::vector<FrontCheck> checks;
  for (const Budget& budget : budgets)
    for (size_t k = 0; k < front.scenes.size(); ++k) {
      const auto& points = front.scenes[k].points;
      if (std::any_of(points.begin(), points.end(), measured)) checks.push_back(check(front, k, budget));
    }
  return checks;
}

bool keeps_budget(const FrontCheck& check) {
  if (check.reachable) return check.times_budget <= WITHIN;
  return check.times_budget <= WITHIN || (check.said_so && check.times_best <= NEAREST);
}

std::vector<Budget> usual_budgets() {
  std::vector<Budget> budgets;
  for (const double ms : {50.0, 75.0, 100.0, 150.0, 200.0, 300.0, 500.0, 1000.0, 2000.0})
    budgets.push_back({Budget::Kind::time, ms});
  for (const double percent : {2.0, 3.0, 5.0, 7.0, 10.0, 20.0}) budgets.push_back({Budget::Kind::error, percent});
  return budgets;
}

std::string check_table(const std::vector<FrontCheck>& checks) {
  std::vector<std::string> order;
  std::map<std::string, std::vector<const FrontCheck*>> by_budget;
  for (const FrontCheck& c : checks) {
    if (!by_budget.contains(c.budget.text())) order.push_back(c.budget.text());
    by_budget[c.budget.text()].push_back(&c);
  }
  std::string text =
      "| budget | scenes | can be reached | kept within 1.3 | largest | error over the best of the same time, largest "
      "| "
      "over the best fixed setting, largest | misses |\n| --- | --- | --- | --- | --- | --- | --- | --- |\n";
  for (const std::string& budget : order) {
    int reachable = 0, kept = 0;
    double largest = 0.0, best = 0.0, fixed = 0.0;
    std::string misses;
    for (const FrontCheck* c : by_budget[budget]) {
      reachable += c->reachable;
      kept += keeps_budget(*c);
      if (c->reachable) largest = std::max(largest, c->times_budget);
      best = std::max(best, c->times_best);
      fixed = std::max(fixed, c->times_fixed);
      if (!keeps_budget(*c) || c->times_best > 1.15)
        misses += fmt::format("{}{}: {} ({:.0f} ms, {:.1f} %; {:.2f}, {:.2f})", misses.empty() ? "" : "; ", c->scene,
                              c->chosen, c->ms, c->error_percent, c->times_budget, c->times_best);
    }
    text += fmt::format("| {} | {} | {} | {} | {:.2f} | {:.2f} | {:.2f} | {} |\n", budget, by_budget[budget].size(),
                        reachable, kept, largest, best, fixed, misses);
  }
  return text;
}

}  // namespace volgi::app
