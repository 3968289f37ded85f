#include <gtest/gtest.h>

#include "apps/report/export.h"
#include "apps/report/page.h"
#include "apps/report/plot_svg.h"
#include "apps/report/verdict.h"

namespace volgi::app {
namespace {

using Json = nlohmann::ordered_json;

Json point(const std::string& technique, const std::string& varied, double time_ms, double error) {
  const std::string renderer = technique == "path tracer" ? "reference" : "render";
  return {
      {"key", technique + varied},
      {"scene", "s"},
      {"light", "indirect"},
      {"technique", technique},
      {"varied", varied},
      {"renderer", renderer},
      {"baseline", technique == "hybrid"},
      {"frame_ms", {{"min", time_ms}, {"median", time_ms}, {"max", time_ms}}},
      {"metrics",
       {{"test_mean", 1.0}, {"ratio", 1.0}, {"scale", 1.0}, {"rmse_pct", error + 1}, {"rmse_pct_denoised", error}}}};
}

std::vector<std::string> labels(const std::vector<const Judged*>& judged) {
  std::vector<std::string> out;
  out.reserve(judged.size());
  for (const Judged* j : judged) out.push_back(j->label);
  return out;
}

// The path tracer to 8 % in 1 s, to 4 % in 4 s; a front of fast, mid, hybrid.
std::vector<Json> some_points() {
  return {point("path tracer", "--spp 4", 1000, 8),
          point("path tracer", "--spp 16", 4000, 4),
          point("hybrid", "", 100, 6),
          point("hybrid", "--vals 8", 60, 5),
          point("fast", "", 10, 30),
          point("mid", "", 50, 9),
          point("slow", "", 500, 20)};
}

TEST(Verdict, TheFrontIsWhatNothingBeats) {
  const std::vector<Json> points = some_points();
  const Verdict v = judge_points(points, "s", "indirect");
  std::vector<std::string> front;
  for (const size_t i : v.front) front.push_back(v.judged[i].label);
  EXPECT_EQ(front, (std::vector<std::string>{"fast", "mid", "hybrid --vals 8", "path tracer --spp 16"}));
}

TEST(Verdict, ChoosesByErrorAndByThePathTracersTime) {
  const std::vector<Json> points = some_points();
  const Verdict v = judge_points(points, "s", "indirect");
  ASSERT_EQ(v.by_error.size(), 3u);
  EXPECT_EQ(v.by_error[0].any, nullptr);                   // 2 %
  EXPECT_EQ(v.by_error[1].any->label, "hybrid --vals 8");  // 5 %
  EXPECT_EQ(v.by_error[2].any->label, "mid");              // 10 %
  EXPECT_NEAR(path_tracer_time(v, 6.0)->ms, 1000 * (8.0 / 6) * (8.0 / 6), 1e-6);
  EXPECT_NEAR(path_tracer_time(v, 2.0)->ms, 16000, 1e-6);  // beyond its best, by 1/error²
  EXPECT_EQ(path_tracer_time(v, 50.0)->ms, 1000);          // it has no cheaper picture
  EXPECT_EQ(v.by_speedup[0].realtime->label, "hybrid --vals 8");
  EXPECT_EQ(v.by_speedup[1].realtime->label, "fast");  // 1000/10; mid is 20 times faster only
}

TEST(Verdict, SaysWhereThePathTracersTimeIsExtrapolated) {
  std::vector<Json> points = some_points();
  const auto says = [&] {
    std::string all;
    for (const Sentence& s : sentences(judge_points(points, "s", "indirect"))) all += s.text + "\n";
    return all;
  };
  EXPECT_EQ(says().find("extrapolated"), std::string::npos) << says();
  points.push_back(point("sharp", "", 20, 2));  // better than the path tracer's best, 4 %
  const Verdict v = judge_points(points, "s", "indirect");
  EXPECT_TRUE(path_tracer_time(v, 2.0)->extrapolated);
  EXPECT_FALSE(path_tracer_time(v, 4.0)->extrapolated);
  EXPECT_TRUE(v.by_speedup[1].extrapolated);
  EXPECT_NE(says().find("extrapolated by 1/error²"), std::string::npos) << says();
}

TEST(Verdict, NamesWhatBeatsTheBaselineAtItsDefaults) {
  std::vector<Json> points = some_points();
  EXPECT_TRUE(judge_points(points, "s", "indirect").beating.empty());  // another setting of hybrid is hybrid
  points.push_back(point("better", "--grid 8", 99, 5.9));
  points.push_back(point("as fast", "", 100, 1));
  const Verdict v = judge_points(points, "s", "indirect");
  EXPECT_EQ(labels(v.beating), (std::vector<std::string>{"better --grid 8"}));
  bool named = false;
  for (const Sentence& s : sentences(v)) named |= s.warning && s.text.find("better --grid 8") != std::string::npos;
  EXPECT_TRUE(named);
}

TEST(Verdict, APointWithAnErrorHasNoPlaceAnywhereButIsNamed) {
  std::vector<Json> points = some_points();
  Json broken = point("broken", "", 1, 0.1);
  broken.erase("metrics");
  broken["error"] = "3 of 9 pixels are NaN or infinite";
  points.push_back(broken);
  const Verdict v = judge_points(points, "s", "indirect");
  for (const Judged& j : v.judged) EXPECT_NE(j.label, "broken");
  ASSERT_EQ(v.findings.size(), 1u);
  EXPECT_NE(v.findings[0].find("broken: error: 3 of 9"), std::string::npos) << v.findings[0];
}

TEST(Verdict, NothingMeasuredIsSaid) {
  const std::vector<Json> points;
  const Verdict v = judge_points(points, "s", "indirect");
  EXPECT_TRUE(v.front.empty());
  EXPECT_FALSE(path_tracer_time(v, 1.0).has_value());
  EXPECT_FALSE(sentences(v).empty());
  EXPECT_EQ(plot_svg(v, true), "");
}

TEST(Verdict, TheStillPlotHasEveryPointAndItsName) {
  std::vector<Json> points = some_points();
  points.push_back(point("<b>&", "", 20, 25));
  const std::string svg = plot_svg(judge_points(points, "s", "indirect"), true);
  size_t titles = 0;
  for (size_t at = svg.find("<title>"); at != std::string::npos; at = svg.find("<title>", at + 1)) ++titles;
  EXPECT_EQ(titles, points.size() + 1);
  EXPECT_NE(svg.find("&lt;b&gt;&amp;: 20.0 ms, 25.0 %"), std::string::npos);
}

}  // namespace
}  // namespace volgi::app
