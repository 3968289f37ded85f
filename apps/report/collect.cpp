#include "apps/report/collect.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>

#include "apps/report/added_picture.h"
#include "core/claims.h"
#include "core/progress.h"

namespace volgi::app {
namespace {

using Json = nlohmann::ordered_json;

struct Task {
  ReportScene* scene;
  const Setting* setting;
  std::string light;
  std::string key;
};

std::vector<Task> tasks_of(std::vector<ReportScene>& scenes, const Sweep& sweep, const MeasureContext& context) {
  std::vector<Task> tasks;
  for (ReportScene& scene : scenes)
    for (const Setting& setting : sweep.settings)
      for (const std::string& light : setting.lights) {
        const auto& only = setting.scenes;
        if (!only.empty() && std::find(only.begin(), only.end(), scene.name) == only.end()) continue;
        const Json identity = point_identity(scene, setting, light, context);
        tasks.push_back({&scene, &setting, light, identity.at("key").get<std::string>()});
      }
  return tasks;
}

// Of the scene at hand; read when first asked for.
class References {
 public:
  References(const Sweep& sweep, const MeasureContext& context, Claims& claims)
      : sweep_(sweep), context_(context), claims_(claims) {}

  const ReportReference& all_bounces(ReportScene& scene, const std::string& light) { return get(scene, light, false); }
  const ReportReference* one_bounce(ReportScene& scene, const std::string& light, const Setting& setting) {
    return setting.one_bounce && scene.one_bounce ? &get(scene, light, true) : nullptr;
  }

 private:
  const ReportReference& get(ReportScene& scene, const std::string& light, bool one_bounce) {
    if (scene_ != &scene) read_.clear();
    scene_ = &scene;
    const auto [at, is_new] = read_.try_emplace(light + (one_bounce ? "1" : ""));
    if (is_new) {
      // Traced by one, read by all.
      std::optional<Claims::Claim> claim;
      if (!one_bounce && !scene.all_bounces) claim.emplace(claims_.wait_for("reference-" + scene.hash));
      at->second =
          reference_of(scene, light, one_bounce, context_.size, sweep_.references, context_.folder / "references");
      if (!one_bounce) write_reference_picture(scene, light, at->second, context_.folder);
    }
    return at->second;
  }

  const Sweep& sweep_;
  const MeasureContext& context_;
  Claims& claims_;
  const ReportScene* scene_ = nullptr;
  std::map<std::string, ReportReference> read_;
};

Json measure(const Task& task, References& references, const MeasureContext& context) {
  const ReportReference& all = references.all_bounces(*task.scene, task.light);
  const ReportReference* one = references.one_bounce(*task.scene, task.light, *task.setting);
  return measure_point(*task.scene, *task.setting, task.light, all, one, context);
}

}  // namespace

std::vector<Json> collect_points(std::vector<ReportScene>& scenes, const Sweep& sweep, const MeasureContext& context,
                                 PointsFile& file) {
  for (const Setting& setting : sweep.settings) check_setting(setting, context);
  const std::vector<Task> tasks = tasks_of(scenes, sweep, context);
  Claims claims(context.folder / "claims");
  file.refresh();
  const size_t before = file.lines();
  // A point that failed is tried again by the next report, not by everybody who takes part in this one.
  const auto is_done = [&](int k) {
    file.refresh();
    const std::string& key = tasks[size_t(k)].key;
    return file.find(key) != nullptr || file.find_after(before, key) != nullptr;
  };
  const auto to_do = std::count_if(tasks.begin(), tasks.end(), [&](const Task& t) { return !file.find(t.key); });
  Progress progress("report", std::uint64_t(to_do));
  References references(sweep, context, claims);
  claims.work(
      int(tasks.size()), [&](int k) { return tasks[size_t(k)].key; }, is_done,
      [&](int k) {
        file.append(measure(tasks[size_t(k)], references, context));
        progress.advance();
      });
  std::vector<Json> points;
  for (const Task& task : tasks) points.push_back(*file.find_after(0, task.key));
  return points;
}

Repeated repeat_points(std::vector<ReportScene>& scenes, const Sweep& sweep, const MeasureContext& context,
                       const PointsFile& file, int count) {
  std::vector<Task> tasks = tasks_of(scenes, sweep, context);
  std::erase_if(tasks, [&](const Task& task) {
    return task.setting->renderer == ADDED_PICTURE || file.find(task.key) == nullptr;
  });
  const size_t wanted = std::min(tasks.size(), size_t(std::max(count, 0)));
  Progress progress("repeat", wanted);
  Claims claims(context.folder / "claims");
  References references(sweep, context, claims);
  Repeated out;
  for (size_t i = 0; i < wanted; ++i) {
    const Task& task = tasks[i * tasks.size() / wanted];
    const Json before = *file.find(task.key), again = measure(task, references, context);
    const double median_ms = again.contains("frame_ms") ? again["frame_ms"]["median"].get<double>() : -1.0;
    const Json& spread = before.at("frame_ms");
    ++out.points;
    out.times_as_long.push_back(median_ms / spread["median"].get<double>());
    out.in_spread += median_ms * kSpreadOfRuns >= spread["min"].get<double>() &&
                     median_ms <= spread["max"].get<double>() * kSpreadOfRuns;
    for (const char* figures : {"metrics", "one_bounce_metrics"}) {
      const Json was = before.value(figures, Json()), is = again.value(figures, Json());
      if (was != is)
        out.different.push_back(
            fmt::format("{}: {} was {}, is {}", before["command"].get<std::string>(), figures, was.dump(), is.dump()));
    }
    progress.advance();
  }
  return out;
}

}  // namespace volgi::app
