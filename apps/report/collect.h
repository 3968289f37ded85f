#pragma once
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "apps/report/measure.h"
#include "apps/report/points_file.h"
#include "apps/report/report_scene.h"
#include "apps/report/sweep.h"

namespace volgi::app {

/// Measures every setting of the sweep on every scene and light, with a progress bar; points that `file` has are not
/// measured again. Writes the pictures of points and references below context.folder. Whoever measures the same sweep
/// into the same folder at that time shares the work (core/claims.h, in context.folder/claims): each point is measured
/// by one, and all return when there are no more.
/// @return the points, by scene, setting and light as the sweep lists them.
/// @throws Error(usage) for a setting that cannot be; Error as reference_of and PointsFile::append do.
std::vector<nlohmann::ordered_json> collect_points(std::vector<ReportScene>& scenes, const Sweep& sweep,
                                                   const MeasureContext& context, PointsFile& file);

/// How far another run's median may lie outside the frames of the first, as a factor: runs differ more than frames of a
/// run (12 points measured again on two shared cores: 0.89 to 1.22 of the first).
constexpr double kSpreadOfRuns = 1.25;

/// What measuring finished points again gave.
struct Repeated {
  int points = 0;
  int in_spread = 0;                   // whose median lies in the frames' range, widened by kSpreadOfRuns either way
  std::vector<double> times_as_long;   // median over the median stated, of each
  std::vector<std::string> different;  // whose figures are not the same to the last digit, and how
};

/// Measures `count` of the sweep's points again, evenly spaced, without storing them.
Repeated repeat_points(std::vector<ReportScene>& scenes, const Sweep& sweep, const MeasureContext& context,
                       const PointsFile& file, int count);

}  // namespace volgi::app
