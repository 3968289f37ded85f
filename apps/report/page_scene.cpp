#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <set>

#include "apps/report/html.h"
#include "apps/report/page.h"
#include "apps/report/plot_svg.h"

namespace volgi::app {
namespace {

using Json = nlohmann::ordered_json;

struct Column {
  const char* head;
  const char* title;
  std::optional<double> (*value)(const Json& point, const Verdict& verdict);
};

std::optional<double> number(const Json& point, const char* object, const char* key) {
  if (!point.contains(object) || !point[object].contains(key) || !point[object][key].is_number()) return std::nullopt;
  return point[object][key].get<double>();
}

const Judged* judged(const Verdict& verdict, const Json& point) {
  for (const Judged& j : verdict.judged) {
    if (j.point->at("key") == point.at("key")) return &j;
  }
  return nullptr;
}

std::optional<double> times_faster(const Json& point, const Verdict& verdict) {
  const Judged* j = judged(verdict, point);
  const auto tracer = j != nullptr && !j->path_tracer ? path_tracer_time(verdict, j->error_percent) : std::nullopt;
  return tracer ? std::optional(tracer->ms / j->time_ms) : std::nullopt;
}

std::optional<double> memory_mib(const Json& point, const Verdict&) {
  if (!point.contains("memory_bytes") || !point["memory_bytes"].is_number()) return std::nullopt;
  return point["memory_bytes"].get<double>() / 1048576.0;
}

#define VOLGI_FIGURE(object, key) [](const Json& p, const Verdict&) { return number(p, object, key); }
constexpr Column kColumns[] = {
    {"time [ms]", "median of a frame", VOLGI_FIGURE("frame_ms", "median")},
    {"from", "shortest frame [ms]", VOLGI_FIGURE("frame_ms", "min")},
    {"to", "longest frame [ms]", VOLGI_FIGURE("frame_ms", "max")},
    {"error [%]", "RMSE in percent of the reference's mean, its noise removed",
     VOLGI_FIGURE("metrics", "rmse_pct_denoised")},
    {"RMSE [%]", "with the reference's noise", VOLGI_FIGURE("metrics", "rmse_pct")},
    {"relMSE", "relative mean square error", VOLGI_FIGURE("metrics", "relmse")},
    {"p95 [%]", "95th percentile of the relative error", VOLGI_FIGURE("metrics", "p95_percent")},
    {"blk [%]", "error of the means of 16 x 16 pixels", VOLGI_FIGURE("metrics", "blk_pct")},
    {"SSIM", "structural similarity, 1 is equal", VOLGI_FIGURE("metrics", "ssim")},
    {"FLIP", "what an eye tells apart, 0 to 1 (HDR-FLIP, 67 pixels a degree)", VOLGI_FIGURE("metrics", "flip")},
    {"energy", "mean over the reference's mean", VOLGI_FIGURE("metrics", "ratio")},
    {"one bounce [%]", "error against the reference of one bounce",
     VOLGI_FIGURE("one_bounce_metrics", "rmse_pct_denoised")},
    {"memory [MiB]", "of GL objects and volume", memory_mib},
    {"× faster",
     "time of the path tracer to the same error, over this time; beyond its best point extrapolated by 1/error²",
     times_faster},
};
#undef VOLGI_FIGURE

std::string passes_of(const Json& point) {
  std::string out;
  for (const Json& pass : point.value("passes", Json::array())) {
    out += fmt::format("<li>{} <b>{} ms</b></li>", escaped(pass["name"].get<std::string>()),
                       figure(pass["ms"].get<double>()));
  }
  return "<ul>" + out + "</ul>";
}

std::string trace_of(const Json& point) {
  return fmt::format(
      "<details><summary>trace</summary><code>{}</code><code>{}</code>{}<p>line <code>{}</code> of "
      "points.jsonl, {}</p></details>",
      escaped(point["command"].get<std::string>()), escaped(point["compare"].get<std::string>()), passes_of(point),
      point["key"].get<std::string>(), escaped(point["date"].get<std::string>()));
}

std::string name_of(const Json& point) {
  const std::string varied = point.value("varied", std::string());
  const auto all = point.value("options", std::vector<std::string>());
  return fmt::format("<span title=\"{}\">{}</span>", escaped(fmt::format("{}", fmt::join(all, " "))),
                     escaped(point.at("technique").get<std::string>())) +
         (varied.empty() ? "" : fmt::format(" <span class=\"option\">{}</span>", escaped(varied)));
}

std::string row(const Json& point, const Verdict& verdict, bool on_front) {
  std::string cells;
  const bool failed = point.contains("error");
  for (const Column& column : kColumns) {
    const std::optional<double> value = column.value(point, verdict);
    cells += value ? fmt::format("<td data-value=\"{}\">{}</td>", *value, figure(*value)) : "<td>–</td>";
  }
  const std::string badge =
      std::string(on_front ? " <span class=\"badge\">front</span>" : "") +
      (point.value("one_bounce", false) ? " <span class=\"badge plain\">one bounce</span>" : "") +
      (failed ? " <span class=\"badge bad\">" + escaped(point["error"].get<std::string>()) + "</span>" : "");
  return fmt::format("<tr data-key=\"{}\"{}><th scope=\"row\">{}{}</th>{}<td>{}</td></tr>\n",
                     point["key"].get<std::string>(), failed ? " class=\"failed\"" : "", name_of(point), badge, cells,
                     trace_of(point));
}

std::string table(const Report& report, const Verdict& verdict, const std::set<std::string>& front) {
  std::string head = "<th scope=\"col\">technique</th>", rows;
  for (const Column& column : kColumns)
    head += fmt::format("<th scope=\"col\" title=\"{}\">{}</th>", escaped(column.title), escaped(column.head));
  for (const Json& point : report.points) {
    if (point.at("scene") != verdict.scene || point.at("light") != verdict.light) continue;
    rows += row(point, verdict, front.contains(point["key"].get<std::string>()));
  }
  return fmt::format(
      "<div class=\"scroll\"><table class=\"sortable\"><caption>{} light: every point</caption><thead><tr>"
      "{}<th scope=\"col\">trace</th></tr></thead><tbody>{}</tbody></table></div>",
      verdict.light, head, rows);
}

std::string image(const std::filesystem::path& folder, const std::string& file, const std::string& role,
                  const std::string& alt, const std::string& radiance_file = {}) {
  const std::string uri = png_data_uri(folder / file);
  if (uri.empty()) return {};
  const std::string radiance = radiance_file.empty() ? "" : png_data_uri(folder / radiance_file);
  return fmt::format("<figure><img data-role=\"{}\"{} src=\"{}\" alt=\"{}\"><figcaption>{}</figcaption></figure>", role,
                     radiance.empty() ? "" : fmt::format(" data-radiance=\"{}\"", radiance), uri, escaped(alt),
                     escaped(alt));
}

// Result and error map of a point.
std::string triple(const Json& p, const std::string& head, double error_percent, bool baseline,
                   const std::filesystem::path& folder) {
  return fmt::format("<div class=\"triple\" data-key=\"{}\" data-exposure=\"{}\"{} data-label=\"{}\">{}{}</div>",
                     p["key"].get<std::string>(), p.value("exposure_ev", 0.0), baseline ? " data-baseline" : "",
                     escaped(label_of(p)),
                     image(folder, p["picture"], "result", head, p.value("radiance_picture", std::string())),
                     image(folder, p["error_picture"], "error", fmt::format("its error: {}", percent(error_percent))));
}

// The reference; points on the front, techniques at their defaults, and pictures whose time nobody knows.
std::string gallery(const Report& report, const Verdict& verdict, const std::set<std::string>& front,
                    const std::filesystem::path& folder) {
  std::string out = "<div class=\"triple\">" +
                    image(folder, fmt::format("pictures/{}-{}.png", verdict.scene, verdict.light), "reference",
                          "reference", fmt::format("pictures/{}-{}-radiance.png", verdict.scene, verdict.light)) +
                    "</div>";
  for (const Judged& j : verdict.judged) {
    const Json& p = *j.point;
    if (!(j.is_default || front.contains(p["key"].get<std::string>())) || !p.contains("picture")) continue;
    out += triple(p, fmt::format("{}: {} ms", j.label, figure(j.time_ms)), j.error_percent, &j == verdict.baseline,
                  folder);
  }
  for (const Json& p : report.points) {
    const bool here = p.at("scene") == verdict.scene && p.at("light") == verdict.light;
    if (!here || p.contains("frame_ms") || !p.contains("picture") || !p.contains("metrics")) continue;
    const Json& metrics = p["metrics"];
    const char* error = metrics.contains("rmse_pct_denoised") ? "rmse_pct_denoised" : "rmse_pct";
    out += triple(p, label_of(p), metrics.value(error, 0.0), false, folder);
  }
  return "<details class=\"gallery\" open><summary>Pictures</summary><div class=\"pictures\">" + out +
         "</div><p class=\"scale\"><span>−50 % too dark</span><span>0</span><span>too bright +50 "
         "%</span></p></details>";
}

std::string verdict_list(const Verdict& verdict) {
  std::string out;
  for (const Sentence& s : sentences(verdict))
    out += fmt::format("<li{}>{}</li>", s.warning ? " class=\"warning\"" : "", escaped(s.text));
  return "<ul class=\"verdict\">" + out + "</ul>";
}

std::string light_part(const Report& report, const Verdict& verdict, const std::filesystem::path& folder) {
  std::set<std::string> front;
  for (const size_t i : verdict.front) front.insert(verdict.judged[i].point->at("key").get<std::string>());
  return fmt::format(
      "<div class=\"light\" data-scene=\"{0}\" data-light=\"{1}\"><h3>{0}, {1} light</h3>{2}<figure class=\"plot\">"
      "<div class=\"canvas\" hidden><canvas tabindex=\"0\" role=\"application\" aria-label=\"Error against time of "
      "{0}, {1} "
      "light. Arrow keys go from point to point.\"></canvas></div>{3}<figcaption class=\"readout\" "
      "aria-live=\"polite\">"
      "</figcaption></figure><div class=\"viewer\" hidden></div>{4}{5}</div>\n",
      escaped(verdict.scene), verdict.light, verdict_list(verdict), plot_svg(verdict, false),
      gallery(report, verdict, front, folder), table(report, verdict, front));
}

}  // namespace

std::string scene_section(const Report& report, const std::string& scene, const std::filesystem::path& folder) {
  const auto first =
      std::find_if(report.points.begin(), report.points.end(), [&](const Json& p) { return p.at("scene") == scene; });
  std::string out = fmt::format(
      "<section class=\"scene\" id=\"scene-{0}\"><h2>{0}</h2><p>{1} triangles. Reference: <code>{2}</code></p>",
      escaped(scene), first->at("triangles").get<size_t>(), escaped(first->at("reference_command").get<std::string>()));
  for (const char* light : {"indirect", "full"}) {
    if (const Verdict* verdict = report.verdict(scene, light)) out += light_part(report, *verdict, folder);
  }
  return out + "</section>\n";
}

}  // namespace volgi::app
