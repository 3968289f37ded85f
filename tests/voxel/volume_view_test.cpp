#include "voxel/volume_view.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <limits>

#include "core/error.h"
#include "voxel/slice_picture.h"
#include "voxel/vdb_file.h"

namespace volgi {
namespace {

using openvdb::Coord;
using openvdb::CoordBBox;
using Held = VolumeField::Held;
using Kind = VolumeField::Kind;

openvdb::FloatGrid::Ptr numbers(const char* unit = "1") {
  openvdb::initialize();
  auto grid = openvdb::FloatGrid::create(0.0f);
  label_grid(*grid, {"numbers", unit, ""});
  grid->setTransform(openvdb::math::Transform::createLinearTransform(0.5));
  return grid;
}

openvdb::Vec3SGrid::Ptr colours(const char* name, openvdb::VecType type = openvdb::VEC_INVARIANT) {
  openvdb::initialize();
  auto grid = openvdb::Vec3SGrid::create(openvdb::Vec3s(0.0f));
  label_grid(*grid, {name, "W m^-2", "", openvdb::GRID_UNKNOWN, type});
  return grid;
}

VolumeField field_of(const openvdb::GridBase& grid, std::uint64_t most = 1 << 20) {
  return volume_field(grid, summarise(grid), most);
}

void expect_near(glm::vec3 a, glm::vec3 b, float tolerance = 1e-5f) {
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(a[c], b[c], tolerance);
}

// Boxes of 2 x 3 x 4 cells that begin at (5, -2, 7), the value 100 x + 10 y + z from there.
openvdb::FloatGrid::Ptr counted() {
  auto grid = numbers();
  auto values = grid->getAccessor();
  for (int z = 0; z < 4; ++z)
    for (int y = 0; y < 3; ++y)
      for (int x = 0; x < 2; ++x) values.setValue(Coord(5 + x, -2 + y, 7 + z), float(100 * x + 10 * y + z));
  return grid;
}

TEST(VolumeField, HoldsTheActiveBoxCellByCell) {
  auto grid = counted();
  grid->getAccessor().setValueOff(Coord(6, 0, 10));
  grid->getAccessor().setValue(Coord(5, -1, 8), std::numeric_limits<float>::quiet_NaN());
  const VolumeField field = field_of(*grid);
  EXPECT_EQ(field.cells, glm::ivec3(2, 3, 4));
  EXPECT_EQ(field.first, Coord(5, -2, 7));
  EXPECT_EQ(field.values[field.index({1, 0, 2})].x, 102.0f);
  EXPECT_EQ(field.held[field.index({1, 2, 3})], Held::none);
  EXPECT_EQ(field.held[field.index({0, 1, 1})], Held::no_number);
  EXPECT_EQ(field.centre({1, 0, 2}), glm::dvec3(3.0, -1.0, 4.5));  // half a metre times the index
  const VolumeScalars scalars = scalars_of(field, "value");
  EXPECT_EQ(scalars.count, 22u);
  EXPECT_EQ(scalars.high, 122.0);
  EXPECT_EQ(cell_text(field, {1, 0, 2}), "cell 6, -2, 9 at 3, -1, 4.5 m: 102 1");
}

TEST(VolumeField, ABoxOfMoreCellsIsShownByMeansOfBlocks) {
  const VolumeField field = field_of(*counted(), 8);  // 2 x 3 x 4 = 24; blocks of 2^3: 1 x 2 x 2
  EXPECT_EQ(field.step, 2);
  EXPECT_EQ(field.cells, glm::ivec3(1, 2, 2));
  // x 0 and 1, y 0 and 1, z 2 and 3; then y 2 alone.
  EXPECT_FLOAT_EQ(field.values[field.index({0, 0, 1})].x, 50.0f + 5.0f + 2.5f);
  EXPECT_FLOAT_EQ(field.values[field.index({0, 1, 0})].x, 50.0f + 20.0f + 0.5f);
  EXPECT_EQ(field.centre({0, 0, 0}), glm::dvec3(2.75, -0.75, 3.75));
}

// A tile, which holds 8^3 cells in one value, counts as its cells, cut at the block and at the box.
TEST(VolumeField, TilesAreCells) {
  auto grid = numbers();
  grid->fill(CoordBBox(Coord(0), Coord(15)), 3.0f);
  grid->getAccessor().setValue(Coord(16, 0, 0), 9.0f);
  EXPECT_EQ(field_of(*grid).values[field_of(*grid).index({12, 5, 3})].x, 3.0f);
  const VolumeField field = field_of(*grid, 6 * 6 * 6);  // 17 x 16 x 16 by 3: 6 x 6 x 6
  EXPECT_EQ(field.step, 3);
  EXPECT_EQ(field.values[field.index({2, 2, 2})].x, 3.0f);
  // x 15 and 16, y 0 to 2, z 0 to 2: nine cells of 3, and one of 9.
  EXPECT_FLOAT_EQ(field.values[field.index({5, 0, 0})].x, (9 * 3.0f + 9.0f) / 10);
}

TEST(VolumeField, ChannelsAreThoseOfTheKind) {
  auto grid = colours("colour");
  grid->getAccessor().setValue(Coord(0), openvdb::Vec3s(1.0f, 2.0f, 4.0f));
  const VolumeField field = field_of(*grid);
  EXPECT_EQ(field.kind, Kind::colour);
  EXPECT_EQ(scalars_of(field, "green").values[0], 2.0f);
  EXPECT_NEAR(scalars_of(field, "all").values[0], 0.2126f + 2 * 0.7152f + 4 * 0.0722f, 1e-6f);
  try {
    scalars_of(field, "x");
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "channel x: colour has all, luminance, red, green, blue");
  }
  auto normals = colours("normals", openvdb::VEC_COVARIANT_NORMALIZE);
  normals->getAccessor().setValue(Coord(0), openvdb::Vec3s(0.0f, -1.0f, 0.0f));
  EXPECT_EQ(field_of(*normals).kind, Kind::normal);
  EXPECT_EQ(scalars_of(field_of(*normals), "y").values[0], -1.0f);
}

// Of the projection of (1 + a·d)/(4 pi), which is c_00 Y_00 + c_1m Y_1m exactly: the function itself, and 0 where it is
// below.
TEST(RadianceField, IsTheSeriesOfTheBandsTowardsADirection) {
  const glm::vec3 a(0.3f, -0.8f, 0.5f);
  const float pi = glm::pi<float>(), y0 = 0.5f / std::sqrt(pi), y1 = std::sqrt(3.0f) * y0;
  const float l1 = 1.0f / (4.0f * pi * y1);
  const glm::vec4 c(1.0f / (4.0f * pi * y0), l1 * a.y, l1 * a.z, l1 * a.x);
  std::vector<VolumeField> bands;
  for (int k = 0; k < 4; ++k) {
    auto grid = colours(kBandNames[size_t(k)]);
    grid->getAccessor().setValue(Coord(0), openvdb::Vec3s(c[k], 2.0f * c[k], 0.0f));
    bands.push_back(field_of(*grid));
  }
  for (const glm::vec3 d : {glm::vec3(0, 1, 0), glm::vec3(1, 0, 0), glm::normalize(glm::vec3(-1, 2, 3))}) {
    const float expected = std::max((1.0f + glm::dot(a, d)) / (4.0f * pi), 0.0f);
    expect_near(radiance_field(bands, d).values[0], {expected, 2.0f * expected, 0.0f}, 1e-6f);
  }
  const glm::vec3 against = -glm::normalize(a);  // |a| = 0.99: the bands make it 0.01/(4 pi); of three times a below 0
  EXPECT_GT(radiance_field(bands, against).values[0].x, 0.0f);
  for (int k = 1; k < 4; ++k) bands[size_t(k)].values[0] *= 3.0f;
  EXPECT_EQ(radiance_field(bands, against).values[0].x, 0.0f);
}

// Each band alone: 4 pi times the mean of its square over directions is 1.
TEST(RadianceField, BandsAreOrthonormal) {
  std::vector<VolumeField> bands;
  for (const char* name : kBandNames) {
    auto grid = colours(name);
    grid->getAccessor().setValue(Coord(0), openvdb::Vec3s(0.0f));
    bands.push_back(field_of(*grid));
  }
  constexpr int STEPS = 128;
  for (size_t k = 0; k < bands.size(); ++k) {
    for (VolumeField& band : bands) band.values[0] = glm::vec3(0.0f);
    bands[k].values[0] = glm::vec3(1.0f, -1.0f, 0.0f);  // what one cuts at 0 the other keeps
    double sum = 0.0;
    for (int i = 0; i < STEPS; ++i)
      for (int j = 0; j < 2 * STEPS; ++j) {
        const float z = -1.0f + 2.0f * (float(i) + 0.5f) / STEPS, phi = glm::pi<float>() * (float(j) + 0.5f) / STEPS;
        const float s = std::sqrt(1.0f - z * z);
        const glm::vec3 v = radiance_field(bands, {s * std::cos(phi), s * std::sin(phi), z}).values[0];
        sum += double((v.x + v.y) * (v.x + v.y));
      }
    // The middle rule over z errs by 2 pi h^2/24 (f'(1) - f'(-1)): 3e-4 of band 20, the steepest.
    EXPECT_NEAR(4.0 * glm::pi<double>() * sum / (2.0 * STEPS * STEPS), 1.0, 1e-3) << kBandNames[k];
  }
}

VolumeLook look_at(const VolumeField& field, VolumePart part) {
  VolumeLook look;
  suit_look(field, look);
  look.parts = {part};
  return look;
}

// Small pictures have no text; one pixel is left around a part. 42 x 42: 10 pixels a cell of 4.
TEST(VolumePicture, SlicesShowTheirCellsAsTheyStand) {
  const VolumeField field = field_of(*counted());
  VolumeLook look = look_at(field, VolumePart::z);
  look.cell = {0, 2, 1};
  const VolumeScalars scalars = scalars_of(field, "value");
  const glm::ivec2 size(42);
  const Image image = volume_picture(field, scalars, look, size);
  // 2 x 3 cells of 13 pixels in 40 x 40, in the middle: from x 1 + 7, y 1 (39 of 40 pixels); y up.
  const auto colour = [&](float v) { return viridis(v / 123.0f); };
  expect_near(image.at(8 + 6 + 13, 1 + 6), colour(100 + 20 + 1));
  expect_near(image.at(8 + 6, 1 + 6 + 26), colour(0 + 0 + 1));
  for (int axis = 0; axis < 3; ++axis) {
    look.parts = {VolumePart(axis)};
    const Image slice = volume_picture(field, scalars, look, size);
    int found = 0;
    for (int y = 0; y < size.y; ++y) {
      for (int x = 0; x < size.x; ++x) {
        const auto cell = cell_at(field, scalars, look, size, {x, y});
        if (!cell) continue;
        EXPECT_EQ((*cell)[axis], look.cell[axis]);
        const glm::vec3 seen = slice.at(x, y);
        if (glm::distance(seen, glm::vec3(1.0f, 0.75f, 0.3f)) < 1e-4f) continue;  // the chosen cell's frame
        expect_near(seen, colour(field.values[field.index(*cell)].x));
        ++found;
      }
    }
    EXPECT_GT(found, 700) << axis;
  }
}

// One cell of edge 1, seen along -z without perspective: a square of pixels p = 0.95 * 60 / sqrt(3) = 32.9.
TEST(VolumePicture, InSpaceACellIsAsLargeAsItIs) {
  auto grid = numbers();
  grid->getAccessor().setValue(Coord(3, 4, 5), 2.0f);
  const VolumeField field = field_of(*grid);
  VolumeLook look = look_at(field, VolumePart::orbit);
  look.cell = {0, 0, 0};
  look.yaw_deg = look.pitch_deg = 0.0;
  const VolumeScalars scalars = scalars_of(field, "value");
  const auto count = [&] {
    int pixels = 0;
    for (int y = 0; y < 62; ++y)
      for (int x = 0; x < 62; ++x) pixels += cell_at(field, scalars, look, {62, 62}, {x, y}).has_value();
    return pixels;
  };
  EXPECT_NEAR(count(), 32.9 * 32.9, 2 * 33);
  look.yaw_deg = 45.0;  // sqrt(2) as wide
  EXPECT_NEAR(count(), 32.9 * 32.9 * std::sqrt(2.0), 2.4 * 33);
  look.pitch_deg = 90.0;  // turned above itself: the square again
  EXPECT_NEAR(count(), 32.9 * 32.9, 4 * 33);
  look.zoom = 0.5;
  EXPECT_NEAR(count(), 32.9 * 32.9 / 4, 2 * 33);
}

TEST(VolumePicture, InSpaceTheNearestCellAboveTheRangeIsSeen) {
  auto grid = numbers();
  auto values = grid->getAccessor();
  for (int z = 0; z < 3; ++z) values.setValue(Coord(0, 0, z), float(1 + z));  // 3 is nearest to one who looks along -z
  const VolumeField field = field_of(*grid);
  VolumeLook look = look_at(field, VolumePart::orbit);
  look.yaw_deg = look.pitch_deg = 0.0;
  const VolumeScalars scalars = scalars_of(field, "value");
  const auto seen = [&] { return cell_at(field, scalars, look, {62, 62}, {31, 31}).value_or(glm::ivec3(-1)).z; };
  EXPECT_EQ(seen(), 2);
  look.yaw_deg = 180.0;
  EXPECT_EQ(seen(), 0);
  look.low = 1.5;
  EXPECT_EQ(seen(), 1);
  look.yaw_deg = 0.0;
  look.low = 3.0;
  EXPECT_EQ(seen(), -1);
  look.low = 0.0;
  look.yaw_deg = -90.0;  // from -x, along +x: y up, so +z is to the right
  EXPECT_EQ(cell_at(field, scalars, look, {62, 62}, {31 + 14, 31}).value(), glm::ivec3(0, 0, 2));
}

// Of a full cube, seen from a corner: the corner is gone, and the cell before it is the chosen one.
TEST(VolumePicture, ACutGoesAsFarAsTheChosenCell) {
  auto grid = numbers();
  grid->fill(CoordBBox(Coord(0), Coord(6)), 1.0f);
  const VolumeField field = field_of(*grid);
  VolumeLook look = look_at(field, VolumePart::orbit);
  look.yaw_deg = 45.0;
  look.pitch_deg = 35.264;  // along (1, 1, 1)
  const VolumeScalars scalars = scalars_of(field, "value");
  const auto in_the_middle = [&] { return cell_at(field, scalars, look, {63, 63}, {31, 31}).value(); };
  EXPECT_EQ(in_the_middle(), glm::ivec3(6));
  look.cut = true;
  look.cell = {3, 3, 3};
  const glm::ivec3 seen = in_the_middle();  // the pixel's middle is half a pixel beside the diagonal
  EXPECT_EQ(std::min({seen.x, seen.y, seen.z}), 3);
  EXPECT_LE(std::max({seen.x, seen.y, seen.z}), 4);
  look.cell = {6, 3, 3};  // at the end of one axis: there is nothing nearer along it
  EXPECT_EQ(in_the_middle(), glm::ivec3(6));
}

TEST(VolumePicture, FourPartsAreWhereTheyAreSaidToBe) {
  const VolumeField field = field_of(*counted());
  VolumeLook look;
  suit_look(field, look);
  const glm::ivec2 size(480, 360);
  EXPECT_EQ(part_at(look, size, {100, 60}), VolumePart::z);
  EXPECT_EQ(part_at(look, size, {380, 60}), VolumePart::x);
  EXPECT_EQ(part_at(look, size, {100, 200}), VolumePart::y);
  EXPECT_EQ(part_at(look, size, {380, 200}), VolumePart::orbit);
  EXPECT_FALSE(part_at(look, size, {240, 359}));
  const Image image = volume_picture(field, scalars_of(field, "value"), look, size);
  EXPECT_EQ(image.width, 480);
  for (const glm::vec3& p : image.pixels) EXPECT_TRUE(glm::all(glm::lessThanEqual(p, glm::vec3(1.0f))));
  EXPECT_EQ(volume_picture(field, scalars_of(field, "value"), look, {1, 1}).pixels.size(), 1u);  // and no crash
}

TEST(VolumePicture, MapsAndRanges) {
  auto grid = colours("c");
  auto values = grid->getAccessor();
  values.setValue(Coord(0, 0, 0), openvdb::Vec3s(0.25f, 0.5f, 1.0f));
  values.setValue(Coord(1, 0, 0), openvdb::Vec3s(std::numeric_limits<float>::infinity()));
  values.setValue(Coord(2, 1, 0), openvdb::Vec3s(0.0f, 0.0f, 0.0f));
  const VolumeField field = field_of(*grid);
  VolumeLook look = look_at(field, VolumePart::z);
  look.high = 1.0;
  look.cell = {2, 1, 0};
  const glm::ivec2 size(32, 22);  // 10 pixels a cell, from 1, 1; y up
  const auto at = [&](int x, int y) {
    return volume_picture(field, scalars_of(field, look.channel), look, size).at(6 + 10 * x, 16 - 10 * y);
  };
  expect_near(at(0, 0), {srgb_encode(0.25f), srgb_encode(0.5f), 1.0f});
  expect_near(at(1, 0), {1.0f, 0.0f, 1.0f});
  expect_near(at(1, 1), glm::vec3(0.27f));
  look.channel = "blue";
  look.map = VolumeMap::grey;
  look.high = 2.0;
  expect_near(at(0, 0), glm::vec3(0.5f));
  look.logarithmic = true;  // four decades below 2: log(1 / 2e-4) / log(1e4)
  expect_near(at(0, 0), glm::vec3(float(std::log(5000.0) / std::log(10000.0))), 1e-4f);
  look.map = VolumeMap::diverging;  // around 0, whatever the range
  look.low = -4.0;
  expect_near(at(0, 0), diverging(0.25f), 1e-4f);
}

}  // namespace
}  // namespace volgi
