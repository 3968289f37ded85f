#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <limits>

#include "apps/report/collect.h"
#include "apps/report/export.h"
#include "apps/report/page.h"
#include "apps/report/summary.h"
#include "core/error.h"
#include "core/log.h"
#include "core/sky.h"
#include "tests/support/gl_test.h"
#include "tests/support/paths.h"

namespace volgi::app {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

// Cornell at 32 x 32 with techniques that are wrong on purpose, which only this test knows.
class Measuring : public test::GlTest {
 protected:
  void SetUp() override {
    GlTest::SetUp();
    set_quiet(true);
    fs::create_directories(folder_);
  }
  void TearDown() override {
    fs::remove_all(folder_);
    GlTest::TearDown();
  }

  static Rendering changed(const RenderTask& task, void (*change)(Image&)) {
    Rendering out = standard_renderers().at("reference")(task);
    change(out.picture);
    return out;
  }

  MeasureContext measure_context() {
    MeasureContext out{context(), standard_renderers(), folder_, glm::ivec2(32), 2};
    const Renderer render = out.renderers.at("render");
    out.renderers["render"] = [this, render](const RenderTask& task) {
      ++frames_rendered_;
      return render(task);
    };
    out.renderers["black"] = [](const RenderTask& task) {
      return changed(task, [](Image& i) { i = Image(i.width, i.height); });
    };
    out.renderers["twice"] = [](const RenderTask& task) {
      return changed(task, [](Image& i) {
        for (glm::vec3& p : i.pixels) p *= 2.0f;
      });
    };
    out.renderers["nan"] = [](const RenderTask& task) {
      return changed(task, [](Image& i) { i.at(3, 4).y = std::numeric_limits<float>::quiet_NaN(); });
    };
    return out;
  }

  static Sweep sweep() {
    return parse_sweep(R"({"size": "32x32", "lights": ["indirect", "full"], "references": "--spp 64", "techniques": [
      {"name": "hybrid", "baseline": true, "options": "--gi hybrid --vpls 32 --vals 2 --grid 8"},
      {"name": "vpl", "options": "--gi vpl --vpls 32", "one_bounce": true},
      {"name": "fails", "options": "--gi volume --grid 64 --memory-limit 1K"},
      {"name": "path tracer", "command": "reference", "options": "--spp 4 --seed 2"},
      {"name": "black", "command": "black", "options": "--spp 2"},
      {"name": "twice", "command": "twice", "options": "--spp 64"},
      {"name": "nan", "command": "nan", "options": "--spp 64"}]})",
                       "test");
  }

  static std::vector<ReportScene> scenes() {
    std::vector<ReportScene> out;
    out.push_back(open_report_scene("cornell", test::source_dir() / "data", glm::ivec2(32)));
    return out;
  }

  const fs::path folder_ = fs::temp_directory_path() / ("volgi_report_" + std::to_string(getpid()));
  int frames_rendered_ = 0;
};

std::string findings_of(const Verdict& verdict, const std::string& technique) {
  for (const std::string& finding : verdict.findings) {
    if (finding.rfind(technique + ":", 0) == 0) return finding;
  }
  return "";
}

// A sky makes another scene of it: other points, no stored reference, and commands that say so.
TEST_F(Measuring, AddedLightMakesAnotherScene) {
  const fs::path data = test::source_dir() / "data";
  const ReportScene alone = open_report_scene("cornell", data, glm::ivec2(192));
  AddedLight added{" --sky 1,1,1", [](Scene& s) { s.sky = std::make_shared<Sky>(glm::vec3(1.0f)); }, {}};
  ReportScene lit = open_report_scene("cornell", data, glm::ivec2(192), added);
  EXPECT_TRUE(alone.all_bounces.has_value());
  EXPECT_FALSE(lit.all_bounces.has_value());
  EXPECT_NE(lit.hash, alone.hash);
  EXPECT_NE(lit.scene.sky, nullptr);
  added.arguments = " --sky 2,2,2";
  EXPECT_NE(open_report_scene("cornell", data, glm::ivec2(192), added).hash, lit.hash);
  const ReportReference reference = reference_of(lit, "full", false, glm::ivec2(16), {"--spp", "4"}, folder_);
  EXPECT_NE(reference.command.find(" --sky 1,1,1 -o "), std::string::npos) << reference.command;
  ReportScene dark = open_report_scene("cornell", data, glm::ivec2(16));
  const ReportReference without = reference_of(dark, "full", false, glm::ivec2(16), {"--spp", "4"}, folder_);
  double with_sky = 0.0, without_sky = 0.0;
  for (const glm::vec3& p : reference.file.color.pixels) with_sky += double(p.x);
  for (const glm::vec3& p : without.file.color.pixels) without_sky += double(p.x);
  EXPECT_GT(with_sky, 1.1 * without_sky);
}

TEST_F(Measuring, BrokenTechniquesStandOutAndFiguresStayTheSame) {
  const MeasureContext measure = measure_context();
  const Sweep asked = sweep();
  std::vector<ReportScene> opened = scenes();
  PointsFile file(folder_ / "points.jsonl");
  const Report report("volgi report (test)", collect_points(opened, asked, measure, file));
  ASSERT_EQ(report.points.size(), 14u);
  for (const char* light : {"indirect", "full"}) {
    const Verdict& v = *report.verdict("cornell", light);
    EXPECT_NE(findings_of(v, "black").find("black"), std::string::npos);
    EXPECT_NE(findings_of(v, "twice").find("2.0"), std::string::npos) << findings_of(v, "twice");
    EXPECT_NE(findings_of(v, "nan").find("1 of 1024 pixels are NaN"), std::string::npos) << findings_of(v, "nan");
    EXPECT_NE(findings_of(v, "fails").find("error"), std::string::npos);
    EXPECT_EQ(findings_of(v, "path tracer"), "");
    EXPECT_EQ(findings_of(v, "hybrid"), "");
    EXPECT_EQ(v.judged.size(), 5u);  // neither nan nor fails
    ASSERT_NE(v.baseline, nullptr);
  }

  // A second run measures only what failed.
  const int rendered = frames_rendered_;
  const std::vector<Json> again = collect_points(opened, asked, measure, file);
  EXPECT_EQ(frames_rendered_, rendered + 2);  // "fails", twice
  for (size_t i = 0; i < again.size(); ++i) EXPECT_EQ(again[i]["key"], report.points[i]["key"]);

  // The same figures to the last digit.
  const Repeated repeated = repeat_points(opened, asked, measure, file, 100);
  EXPECT_EQ(repeated.points, 10);
  EXPECT_TRUE(repeated.different.empty()) << repeated.different.front();
}

TEST_F(Measuring, EveryPointSaysWhatItIsAndTheReportHoldsItAll) {
  const MeasureContext measure = measure_context();
  std::vector<ReportScene> opened = scenes();
  PointsFile file(folder_ / "points.jsonl");
  const Report report("volgi report (test)", collect_points(opened, sweep(), measure, file));
  const std::string page = report_page(report, folder_);
  for (const Json& point : report.points) {
    const std::string key = point["key"].get<std::string>();
    for (const char* fact : {"command", "device", "machine", "program", "date", "reference_command", "scene_hash"})
      EXPECT_TRUE(point.contains(fact)) << fact;
    EXPECT_NE(page.find("data-key=\"" + key + "\""), std::string::npos);
    if (point.contains("error")) continue;
    EXPECT_TRUE(fs::is_regular_file(folder_ / point["picture"].get<std::string>()));
    EXPECT_TRUE(fs::is_regular_file(folder_ / point["error_picture"].get<std::string>()));
    EXPECT_LE(point["frame_ms"]["min"].get<double>(), point["frame_ms"]["median"].get<double>());
    EXPECT_FALSE(point["passes"].empty());
  }
  EXPECT_EQ(report.points[0]["command"].get<std::string>().rfind("volgi render ", 0), 0u);
  EXPECT_EQ(page.find("{{"), std::string::npos);  // every place of the template is filled
  write_csv(report, folder_ / "report.csv");
  write_json(report, folder_ / "report.json");
  write_summary(report, folder_, folder_ / "summary.md");
  for (const char* made :
       {"report.csv", "report.json", "summary.md", "summary/cornell-indirect.svg", "summary/scale.png"})
    EXPECT_TRUE(fs::is_regular_file(folder_ / made)) << made;
}

TEST_F(Measuring, AnotherSizeFrameCountOrSceneIsAnotherPoint) {
  const std::vector<ReportScene> opened = scenes();
  MeasureContext measure = measure_context();
  const Setting setting = sweep().settings.front();
  const std::string key = point_identity(opened[0], setting, "full", measure)["key"];
  EXPECT_EQ(key, point_identity(opened[0], setting, "full", measure)["key"]);
  EXPECT_NE(key, point_identity(opened[0], setting, "indirect", measure)["key"]);
  measure.frames = 3;
  EXPECT_NE(key, point_identity(opened[0], setting, "full", measure)["key"]);
}

TEST_F(Measuring, OptionsThatDoNotExistEndTheReport) {
  std::vector<ReportScene> opened = scenes();
  PointsFile file(folder_ / "points.jsonl");
  const Sweep wrong =
      parse_sweep(R"({"references": "--spp 2", "techniques": [{"name": "typo", "options": "--gird 3"}]})", "test");
  try {
    collect_points(opened, wrong, measure_context(), file);
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::usage);
    EXPECT_NE(std::string(error.what()).find("typo: "), std::string::npos) << error.what();
  }
}

TEST(ReportScene, ANameThatIsNeitherSceneNorFileIsRefused) {
  EXPECT_THROW(open_report_scene("nowhere", test::source_dir() / "data", glm::ivec2(32)), Error);
}

}  // namespace
}  // namespace volgi::app
