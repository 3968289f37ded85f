// The papers' schemes on the CPU, against closed forms and a plain pass in double precision.
#include "propagation/pulse_volume_cpu.h"

#include <gtest/gtest.h>
#include <openvdb/openvdb.h>
#include <tbb/global_control.h>

#include "tests/propagation/pulse_rooms.h"

namespace volgi::test {
namespace {

CellVolumes no_surfaces() {
  return {vdb::make_float_grid(), vdb::make_vec3s_grid(), vdb::make_vec3s_grid(), vdb::make_vec3s_grid()};
}

void occupy(CellVolumes& cells, glm::ivec3 c, float occupancy, glm::vec3 albedo, glm::vec3 normal) {
  const openvdb::Coord at(c.x, c.y, c.z);
  cells.occupancy->tree().setValueOn(at, occupancy);
  cells.albedo->tree().setValueOn(at, openvdb::Vec3s(albedo.x, albedo.y, albedo.z));
  cells.normal->tree().setValueOn(at, openvdb::Vec3s(normal.x, normal.y, normal.z));
}

SchemeOptions options_of(Scheme scheme, int order) {
  SchemeOptions options;
  options.scheme = scheme;
  options.sh_order = order;
  return options;
}

/// One side of power (1, 0.5, 0) in cell `c`, normal +x.
struct OneSide {
  VoxelGrid voxels;
  Powers flux;
  OneSide(glm::ivec3 cells, glm::ivec3 c)
      : voxels(voxels_of(small_grid(cells), 0.5f,
                         [c](glm::ivec3 cell, int face) { return cell == c && face == 0 ? 1.0f : 0.0f; })),
        flux(1, glm::vec4(1.0f, 0.5f, 0.0f, 0.0f)) {}
};

glm::dvec3 total(const RadianceVolume& radiance, int coefficient) {
  glm::dvec3 s(0.0);
  for (auto value = radiance.sh[size_t(coefficient)]->cbeginValueOn(); value; ++value)
    s += glm::dvec3((*value)[0], (*value)[1], (*value)[2]);
  return s;
}

double value_at(const RadianceVolume& radiance, int coefficient, glm::ivec3 c) {
  return double(radiance.sh[size_t(coefficient)]->tree().getValue(openvdb::Coord(c.x, c.y, c.z))[0]);
}

/// Intensity of a lobe of revolution about +x, power 1, towards cosine t, times 4 pi.
double zonal(double t, double z1, double z2, int order) {
  return 1.0 + 3.0 * z1 * t + (order == 2 ? 5.0 * z2 * (1.5 * t * t - 0.5) : 0.0);
}

/// What the radiance coefficient 00 of a cell of edge h is when its lobes carried `power`.
double radiance_of(double power, double h) { return power / std::sqrt(4.0 * M_PI) * 2.0 / (3.0 * h * h); }

class Papers : public testing::TestWithParam<int> {
 protected:
  int order() const { return GetParam(); }
};
INSTANTIATE_TEST_SUITE_P(Orders, Papers, testing::Values(1, 2));

// One pass from one lobe: the cell ahead gets the intensity towards its far face and its four side faces.
TEST_P(Papers, LpvSendsThroughFiveFaces) {
  const OneSide one({20, 20, 20}, {7, 10, 10});  // the cell ahead is in the next leaf
  const CellVolumes cells = no_surfaces();
  PulseVolumeCpu volume(one.voxels, cells, options_of(Scheme::lpv2009, order()));
  const BounceReport report = volume.run(one.flux, 1);
  EXPECT_EQ(report.passes, 1);
  EXPECT_NEAR(report.sent.x, 1.0f, 1e-6f);
  EXPECT_EQ(report.sent.z, 0.0f);
  const RadianceVolume radiance = volume.radiance();
  ASSERT_EQ(radiance.sh.size(), order() == 1 ? 4u : 9u);
  const double far_angle = 4.0 * std::asin(0.1), side_angle = M_PI / 6.0 - std::asin(0.1);
  const double side_cosine = 2.0 / std::sqrt(5.0);
  const auto intensity = [&](double t) { return std::max(zonal(t, 2.0 / 3.0, 0.25, order()), 0.0) / (4.0 * M_PI); };
  const double far = intensity(1.0) * far_angle, side = intensity(side_cosine) * side_angle;
  EXPECT_NEAR(value_at(radiance, 0, {8, 10, 10}), radiance_of(far + 4.0 * side, 0.25), 1e-5);
  // Along x only the far face's lobe counts, the sides cancel: sqrt(3) 2/3 of its power.
  EXPECT_NEAR(value_at(radiance, 3, {8, 10, 10}), 2.0 / std::sqrt(3.0) * radiance_of(far, 0.25), 1e-5);
  EXPECT_NEAR(value_at(radiance, 1, {8, 10, 10}), 0.0, 1e-6);
  EXPECT_EQ(value_at(radiance, 0, {7, 10, 10}), 0.0);  // the injected lobe does not count
  // Sideways: its far face, at a right angle to the normal, and side faces at +-x, and across.
  const double sideways = intensity(0.0) * far_angle +
                          (intensity(1.0 / std::sqrt(5.0)) + intensity(-1.0 / std::sqrt(5.0))) * side_angle +
                          2.0 * intensity(0.0) * side_angle;
  EXPECT_NEAR(value_at(radiance, 0, {7, 11, 10}), radiance_of(sideways, 0.25), 1e-5);
}

TEST_P(Papers, LpvKnowsNoWalls) {
  const OneSide one({16, 16, 16}, {4, 8, 8});
  CellVolumes cells = no_surfaces();
  PulseVolumeCpu free_volume(one.voxels, cells, options_of(Scheme::lpv2009, order()));
  free_volume.run(one.flux, 8);
  for (int y = 0; y < 16; ++y) {
    for (int z = 0; z < 16; ++z) occupy(cells, {7, y, z}, 1.0f, glm::vec3(0.5f), {-1.0f, 0.0f, 0.0f});
  }
  PulseVolumeCpu volume(one.voxels, cells, options_of(Scheme::lpv2009, order()));
  volume.run(one.flux, 8);
  EXPECT_EQ(total(volume.radiance(), 0), total(free_volume.radiance(), 0));
}

// The cone lobe of a beam: what goes on along the axis, and what bounces off a wall across it.
TEST_P(Papers, GaitatzesMirrorsOnAWall) {
  const OneSide one({20, 20, 20}, {6, 10, 10});
  const double half_angle = M_PI / 4.0, share = (1.0 - std::cos(half_angle)) / 2.0;
  const double z1 = (1.0 + std::cos(half_angle)) / 2.0, z2 = std::cos(half_angle) * z1;
  // Power that a lobe of revolution about +x, zonal a1, a2, sends through the cone around +x or -x.
  const auto through = [&](double a1, double a2, double sign) {
    return std::max(share * (1.0 + sign * 3.0 * a1 * z1 + (order() == 2 ? 5.0 * a2 * z2 : 0.0)), 0.0);
  };
  const double first = through(2.0 / 3.0, 0.25, 1.0), next = through(z1, z2, 1.0);
  for (const float side : {-1.0f, 1.0f}) {
    CellVolumes cells = no_surfaces();
    for (int y = 0; y < 20; ++y) {
      for (int z = 0; z < 20; ++z)
        occupy(cells, {8, y, z}, 0.75f, {0.6f, 0.5f, 0.4f}, glm::normalize(glm::vec3(side, 0.3f, -0.2f)));
    }
    PulseVolumeCpu volume(one.voxels, cells, options_of(Scheme::gaitatzes2010, order()));
    volume.run(one.flux, 2);
    const RadianceVolume radiance = volume.radiance();
    // Only the cell ahead, two passes on, has seen light from -x; those beside it what their neighbours sent sideways.
    const double power = 0.75 * first * next;
    const double across = radiance_of(power, 0.25) * std::sqrt(3.0) * z1;
    // A normal towards the light turns it back, and pixels read with -n: +x again. From behind it is not turned.
    EXPECT_NEAR(value_at(radiance, 3, {8, 10, 10}), side < 0.0f ? across : -across, 1e-5);
    EXPECT_NEAR(value_at(radiance, 0, {8, 10, 10}), radiance_of(power, 0.25), 1e-5);
    EXPECT_EQ(value_at(radiance, 0, {7, 10, 10}), 0.0);  // void cells accumulate nothing
  }
}

TEST_P(Papers, GaitatzesSendsBouncesOnTimesTheAlbedo) {
  const OneSide one({20, 20, 20}, {6, 10, 10});
  for (const bool constant : {false, true}) {
    CellVolumes cells = no_surfaces();
    // Two walls: light goes to the first, back, and to the second behind where it started.
    for (int y = 0; y < 20; ++y) {
      for (int z = 0; z < 20; ++z) {
        occupy(cells, {7, y, z}, 1.0f, {0.25f, 0.0f, 0.0f}, {-1.0f, 0.0f, 0.0f});
        occupy(cells, {5, y, z}, 1.0f, {0.9f, 0.0f, 0.0f}, {1.0f, 0.0f, 0.0f});
      }
    }
    SchemeOptions options = options_of(Scheme::gaitatzes2010, order());
    options.constant_albedo = constant;
    PulseVolumeCpu volume(one.voxels, cells, options);
    volume.run(one.flux, 1);
    const double straight_back = value_at(volume.radiance(), 0, {5, 10, 10});
    const double first = value_at(volume.radiance(), 0, {7, 10, 10});
    volume.run(one.flux, 3);
    const double z1 = (1.0 + std::sqrt(0.5)) / 2.0, z2 = std::sqrt(0.5) * z1, share = (1.0 - std::sqrt(0.5)) / 2.0;
    const double on = share * (1.0 + 3.0 * z1 * z1 + (order() == 2 ? 5.0 * z2 * z2 : 0.0));
    const double from_ahead = (constant ? 0.5 : 0.25) * first * on * on;
    // Other ways to that cell in three passes: along the walls, from its own first share; that part is the same for
    // all, so compare with a first wall that returns nothing.
    CellVolumes black = no_surfaces();
    for (int y = 0; y < 20; ++y) {
      for (int z = 0; z < 20; ++z) {
        occupy(black, {7, y, z}, 1.0f, glm::vec3(0.0f), {-1.0f, 0.0f, 0.0f});
        occupy(black, {5, y, z}, 1.0f, glm::vec3(constant ? 0.5f : 0.9f, 0.0f, 0.0f), {1.0f, 0.0f, 0.0f});
      }
    }
    PulseVolumeCpu without(one.voxels, black, options_of(Scheme::gaitatzes2010, order()));
    without.run(one.flux, 3);
    EXPECT_NEAR(value_at(volume.radiance(), 0, {5, 10, 10}) - value_at(without.radiance(), 0, {5, 10, 10}), from_ahead,
                2e-5);
    EXPECT_GE(straight_back, 0.0);
  }
}

// Light that leaves the grid is gone, a second run forgets the first, and threads do not matter.
TEST_P(Papers, RunsAreIndependent) {
  const VoxelGrid voxels = clutter({19, 12, 9}, 0.6f, 3);
  CellVolumes cells = no_surfaces();
  for (const shared::Side& side : voxels.sides())
    occupy(cells, shared::cell_coord(voxels.grid(), side.cell), side.coverage, side.albedo, side.normal);
  const Powers flux = random_powers(voxels.side_count(), 4);
  for (const Scheme scheme : {Scheme::lpv2009, Scheme::gaitatzes2010}) {
    PulseVolumeCpu volume(voxels, cells, options_of(scheme, order()));
    volume.run(flux, 5);
    const BounceReport again = volume.run(flux, 9);
    const tbb::global_control threads(tbb::global_control::max_allowed_parallelism, 1);
    PulseVolumeCpu fresh(voxels, cells, options_of(scheme, order()));
    const BounceReport report = fresh.run(flux, 9);
    EXPECT_EQ(again.left, report.left);
    const RadianceVolume a = volume.radiance(), b = fresh.radiance();
    for (int k = 0; k < int(a.sh.size()); ++k) EXPECT_EQ(total(a, k), total(b, k));
    for (auto value = a.sh[0]->cbeginValueOn(); value; ++value) ASSERT_GE((*value)[0], 0.0f);
    fresh.run(flux, 400);
    EXPECT_LT(fresh.run(flux, 400).left.x, 1e-3f * report.sent.x);
    EXPECT_GT(volume.bytes(), 0u);
  }
}

}  // namespace
}  // namespace volgi::test
