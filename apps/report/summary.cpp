#include "apps/report/summary.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "apps/report/collect.h"
#include "apps/report/html.h"
#include "apps/report/papers.h"
#include "apps/report/plot_svg.h"
#include "core/atomic_file.h"
#include "core/error.h"
#include "core/image.h"
#include "reference/error_map.h"

namespace volgi::app {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

void copy_picture(const fs::path& from, const fs::path& to) {
  std::error_code error;
  fs::copy_file(from, to, fs::copy_options::overwrite_existing, error);
  if (error) throw Error(ExitCode::cannot_write, fmt::format("cannot write {}: {}", to.string(), error.message()));
}

std::string table_row(const std::vector<std::string>& cells) {
  std::string out = "|";
  for (const std::string& cell : cells) out += " " + cell + " |";
  return out + "\n";
}

std::string table(const std::vector<std::vector<std::string>>& rows) {
  std::string out;
  for (size_t r = 0; r < rows.size(); ++r) {
    out += table_row(rows[r]);
    if (r == 0) out += table_row(std::vector<std::string>(rows[0].size(), "---"));
  }
  return out + "\n";
}

// All that was asked for; what is not there is the program's default.
std::string options_of(const Json& point) {
  return fmt::format("`{}`", fmt::join(point.at("options").get<std::vector<std::string>>(), " "));
}

// Techniques at their defaults, and what else is on the front.
std::string points_table(const Verdict& v) {
  std::vector<std::vector<std::string>> rows{
      {"technique", "options", "time [ms]", "from – to", "error [%]", "energy", ""}};
  for (size_t i = 0; i < v.judged.size(); ++i) {
    const Judged& j = v.judged[i];
    const bool on_front = std::find(v.front.begin(), v.front.end(), i) != v.front.end();
    if (!j.is_default && !on_front) continue;
    const Json& frame = j.point->at("frame_ms");
    rows.push_back({j.label, options_of(*j.point), figure(j.time_ms),
                    figure(frame["min"].get<double>()) + " – " + figure(frame["max"].get<double>()),
                    figure(j.error_percent), figure(j.point->at("metrics").at("ratio").get<double>()),
                    std::string(on_front ? "front" : "") +
                        (j.point->value("one_bounce", false) ? (on_front ? ", one bounce" : "one bounce") : "")});
  }
  return table(rows);
}

std::string pictures(const Verdict& v, const fs::path& folder, const fs::path& files, const std::string& relative) {
  const Judged* shown = v.baseline != nullptr ? v.baseline : v.front.empty() ? nullptr : &v.judged[v.front.back()];
  if (shown == nullptr || !shown->point->contains("picture")) return "";
  const std::string stem = v.scene + "-" + v.light;
  copy_picture(folder / fmt::format("pictures/{}.png", stem), files / (stem + "-reference.png"));
  copy_picture(folder / shown->point->at("picture").get<std::string>(), files / (stem + ".png"));
  copy_picture(folder / shown->point->at("error_picture").get<std::string>(), files / (stem + "-error.png"));
  const auto image = [&](const std::string& end, const std::string& alt) {
    return fmt::format("![{}]({}/{}{}.png)", alt, relative, stem, end);
  };
  return table({{"reference", shown->label, "its error"},
                {image("-reference", "reference"), image("", shown->label), image("-error", "error map")},
                {"", "", fmt::format("![scale]({}/scale.png)", relative)}});
}

std::string scene_text(const Verdict& v, const fs::path& folder, const fs::path& files, const std::string& relative) {
  const std::string plot = fmt::format("{}-{}.svg", v.scene, v.light);
  write_text_atomically(files / plot, plot_svg(v, true));
  std::string out = fmt::format("## {}, {} light\n\n", v.scene, v.light);
  for (const Sentence& s : sentences(v)) out += "- " + (s.warning ? "**" + s.text + "**" : s.text) + "\n";
  out += fmt::format("\n![error against time]({}/{})\n\n", relative, plot);
  return out + points_table(v) + pictures(v, folder, files, relative);
}

std::string papers_text(const Report& report) {
  std::string out = "## The papers' tables beside ours\n\n";
  for (const PaperTable& paper : paper_tables(report.points)) {
    out += fmt::format("### {}\n\nTheirs ({}):\n\n{}", paper.title, paper.device, table(paper.theirs));
    if (paper.ours.size() > 1) out += "Ours, indirect light:\n\n" + table(paper.ours);
    out += paper.note + "\n\n";
  }
  return out;
}

}  // namespace

void write_summary(const Report& report, const fs::path& folder, const fs::path& markdown) {
  check_writable(markdown);
  const fs::path files = markdown.parent_path() / markdown.stem();
  std::error_code error;
  fs::create_directories(files, error);
  if (error) throw Error(ExitCode::cannot_write, files.string() + ": cannot make this folder: " + error.message());
  write_png_display(files / "scale.png", error_scale(192));
  const Json& p = report.first();
  std::string text = fmt::format(
      "# Speed against error\n\nMade by `{}`. Device: {}; machine: {}; program: {}; measured until {}. {} points of "
      "{}×{} "
      "pixels, times are medians of {} frames after warm-up, from – to their range; another run's median may lie "
      "{:.0f} % "
      "outside it. Error: RMSE in percent of the reference's mean, its noise "
      "removed, region noedge. Options that a row does not name have the program's defaults (`volgi render --help`). "
      "Ratios within a table may be carried to another machine, times may not.\n\n",
      report.command, fmt::join(report.all("device"), "; "), fmt::join(report.all("machine"), "; "),
      fmt::join(report.all("program"), "; "), report.last_date(), report.points.size(), p["size"][0].get<int>(),
      p["size"][1].get<int>(), p["frames"].get<int>(), 100.0 * (kSpreadOfRuns - 1.0));
  for (const Verdict& v : report.verdicts) {
    if (v.light == "indirect") text += scene_text(v, folder, files, files.filename().string());
  }
  write_text_atomically(markdown, text + papers_text(report));
}

}  // namespace volgi::app
