#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace volgi::app {

/// A table with a heading: first row of `rows` is the head.
struct PaperTable {
  std::string title, device, note;
  std::vector<std::vector<std::string>> theirs, ours;  // `ours` has the head alone where nothing was measured
};

/// The papers' own figures (data/report/papers.json) and what this report measured of the same technique: every
/// setting of it in indirect light, one row each.
std::vector<PaperTable> paper_tables(const std::vector<nlohmann::ordered_json>& points);

}  // namespace volgi::app
