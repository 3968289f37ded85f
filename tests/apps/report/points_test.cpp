#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "apps/report/points_file.h"
#include "core/error.h"

namespace volgi::app {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

class PointsFileTest : public ::testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder_); }
  void TearDown() override { fs::remove_all(folder_); }
  const fs::path folder_ = fs::temp_directory_path() / ("volgi_points_" + std::to_string(getpid()));
  const fs::path path_ = folder_ / "points.jsonl";
};

TEST_F(PointsFileTest, FindsWhatWasAppendedInAnEarlierRun) {
  { PointsFile(path_).append({{"key", "a"}, {"value", 0.1}}); }
  PointsFile again(path_);
  ASSERT_NE(again.find("a"), nullptr);
  EXPECT_EQ((*again.find("a"))["value"].get<double>(), 0.1);  // to the last digit
  EXPECT_EQ(again.find("b"), nullptr);
}

TEST_F(PointsFileTest, AnIncompleteLineIsNeitherReadNorContinued) {
  { PointsFile(path_).append({{"key", "a"}}); }
  std::ofstream(path_, std::ios::app) << R"({"key":"b","va)";  // killed here
  {
    PointsFile file(path_);
    EXPECT_EQ(file.points().size(), 1u);
    EXPECT_EQ(file.find("b"), nullptr);
    file.append({{"key", "c"}});
  }
  const PointsFile again(path_);
  EXPECT_NE(again.find("a"), nullptr);
  EXPECT_NE(again.find("c"), nullptr);
  EXPECT_EQ(again.points().size(), 2u);
}

TEST_F(PointsFileTest, FailedPointsAreTriedAgainAndTheLastLineOfAKeyCounts) {
  PointsFile file(path_);
  file.append({{"key", "a"}, {"error", "no"}});
  EXPECT_EQ(file.find("a"), nullptr);
  file.append({{"key", "a"}, {"value", 2}});
  ASSERT_NE(file.find("a"), nullptr);
  EXPECT_EQ(file.points().size(), 1u);
}

TEST_F(PointsFileTest, AFolderThatIsNotThereIsNamed) {
  try {
    const PointsFile file(folder_ / "nowhere" / "points.jsonl");
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::cannot_write);
    EXPECT_NE(std::string(error.what()).find("nowhere"), std::string::npos);
  }
}

}  // namespace
}  // namespace volgi::app
