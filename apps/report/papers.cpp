#include "apps/report/papers.h"

#include <fmt/format.h>

#include "apps/report/html.h"
#include "apps/report/texts.h"
#include "apps/report/verdict.h"

namespace volgi::app {
namespace {

using Json = nlohmann::ordered_json;
using Row = std::vector<std::string>;

std::string cell(const Json& value) {
  return value.is_string() ? value.get<std::string>() : fmt::format("{}", value.get<double>());
}

double sum_of_passes(const Json& point, const Json& beginnings) {
  double sum = 0;
  for (const Json& pass : point.at("passes")) {
    for (const Json& beginning : beginnings) {
      if (pass.at("name").get<std::string>().rfind(beginning.get<std::string>(), 0) == 0)
        sum += pass.at("ms").get<double>();
    }
  }
  return sum;
}

std::vector<Row> rows_of(const Json& ours, const std::vector<Json>& points) {
  std::vector<Row> rows{{"scene", "triangles", "setting", "frames/s", "frame [ms]"}};
  for (const auto& [column, beginnings] : ours.at("passes").items()) rows.front().push_back(column);
  for (const Json& point : points) {
    if (point.at("technique") != ours.at("technique") || point.at("light") != "indirect" || !point.contains("frame_ms"))
      continue;
    const double frame_ms = point.at("frame_ms").at("median").get<double>();
    Row row{point.at("scene").get<std::string>(), fmt::format("{}", point.at("triangles").get<size_t>()),
            label_of(point), figure(1000.0 / frame_ms), figure(frame_ms)};
    for (const auto& [column, beginnings] : ours.at("passes").items())
      row.push_back(figure(sum_of_passes(point, beginnings)));
    rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace

std::vector<PaperTable> paper_tables(const std::vector<Json>& points) {
  std::vector<PaperTable> tables;
  for (const Json& paper : Json::parse(report_text("papers.json"))) {
    PaperTable table{paper.at("paper"), paper.at("device"), paper.at("note"), {}, {}};
    table.theirs.push_back(paper.at("columns").get<Row>());
    for (const Json& row : paper.at("rows")) {
      Row& cells = table.theirs.emplace_back();
      for (const Json& value : row) cells.push_back(cell(value));
    }
    table.ours = rows_of(paper.at("ours"), points);
    tables.push_back(std::move(table));
  }
  return tables;
}

}  // namespace volgi::app
