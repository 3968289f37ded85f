#include "apps/report/page.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "apps/report/html.h"
#include "apps/report/papers.h"
#include "apps/report/texts.h"

namespace volgi::app {
namespace {

using Json = nlohmann::ordered_json;

void replace(std::string& text, const std::string& from, std::string_view to) {
  for (size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
    text.replace(at, from.size(), to);
}

std::string papers_section(const Report& report) {
  std::string out;
  for (const PaperTable& table : paper_tables(report.points)) {
    out += fmt::format(
        "<article class=\"paper\"><h3>{}</h3><div class=\"beside\"><div><h4>Theirs: {}</h4>{}</div><div><h4>Ours, "
        "{}</h4>"
        "{}</div></div><p>{}</p></article>\n",
        escaped(table.title), escaped(table.device), plain_table(table.theirs),
        escaped(fmt::format("{}", fmt::join(report.all("device"), "; "))),
        table.ours.size() > 1 ? plain_table(table.ours) : "<p>Not measured in this report.</p>", escaped(table.note));
  }
  return out;
}

std::string facts(const Report& report) {
  const Json& p = report.first();
  const auto text = [&](const char* key) { return escaped(fmt::format("{}", fmt::join(report.all(key), "; "))); };
  return fmt::format(
      "<dl class=\"facts\"><dt>device</dt><dd>{}</dd><dt>machine</dt><dd>{}</dd><dt>program</dt><dd>{}</dd>"
      "<dt>measured</dt><dd>until {}</dd><dt>points</dt><dd>{}, {}×{} pixels, median of {} frames</dd>"
      "<dt>command</dt><dd><code>{}</code></dd></dl>",
      text("device"), text("machine"), text("program"), escaped(report.last_date()), report.points.size(),
      p["size"][0].get<int>(), p["size"][1].get<int>(), p["frames"].get<int>(), escaped(report.command));
}

// A JSON text inside a script element ends at no "</".
std::string json_of(const Report& report) {
  std::string text = Json(report.points).dump();
  replace(text, "</", "<\\/");
  return text;
}

std::string contents(const Report& report) {
  std::string out;
  for (const std::string& scene : report.scenes()) {
    out += fmt::format("<li><a href=\"#scene-{0}\">{0}</a></li>", escaped(scene));
  }
  return out + "<li><a href=\"#papers\">The papers' tables</a></li>";
}

}  // namespace

std::string plain_table(const std::vector<std::vector<std::string>>& rows) {
  std::string out = "<div class=\"scroll\"><table><thead>";
  for (size_t r = 0; r < rows.size(); ++r) {
    out += r == 1 ? "</thead><tbody><tr>" : "<tr>";
    for (const std::string& cell : rows[r])
      out += fmt::format("<{0}>{1}</{0}>", r == 0 ? "th scope=\"col\"" : "td", escaped(cell));
    replace(out, "</th scope=\"col\">", "</th>");
    out += "</tr>";
  }
  return out + (rows.size() > 1 ? "</tbody>" : "</thead>") + "</table></div>";
}

std::string report_page(const Report& report, const std::filesystem::path& folder) {
  std::string scenes;
  for (const std::string& scene : report.scenes()) scenes += scene_section(report, scene, folder);
  std::string page(report_text("page.html"));
  // A text is searched for the names that are put in after it: our own texts come first.
  replace(page, "{{style}}", report_text("page.css"));
  replace(page, "{{contents}}", contents(report));
  replace(page, "{{facts}}", facts(report));
  replace(page, "{{papers}}", papers_section(report));
  replace(page, "{{page-script}}", report_text("page.js"));
  replace(page, "{{scenes}}", scenes);
  replace(page, "{{points}}", json_of(report));
  replace(page, "{{chart-script}}", report_text("chart.js"));
  return page;
}

}  // namespace volgi::app
