#include "voxel/slice_picture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "voxel/vdb_file.h"

namespace volgi {
namespace {

using openvdb::Coord;
using openvdb::CoordBBox;

constexpr glm::vec3 kGrey(0.27f);

openvdb::FloatGrid::Ptr float_grid(const char* name) {
  openvdb::initialize();
  auto grid = openvdb::FloatGrid::create(0.0f);
  label_grid(*grid, {name, "1", ""});
  return grid;
}

openvdb::Vec3SGrid::Ptr vector_grid(const char* name, const char* unit,
                                    openvdb::VecType type = openvdb::VEC_INVARIANT) {
  openvdb::initialize();
  auto grid = openvdb::Vec3SGrid::create(openvdb::Vec3s(0.0f));
  label_grid(*grid, {name, unit, "", openvdb::GRID_UNKNOWN, type});
  return grid;
}

Image one_slice(const openvdb::GridBase& grid, SlicePlane plane) {
  return slice_picture(grid, summarise(grid), {plane});
}

/// Colour in the middle of a cell, counted from the top left of a slice of `cells` cells along its longest edge.
glm::vec3 at_cell(const Image& image, int cells, int column, int row) {
  const int scale = 512 / cells;
  return image.at(12 + column * scale + scale / 2, 12 + row * scale + scale / 2);
}

void expect_near(glm::vec3 a, glm::vec3 b, float tolerance = 1e-5f) {
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(a[c], b[c], tolerance);
}

TEST(ColorMapTest, ViridisIsTheOneKnown) {
  // matplotlib's table; the fit is within 0.02 of it.
  expect_near(viridis(0.0f), glm::vec3(68, 1, 84) / 255.0f, 0.02f);
  expect_near(viridis(0.25f), glm::vec3(59, 82, 139) / 255.0f, 0.02f);
  expect_near(viridis(0.5f), glm::vec3(33, 145, 140) / 255.0f, 0.02f);
  expect_near(viridis(0.75f), glm::vec3(94, 201, 98) / 255.0f, 0.02f);
  expect_near(viridis(1.0f), glm::vec3(253, 231, 37) / 255.0f, 0.02f);
}

TEST(ColorMapTest, DivergingIsWhiteAtZeroAndDarkensBothWays) {
  expect_near(diverging(0.0f), glm::vec3(247.0f / 255.0f));
  expect_near(diverging(-1.0f), glm::vec3(5, 48, 97) / 255.0f);
  expect_near(diverging(1.0f), glm::vec3(103, 0, 31) / 255.0f);
  expect_near(diverging(0.1f), glm::mix(glm::vec3(247, 247, 247), glm::vec3(253, 219, 199), 0.5f) / 255.0f);
}

TEST(SlicePictureTest, EveryAxisShowsItsCellsWhereTheCaptionSays) {
  // A box of 4 x 3 x 2 cells away from the origin; one marked corner: least x, greatest y, greatest z.
  auto grid = float_grid("occupancy");
  const CoordBBox box({-2, 5, 7}, {1, 7, 8});
  grid->fill(box, 0.25f);
  grid->tree().setValue({-2, 7, 8}, 1.0f);
  const glm::vec3 marked = viridis(1.0f), other = viridis(0.25f);

  const Image z = one_slice(*grid, {2, 8});  // x right, y up
  expect_near(at_cell(z, 4, 0, 0), marked);
  expect_near(at_cell(z, 4, 3, 0), other);
  expect_near(at_cell(z, 4, 0, 2), other);
  const Image y = one_slice(*grid, {1, 7});  // x right, z down
  expect_near(at_cell(y, 4, 0, 1), marked);
  expect_near(at_cell(y, 4, 0, 0), other);
  const Image x = one_slice(*grid, {0, -2});  // z right, y up
  expect_near(at_cell(x, 3, 1, 0), marked);
  expect_near(at_cell(x, 3, 0, 0), other);
  expect_near(at_cell(one_slice(*grid, {2, 7}), 4, 0, 0), other);
}

TEST(SlicePictureTest, ShowsWhichCellsHaveNoValueOrABadOne) {
  auto grid = float_grid("occupancy");
  grid->tree().setValue({0, 0, 0}, 1.0f);
  grid->tree().setValue({1, 1, 0}, NAN);
  const Image image = one_slice(*grid, {2, 0});
  expect_near(at_cell(image, 2, 0, 1), viridis(1.0f));
  expect_near(at_cell(image, 2, 1, 0), {1, 0, 1});
  expect_near(at_cell(image, 2, 0, 0), kGrey);
}

TEST(SlicePictureTest, NumbersOfBothSignsDivergeAroundZero) {
  auto grid = float_grid("difference");
  grid->tree().setValue({0, 0, 0}, -1.0f);
  grid->tree().setValue({1, 0, 0}, 4.0f);
  grid->tree().setValue({2, 0, 0}, 0.0f);
  const Image image = one_slice(*grid, {2, 0});
  expect_near(at_cell(image, 3, 0, 0), diverging(-0.25f));
  expect_near(at_cell(image, 3, 1, 0), diverging(1.0f));
  expect_near(at_cell(image, 3, 2, 0), diverging(0.0f));
}

TEST(SlicePictureTest, SignedColoursDivergeByLuminance) {
  auto grid = vector_grid("sh_10", "W m^-2 sr^-1");
  grid->tree().setValue({0, 0, 0}, {1, 1, 1});
  grid->tree().setValue({1, 0, 0}, {-0.25f, -0.25f, -0.25f});
  const Image image = one_slice(*grid, {2, 0});
  // Mean of 1 and 1/4 is 5/8, which is 0.18 of the way to the end.
  expect_near(at_cell(image, 2, 0, 0), diverging(0.288f));
  expect_near(at_cell(image, 2, 1, 0), diverging(-0.072f));
}

TEST(SlicePictureTest, SharesAreShownAsTheyAre) {
  auto grid = vector_grid("albedo", "1");
  grid->tree().setValue({0, 0, 0}, {0.63f, 0.065f, 0.05f});
  grid->tree().setValue({1, 0, 0}, {0.5f, 0.5f, 0.5f});
  const Image image = one_slice(*grid, {2, 0});
  expect_near(at_cell(image, 2, 0, 0), {srgb_encode(0.63f), srgb_encode(0.065f), srgb_encode(0.05f)});
  expect_near(at_cell(image, 2, 1, 0), glm::vec3(srgb_encode(0.5f)));
}

TEST(SlicePictureTest, RadianceIsToneMappedWhateverItsScale) {
  for (const float scale : {1e-9f, 1.0f, 1e12f}) {
    auto grid = vector_grid("fluence", "W m^-2");
    grid->tree().setValue({0, 0, 0}, openvdb::Vec3s(scale));
    grid->tree().setValue({1, 0, 0}, openvdb::Vec3s(4.0f * scale));
    grid->tree().setValue({2, 0, 0}, openvdb::Vec3s(0.0f));
    const Image image = one_slice(*grid, {2, 0});
    // Mean of 1 and 4 is 2.5, which is middle grey.
    expect_near(at_cell(image, 3, 0, 0), glm::vec3(srgb_encode(tone_map(glm::vec3(0.072f)).x)));
    expect_near(at_cell(image, 3, 1, 0), glm::vec3(srgb_encode(tone_map(glm::vec3(0.288f)).x)));
    expect_near(at_cell(image, 3, 2, 0), glm::vec3(0.0f));
  }
}

TEST(SlicePictureTest, NormalsAreColours) {
  auto grid = vector_grid("normal", "1", openvdb::VEC_COVARIANT_NORMALIZE);
  grid->tree().setValue({0, 0, 0}, {0, 1, 0});
  grid->tree().setValue({1, 0, 0}, {-1, 0, 0});
  const Image image = one_slice(*grid, {2, 0});
  expect_near(at_cell(image, 2, 0, 0), {0.5f, 1.0f, 0.5f});
  expect_near(at_cell(image, 2, 1, 0), {0.0f, 0.5f, 0.5f});
}

TEST(SlicePictureTest, ASheetShowsThreeSlicesBesideEachOther) {
  auto grid = float_grid("occupancy");
  grid->fill(CoordBBox({0, 0, 0}, {7, 7, 7}), 1.0f);
  const Image sheet = slice_picture(*grid, summarise(*grid), {{0, 3}, {1, 3}, {2, 3}});
  EXPECT_EQ(sheet.width, 3 * 384 + 4 * 12);
  for (int panel = 0; panel < 3; ++panel) expect_near(sheet.at(12 + panel * 396 + 192, 12 + 192), viridis(1.0f));
}

TEST(SlicePictureTest, DrawsTheLegendOfAnyName) {
  auto grid = float_grid("occupancy");
  grid->tree().setValue({0, 0, 0}, 0.5f);
  const auto lit = [](const Image& image) {
    return std::count(image.pixels.begin(), image.pixels.end(), glm::vec3(0.9f));
  };
  const auto plain = lit(one_slice(*grid, {2, 0}));
  EXPECT_GT(plain, 500);
  grid->setName("a\x01\xff\n%~" + std::string(5000, 'W'));
  EXPECT_GT(lit(one_slice(*grid, {2, 0})), plain);
}

TEST(SlicePictureTest, RefusesABoxThatNoPictureHolds) {
  auto grid = float_grid("occupancy");
  grid->tree().setValue({0, 0, 0}, 0.5f);
  grid->tree().setValue({2000000000, 0, 0}, 0.5f);
  grid->tree().setValue({-2000000000, 0, 0}, 0.5f);
  try {
    one_slice(*grid, {2, 0});
    FAIL();
  } catch (const Error& e) {
    EXPECT_EQ(e.code(), ExitCode::over_limit);
  }
}

}  // namespace
}  // namespace volgi
