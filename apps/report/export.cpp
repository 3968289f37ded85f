#include "apps/report/export.h"

#include <fmt/format.h>

#include <algorithm>

#include "apps/report/html.h"
#include "core/atomic_file.h"

namespace volgi::app {
namespace {

using Json = nlohmann::ordered_json;

std::string quoted(const std::string& text) {
  std::string out(1, '"');
  for (const char c : text) out.append(c == '"' ? 2 : 1, c);
  out.push_back('"');
  return out;
}

std::string number(const Json& object, const char* key) {
  return object.contains(key) && object[key].is_number() ? object[key].dump() : std::string();
}

std::string described(const Judged& j) {
  return fmt::format("{} ({} ms, {})", j.label, figure(j.time_ms), percent(j.error_percent));
}

const Judged* most_accurate(const Verdict& v) { return v.front.empty() ? nullptr : &v.judged[v.front.back()]; }

void add_choices(const Verdict& v, std::vector<Sentence>& out) {
  for (const Verdict::Choice& c : v.by_error) {
    std::string text = fmt::format("Under {:g} % error: ", c.limit);
    if (c.any == nullptr) {
      const Judged* nearest = most_accurate(v);
      text += nearest != nullptr ? "nothing reaches it; nearest is " + described(*nearest) : "nothing was measured";
    } else {
      text += described(*c.any);
      if (c.any->path_tracer && c.realtime) text += "; without the path tracer " + described(*c.realtime);
      if (c.any->path_tracer && !c.realtime) text += "; nothing but the path tracer";
    }
    out.push_back({text + "."});
  }
  const bool tracer = path_tracer_time(v, 1.0).has_value();
  for (const Verdict::Choice& c : v.by_speedup) {
    if (!tracer) continue;
    out.push_back({fmt::format("Under 1/{:g} of the path tracer's time to the same error{}: {}.", c.limit,
                               c.extrapolated ? " (extrapolated by 1/error² beyond its best point)" : "",
                               c.realtime ? described(*c.realtime) : "nothing")});
  }
}

}  // namespace

Report::Report(std::string command_line, std::vector<Json> measured)
    : command(std::move(command_line)), points(std::move(measured)) {
  for (const std::string& scene : scenes())
    for (const char* light : {"indirect", "full"}) {
      const bool any = std::any_of(points.begin(), points.end(),
                                   [&](const Json& p) { return p.at("scene") == scene && p.at("light") == light; });
      if (any) verdicts.push_back(judge_points(points, scene, light));
    }
}

std::vector<std::string> Report::scenes() const { return all("scene"); }

std::vector<std::string> Report::all(const char* key) const {
  std::vector<std::string> texts;
  for (const Json& point : points) {
    const std::string text = point.at(key).get<std::string>();
    if (std::find(texts.begin(), texts.end(), text) == texts.end()) texts.push_back(text);
  }
  return texts;
}

std::string Report::last_date() const {
  std::string last;
  for (const Json& point : points) last = std::max(last, point.at("date").get<std::string>());
  return last;
}

const Verdict* Report::verdict(const std::string& scene, const std::string& light) const {
  for (const Verdict& v : verdicts) {
    if (v.scene == scene && v.light == light) return &v;
  }
  return nullptr;
}

void write_csv(const Report& report, const std::filesystem::path& path) {
  constexpr const char* times[] = {"median", "min", "max"};
  constexpr const char* figures[] = {
      "rmse_pct_denoised", "rmse_pct", "relmse", "p95_percent", "blk_pct", "ssim", "flip", "ratio", "scale",
      "rmse_pct_scaled"};
  std::string text = "key,scene,light,technique,varied,median_ms,min_ms,max_ms,memory_bytes";
  for (const char* figure : figures) text.append(",").append(figure);
  text += ",one_bounce_rmse_pct_denoised,error,date,command\n";
  for (const Json& p : report.points) {
    const Json empty = Json::object();
    const Json frame = p.value("frame_ms", empty), metrics = p.value("metrics", empty);
    std::vector<std::string> cells{p["key"], quoted(p["scene"]), p["light"], quoted(p["technique"]),
                                   quoted(p["varied"])};
    for (const char* time : times) cells.push_back(number(frame, time));
    cells.push_back(number(p, "memory_bytes"));
    for (const char* figure : figures) cells.push_back(number(metrics, figure));
    cells.push_back(number(p.value("one_bounce_metrics", empty), "rmse_pct_denoised"));
    cells.insert(cells.end(), {quoted(p.value("error", std::string())), p["date"], quoted(p["command"])});
    text += fmt::format("{}\n", fmt::join(cells, ","));
  }
  write_text_atomically(path, text);
}

void write_json(const Report& report, const std::filesystem::path& path) {
  Json out{{"command", report.command}, {"points", report.points}, {"verdicts", Json::array()}};
  for (const Verdict& v : report.verdicts) {
    Json verdict{{"scene", v.scene},
                 {"light", v.light},
                 {"front", Json::array()},
                 {"beats_baseline", Json::array()},
                 {"says", Json::array()}};
    for (const size_t i : v.front) verdict["front"].push_back(v.judged[i].point->at("key"));
    for (const Judged* j : v.beating) verdict["beats_baseline"].push_back(j->point->at("key"));
    for (const Sentence& s : sentences(v)) verdict["says"].push_back(s.text);
    out["verdicts"].push_back(std::move(verdict));
  }
  write_text_atomically(path, out.dump(1) + "\n");
}

std::vector<Sentence> sentences(const Verdict& v) {
  std::vector<Sentence> out;
  add_choices(v, out);
  if (v.baseline != nullptr) {
    std::string text;
    for (const Judged* j : v.beating) text.append(text.empty() ? "" : ", ").append(described(*j));
    const std::string own = v.baseline->label + " at its defaults (" + figure(v.baseline->time_ms) + " ms, " +
                            percent(v.baseline->error_percent) + ")";
    out.push_back({text.empty() ? "No other technique is both faster and more accurate than " + own + "."
                                : "Both faster and more accurate than " + own + ": " + text + ".",
                   !text.empty()});
  }
  for (const std::string& finding : v.findings) out.push_back({"Stands out: " + finding + ".", true});
  return out;
}

}  // namespace volgi::app
