#include "apps/demo/volume_viewer.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>

#include "apps/demo/document.h"
#include "core/error.h"

namespace volgi::demo {
namespace {

namespace fs = std::filesystem;
using openvdb::Coord;
using openvdb::CoordBBox;

/// A box of 4 x 5 x 6 cells from (-1, 0, 2): a colour, its spherical harmonics, and numbers of which some are negative.
class VolumeViewerTest : public ::testing::Test {
 protected:
  void SetUp() override {
    openvdb::initialize();
    const CoordBBox box(Coord(-1, 0, 2), Coord(2, 4, 7));
    openvdb::GridCPtrVec grids;
    auto distance = openvdb::FloatGrid::create(3.0f);
    distance->fill(box, 1.0f);
    distance->getAccessor().setValue(Coord(0, 1, 3), -2.0f);
    label_grid(*distance, {"distance", "m", ""});
    grids.push_back(distance);
    for (const char* name : {"fluence", "sh_00", "sh_1m1", "sh_10", "sh_11"}) {
      auto grid = openvdb::Vec3SGrid::create(openvdb::Vec3s(0.0f));
      const float value = std::string(name) == "fluence" ? 4.0f : std::string(name) == "sh_00" ? 1.0f : 0.25f;
      grid->fill(box, openvdb::Vec3s(value, 2.0f * value, 0.0f));
      label_grid(*grid, {name, "W m^-2", ""});
      grids.push_back(grid);
    }
    write_vdb(file_, grids, {});
  }
  void TearDown() override { fs::remove(file_); }

  void expect_refused(VolumeViewer& viewer, const std::string& line, const std::string& why) const {
    try {
      execute(viewer, line);
      ADD_FAILURE() << line << " is taken";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ExitCode::usage);
      EXPECT_NE(std::string(error.what()).find(why), std::string::npos) << line << ": " << error.what();
    }
  }

  const fs::path file_ = fs::temp_directory_path() / ("volgi_viewer_" + std::to_string(getpid()) + ".vdb");
};

TEST_F(VolumeViewerTest, BeginsWithFluenceInTheMiddle) {
  const VolumeViewer viewer(file_);
  EXPECT_EQ(viewer.field().name, "fluence");
  EXPECT_EQ(viewer.look().channel, "all");
  EXPECT_EQ(viewer.cell(), glm::ivec3(1, 2, 5));
  EXPECT_EQ(viewer.view(), "sheet");
  EXPECT_EQ(viewer.grids(),
            (std::vector<std::string>{"distance", "fluence", "sh_00", "sh_1m1", "sh_10", "sh_11", "radiance"}));
}

TEST_F(VolumeViewerTest, CommandsChangeWhatIsShown) {
  VolumeViewer viewer(file_);
  execute(viewer, "grid distance");
  EXPECT_EQ(viewer.look().channel, "value");
  EXPECT_EQ(viewer.look().map, VolumeMap::diverging);
  execute(viewer, "slice y=4");
  execute(viewer, "move -5,0,1");
  EXPECT_EQ(viewer.cell(), glm::ivec3(-1, 4, 6));  // as far as the box goes
  execute(viewer, "range -2,2");
  execute(viewer, "log on");
  execute(viewer, "cut");
  EXPECT_TRUE(viewer.look().logarithmic && viewer.look().cut);
  EXPECT_EQ(viewer.look().low, -2.0);
  execute(viewer, "orbit 10,200");
  EXPECT_EQ(viewer.look().yaw_deg, 50.0);
  EXPECT_EQ(viewer.look().pitch_deg, 90.0);
  execute(viewer, "zoom 2");
  execute(viewer, "frame");
  EXPECT_EQ(viewer.look().zoom, 1.0);
  execute(viewer, "view orbit");
  EXPECT_EQ(viewer.view(), "orbit");
  execute(viewer, "grid next");
  EXPECT_EQ(viewer.field().name, "fluence");
  EXPECT_EQ(viewer.cell(), glm::ivec3(-1, 4, 6));  // the box is the same
  execute(viewer, "channel next");
  EXPECT_EQ(viewer.look().channel, "luminance");
  execute(viewer, "quit");
  EXPECT_TRUE(viewer.asked_to_quit);
}

TEST_F(VolumeViewerTest, RadianceFollowsTheDirection) {
  VolumeViewer viewer(file_);
  execute(viewer, "direction 0,90");  // goes to radiance
  EXPECT_TRUE(viewer.shows_radiance());
  const auto red = [&] { return viewer.field().values[0].x; };
  const float y0 = 0.2820948f, y1 = 0.4886025f;
  EXPECT_NEAR(red(), y0 + 0.25f * y1, 1e-5f);  // towards +y
  execute(viewer, "turn-direction 0,-180");
  EXPECT_NEAR(red(), y0 - 0.25f * y1, 1e-5f);
  execute(viewer, "direction 90,0");  // +x
  EXPECT_NEAR(red(), y0 + 0.25f * y1, 1e-5f);
  execute(viewer, "direction 0,0");  // -z
  EXPECT_NEAR(red(), y0 - 0.25f * y1, 1e-5f);
}

TEST_F(VolumeViewerTest, WhatCannotBeIsRefusedByName) {
  VolumeViewer viewer(file_);
  expect_refused(viewer, "grid none", "distance, fluence");
  expect_refused(viewer, "channel x", "all, luminance, red, green, blue");
  expect_refused(viewer, "cell 9,0,2", "from -1,0,2 to 2,4,7");
  expect_refused(viewer, "cell 1.5,0,2", "whole numbers");
  expect_refused(viewer, "range 2,1", "larger");
  expect_refused(viewer, "zoom 0", "above 0");
  expect_refused(viewer, "view w", "sheet, x, y, z or orbit");
  expect_refused(viewer, "fly 3", "there are grid, channel");
  execute(viewer, "channel red");
  expect_refused(viewer, "colours colour", "channel all");
}

TEST_F(VolumeViewerTest, AFileWithoutNumbersIsRefused) {
  auto empty = openvdb::FloatGrid::create(0.0f);
  label_grid(*empty, {"nothing", "1", ""});
  write_vdb(file_, openvdb::GridCPtrVec{empty}, {});
  EXPECT_THROW(VolumeViewer{file_}, Error);
}

// Dropped on the window of a scene.
TEST_F(VolumeViewerTest, AsASceneAVolumeIsRefusedWithAHint) {
  try {
    const Document document({file_}, {});
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("a volume, not a scene"), std::string::npos) << error.what();
  }
}

// Every key has a command that is taken, and no key two.
TEST_F(VolumeViewerTest, KeysStandForCommands) {
  VolumeViewer viewer(file_);
  std::vector<Key> keys;
  for (const KeyBinding& binding : volume_key_bindings()) {
    EXPECT_NO_THROW(execute(viewer, binding.command)) << binding.command;
    const Key key = parse_key(binding.key);
    EXPECT_EQ(std::count(keys.begin(), keys.end(), key), 0) << binding.key;
    keys.push_back(key);
  }
}

TEST_F(VolumeViewerTest, ThePictureIsKeptUntilSomethingChanges) {
  VolumeViewer viewer(file_);
  const Image before = viewer.picture({64, 48});
  EXPECT_EQ(viewer.picture({64, 48}).pixels, before.pixels);
  execute(viewer, "orbit 30,0");
  EXPECT_NE(viewer.picture({64, 48}).pixels, before.pixels);
  EXPECT_EQ(viewer.picture({64, 48}, true).width, 32);
}

}  // namespace
}  // namespace volgi::demo
