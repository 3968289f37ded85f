#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "apps/report/verdict.h"

namespace volgi::app {

/// A report ready to be written: its points and what they come to.
struct Report {
  std::string command;  // that made it
  std::vector<nlohmann::ordered_json> points;
  std::vector<Verdict> verdicts;  // by scene, then light: they point into `points`

  Report(std::string command, std::vector<nlohmann::ordered_json> points);
  std::vector<std::string> scenes() const;  // in the order of the points
  const nlohmann::ordered_json& first() const { return points.front(); }
  /// What the points say under a key, each text once: device, machine or program. One, unless lines of several were
  /// kept.
  std::vector<std::string> all(const char* key) const;
  std::string last_date() const;
  const Verdict* verdict(const std::string& scene, const std::string& light) const;
};

/// report.csv: a line a point, the figures that tables show. report.json: the points whole, and the verdicts.
void write_csv(const Report& report, const std::filesystem::path& path);
void write_json(const Report& report, const std::filesystem::path& path);

/// What a verdict says in words, a sentence an entry: what to choose, what beats the baseline, what stands out.
struct Sentence {
  std::string text;
  bool warning = false;
};
std::vector<Sentence> sentences(const Verdict& verdict);

}  // namespace volgi::app
