// Pictures of other renderers on the report's page: `volgi report --add-picture`.
#include "apps/report/added_picture.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include "apps/report/collect.h"
#include "apps/report/export.h"
#include "apps/report/page.h"
#include "apps/report/summary.h"
#include "core/error.h"
#include "core/log.h"
#include "tests/support/gl_test.h"
#include "tests/support/paths.h"

namespace volgi::app {
namespace {

namespace fs = std::filesystem;

constexpr glm::ivec2 SIZE(24);

class AddedPictures : public test::GlTest {
 protected:
  void SetUp() override {
    GlTest::SetUp();
    set_quiet(true);
    fs::create_directories(folder_);
    scenes_.push_back(open_report_scene("cornell", test::source_dir() / "data", SIZE));
  }
  void TearDown() override {
    fs::remove_all(folder_);
    GlTest::TearDown();
  }

  /// The report's own reference times a factor, as another renderer may have made it.
  std::string file(const std::string& name, const char* light, float factor) {
    Image picture = reference_of(scenes_[0], light, false, SIZE, {"--spp", "16"}, folder_ / "references").file.color;
    for (glm::vec3& p : picture.pixels) p *= factor;
    write_exr(folder_ / name, picture);
    return (folder_ / name).string();
  }

  Report report_of(const std::vector<std::string>& texts) {
    Sweep sweep = parse_sweep(R"({"size": "24x24", "lights": ["full"], "references": "--spp 16", "techniques": [
      {"name": "none", "baseline": true, "options": "--gi none"}]})",
                              "test");
    for (const std::string& text : texts) {
      const auto settings = settings_of(parse_added_picture(text), scenes_, SIZE);
      sweep.settings.insert(sweep.settings.end(), settings.begin(), settings.end());
    }
    PointsFile points(folder_ / "points.jsonl");
    const MeasureContext measure{context(), standard_renderers(), folder_, SIZE, 1};
    return Report("volgi report (test)", collect_points(scenes_, sweep, measure, points));
  }

  const fs::path folder_ = fs::temp_directory_path() / ("volgi_added_" + std::to_string(getpid()));
  std::vector<ReportScene> scenes_;
};

const nlohmann::ordered_json& point_of(const Report& report, const std::string& technique, const std::string& light) {
  for (const auto& p : report.points) {
    if (p.at("technique") == technique && p.at("light") == light) return p;
  }
  throw std::runtime_error("no point of " + technique);
}

// The reference itself errs by nothing and is on the front of both lights at the time that it was given; 1.1 times it
// has 1.1 times the light; one without a time is judged and shown, and in no plot.
TEST_F(AddedPictures, AreJudgedLikeOurOwn) {
  file("exact-cornell-full.exr", "full", 1.0f);
  file("exact-cornell-indirect.exr", "indirect", 1.0f);
  const Report report = report_of({"theirs=" + (folder_ / "exact-{scene}-{light}.exr").string() + ":0.001",
                                   "brighter=" + file("brighter.exr", "full", 1.1f)});
  ASSERT_EQ(report.points.size(), 4u);
  for (const char* light : {"full", "indirect"}) {
    const auto& theirs = point_of(report, "theirs", light);
    EXPECT_EQ(theirs.at("metrics").at("rmse_pct").get<double>(), 0.0);
    EXPECT_EQ(theirs.at("frame_ms").at("median").get<double>(), 0.001);
    EXPECT_EQ(theirs.at("timer"), "as told");
    const Verdict& verdict = *report.verdict("cornell", light);
    ASSERT_FALSE(verdict.front.empty());
    EXPECT_EQ(verdict.judged[verdict.front[0]].label, "theirs");
  }
  const auto& brighter = point_of(report, "brighter", "full");
  EXPECT_NEAR(brighter.at("metrics").at("ratio").get<double>(), 1.1, 1e-4);
  EXPECT_FALSE(brighter.contains("frame_ms"));
  EXPECT_EQ(report.verdict("cornell", "full")->judged.size(), 2u);

  const std::string page = report_page(report, folder_);
  for (const char* technique : {"theirs", "brighter"}) {
    const std::string key = point_of(report, technique, "full")["key"];
    EXPECT_NE(page.find("<tr data-key=\"" + key), std::string::npos) << technique;
    EXPECT_NE(page.find("class=\"triple\" data-key=\"" + key), std::string::npos) << technique;
  }
  write_csv(report, folder_ / "report.csv");
  write_json(report, folder_ / "report.json");
  write_summary(report, folder_, folder_ / "summary.md");
}

// A file that has changed is another point; one that has not is measured once.
TEST_F(AddedPictures, AreKnownByWhatTheyHold) {
  const std::string text = "theirs=" + file("picture.exr", "full", 1.0f) + ":4";
  const std::string first = point_of(report_of({text}), "theirs", "full")["key"];
  EXPECT_EQ(point_of(report_of({text}), "theirs", "full")["key"], first);
  file("picture.exr", "full", 2.0f);
  const Report changed = report_of({text});
  EXPECT_NE(point_of(changed, "theirs", "full")["key"], first);
  EXPECT_NEAR(point_of(changed, "theirs", "full")["metrics"]["ratio"].get<double>(), 2.0, 1e-4);
}

TEST_F(AddedPictures, RefusesWhatItCannotPlace) {
  const auto refused = [&](const std::string& text, ExitCode code, const char* word) {
    try {
      settings_of(parse_added_picture(text), scenes_, SIZE);
      ADD_FAILURE() << text << " was taken";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), code) << text;
      EXPECT_NE(std::string(error.what()).find(word), std::string::npos) << error.what();
    }
  };
  refused("picture.exr", ExitCode::usage, "no name");
  refused("=picture.exr", ExitCode::usage, "no name");
  refused("theirs=picture.png", ExitCode::usage, "no EXR");
  refused("theirs=picture.exr:fast", ExitCode::usage, "time");
  refused("theirs=picture.exr:-1", ExitCode::usage, "time");
  refused("theirs=" + (folder_ / "nowhere.exr").string(), ExitCode::bad_input, "no such file");
  write_exr(folder_ / "small.exr", Image(8, 8));
  refused("theirs=" + (folder_ / "small.exr").string(), ExitCode::bad_input, "8 x 8");
  scenes_.push_back(open_report_scene("thin_wall", test::source_dir() / "data", SIZE));
  refused("theirs=" + (folder_ / "small.exr").string(), ExitCode::usage, "which of 2 scenes");
}

}  // namespace
}  // namespace volgi::app
