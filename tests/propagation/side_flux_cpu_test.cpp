// Light in, on the CPU: all flux is on sides that face as the samples do, or counted as lost. And irradiance out.
#include "propagation/side_flux.h"

#include <gtest/gtest.h>

#include "propagation/bounces_cpu.h"
#include "tests/propagation/cpu_rooms.h"
#include "voxel/emitter_pieces.h"
#include "voxel/voxelize_cpu.h"

namespace volgi::test {
namespace {

TEST(SideFluxCpu, SumsExactlyOnTheRightWall) {
  const VoxelGrid voxels = rooms_in_a_row(1, 8, glm::vec3(0.5f));
  std::mt19937 random(1);
  std::uniform_real_distribution<float> uniform(-0.99f, 0.99f);
  std::vector<FluxSample> samples;
  for (int i = 0; i < 50000; ++i) {
    samples.push_back({{uniform(random), -1.0f, uniform(random)}, {0, 1, 0}, glm::vec3(0.1f, 1.0f, 0.0f)});
  }
  Powers flux(voxels.side_count(), glm::vec4(0.0f));
  flux[0] = glm::vec4(1.0f);  // added to
  glm::vec3 lost(0.0f);
  deposit(voxels, samples, flux, lost);
  EXPECT_EQ(lost, glm::vec3(0.0f));
  flux[0] -= glm::vec4(1.0f);
  EXPECT_NEAR(sum(flux).x, 5000.0, 5e-3);
  EXPECT_NEAR(sum(flux).y, 50000.0, 5e-2);
  for (size_t i = 0; i < flux.size(); ++i) {
    const bool floor = voxels.sides()[i].face == 2;
    EXPECT_EQ(flux[i].y > 0.0f, floor);
    if (floor) {
      EXPECT_NEAR(flux[i].y, 50000.0f / 64.0f, 200.0f);  // evenly, to 7 sigma
    }
  }
}

// A point of no wall in reach goes to the nearest side that faces alike; where there is none around, it is lost.
TEST(SideFluxCpu, StraysAndLosses) {
  const VoxelGrid voxels = rooms_in_a_row(1, 16, glm::vec3(0.5f));
  Powers flux(voxels.side_count(), glm::vec4(0.0f));
  glm::vec3 lost(0.0f);
  const FluxSample stray{{0.1f, -0.83f, 0.1f}, glm::normalize(glm::vec3(0.3f, 1.0f, 0.1f)), glm::vec3(2.0f)};
  deposit(voxels, {{stray}}, flux, lost);
  EXPECT_EQ(lost, glm::vec3(0.0f));
  EXPECT_NEAR(sum(flux).x, 2.0, 1e-6);
  for (size_t i = 0; i < flux.size(); ++i) {
    if (flux[i].x > 0.0f) {
      EXPECT_EQ(voxels.sides()[i].face, 2);
    }
  }
  deposit(voxels, {{{glm::vec3(0.0f), {0, 1, 0}, {1.0f, 2.0f, 3.0f}}}}, flux, lost);
  EXPECT_EQ(lost, glm::vec3(1.0f, 2.0f, 3.0f));
  deposit(voxels, {{{glm::vec3(50.0f), {0, 1, 0}, glm::vec3(1.0f)}}}, flux, lost);
  EXPECT_EQ(lost, glm::vec3(2.0f, 3.0f, 4.0f));
  EXPECT_NEAR(sum(flux).x, 2.0, 1e-6);
}

// What the outside of the grid's rim reflects leaves the scene; half a cell further in, or where the surface looks in,
// it does not.
TEST(SideFluxCpu, OutsideOfTheRimIsLost) {
  const VoxelGrid voxels = rooms_in_a_row(1, 16, glm::vec3(0.5f));  // cells of 0.125
  for (int axis = 0; axis < 3; ++axis) {
    for (float sign : {-1.0f, 1.0f}) {
      glm::vec3 rim(0.1f), out(0.0f);
      rim[axis] = sign;
      out[axis] = sign;
      const glm::vec3 tilted = glm::normalize(out + glm::vec3(0.2f, -0.1f, 0.15f));
      Powers flux(voxels.side_count(), glm::vec4(0.0f));
      glm::vec3 lost(0.0f);
      const std::vector<FluxSample> outward = {
          {rim, out, glm::vec3(1.0f)}, {rim - 0.05f * out, out, glm::vec3(2.0f)}, {rim, tilted, glm::vec3(4.0f)}};
      deposit(voxels, outward, flux, lost);
      EXPECT_EQ(lost, glm::vec3(7.0f));
      deposit(voxels, {{{rim, -out, glm::vec3(8.0f)}, {rim - 0.1f * out, out, glm::vec3(16.0f)}}}, flux, lost);
      EXPECT_EQ(lost, glm::vec3(7.0f));
      EXPECT_NEAR(sum(flux).x, 24.0, 1e-5);
    }
  }
}

// A tilted surface has its staircase in the families as |n_x| : |n_y| : |n_z|.
TEST(SideFluxCpu, TiltedSurfacesSplit) {
  const glm::vec3 n = glm::normalize(glm::vec3(1.0f, 2.0f, 0.0f));
  Grid grid = unit_grid(8);
  std::vector<shared::Side> sides;
  for (int face : {0, 2}) {
    shared::Side side{};
    side.normal = n;
    side.coverage = 1.0f;
    side.area_m2 = side.face_m2 = 1.0f / 16.0f;
    side.cell = shared::cell_index(grid, {4, 4, 4});
    side.face = face;
    side.depth = face == 0 ? 3.12f : 3.81f;  // of the sample's plane, on the lines through the cell's centre
    sides.push_back(side);
  }
  const VoxelGrid voxels(grid, sides);
  Powers flux(2, glm::vec4(0.0f));
  glm::vec3 lost(0.0f);
  deposit(voxels, {{{glm::vec3(0.01f, 0.01f, 0.1f), n, glm::vec3(3.0f)}}}, flux, lost);
  EXPECT_NEAR(flux[0].x, 1.0f, 1e-5f);
  EXPECT_NEAR(flux[1].x, 2.0f, 1e-5f);
}

// A lamp thinner than a cell, one face of it through the centres of cells: its light stays outside. The inside of the
// other face looks the same way, and is where the face would be if it fell to the other side of the centres.
TEST(SideFluxCpu, ThinBodiesSendTheirLightOutwards) {
  const Grid grid = unit_grid(16);
  const float h = grid.cell_size_m;
  for (int axis = 0; axis < 3; ++axis) {
    for (float low : {-0.001f, -1e-6f, 0.0f, 1e-6f, 0.001f, 0.2f}) {
      Scene scene;
      glm::vec3 half(3.0f * h), centre(0.0f);
      half[axis] = 0.4f * h;
      centre[axis] = (0.5f + low + 0.4f) * h;  // the grid's middle is a corner of cells
      add_box_inside(scene, add_material(scene, glm::vec3(0.5f), glm::vec3(1.0f)), centre, -half);  // fronts outwards
      const VoxelGrid voxels = voxelize_cpu(scene, grid);
      Powers flux(voxels.side_count(), glm::vec4(0.0f));
      glm::vec3 lost(0.0f);
      deposit(voxels, emitter_pieces(scene, grid), flux, lost);
      EXPECT_EQ(lost, glm::vec3(0.0f));
      for (size_t i = 0; i < flux.size(); ++i) {
        if (voxels.sides()[i].front == 1) continue;
        EXPECT_EQ(flux[i].x, 0.0f) << axis << ", " << low << ": side " << i;
      }
    }
  }
}

/// E of every side is the mean over what light can reach within the 3^3 cells.
class SideIrradianceCpu : public ::testing::Test {
 protected:
  SideIrradiance after(const VoxelGrid& voxels, const SideFlux& flux, BouncesCpu& bounces) {
    BounceRules rules;
    rules.largest_albedo = 0.8f;
    bounces.run(voxels, flux, true, rules);
    return side_irradiance(voxels, flux, bounces);
  }
};

TEST_F(SideIrradianceCpu, FurnaceIsEven) {
  const VoxelGrid voxels = rooms_in_a_row(1, 6, glm::vec3(0.8f));
  SideFlux flux;
  for (const shared::Side& side : voxels.sides()) flux.emitted.emplace_back(glm::vec3(side.area_m2), 0.0f);
  flux.punctual.assign(voxels.side_count(), glm::vec4(0.0f));
  BouncesCpu bounces(std::make_unique<StepTransport>(voxels, 24));
  const SideIrradiance e = after(voxels, flux, bounces);
  for (size_t i = 0; i < voxels.side_count(); ++i) {  // B = 1 + rho E, E = B
    EXPECT_NEAR(e.direct[i].x, 1.0f, 1e-4f);
    EXPECT_NEAR(e.direct[i].x + e.indirect[i].x, 5.0f, 5.0f * BounceRules::kTolerance);
  }
}

TEST_F(SideIrradianceCpu, WallsBoundTheMean) {
  const int size = 8;
  const VoxelGrid voxels = rooms_in_a_row(2, size, glm::vec3(0.0f));
  SideFlux flux = ceiling_light(voxels, 0, glm::vec3(1.0f));
  BouncesCpu bounces(std::make_unique<StepTransport>(voxels, 24));
  const SideIrradiance e = after(voxels, flux, bounces);
  const auto reference = [&](size_t i) {
    const glm::ivec3 centre = shared::cell_coord(voxels.grid(), voxels.sides()[i].cell);
    glm::dvec2 sum(0.0);
    for (size_t s = 0; s < voxels.side_count(); ++s) {
      const glm::ivec3 cell = shared::cell_coord(voxels.grid(), voxels.sides()[s].cell);
      const bool near = glm::all(glm::lessThanEqual(glm::abs(cell - centre), glm::ivec3(1)));
      // Walls within reach all lie in one plane here but for the door's edge, which is left out.
      if (!near || voxels.sides()[s].face != voxels.sides()[i].face || cell.x / size != centre.x / size) continue;
      sum += glm::dvec2(bounces.received_indirect()[s].x, voxels.sides()[s].area_m2);
    }
    return sum.x / sum.y;
  };
  int looked_at = 0;
  for (size_t i = 0; i < voxels.side_count(); ++i) {
    const glm::ivec3 cell = shared::cell_coord(voxels.grid(), voxels.sides()[i].cell);
    if (cell.y < size / 2 + 1) continue;
    ++looked_at;
    EXPECT_NEAR(e.indirect[i].x, reference(i), 1e-5 + 1e-4 * reference(i)) << i;
  }
  EXPECT_GT(looked_at, 300);
}

// The mean comes first, then the clamp: single sides of tilted surfaces may be negative. Of three black sides in a row,
// one lights the next and by its staircase seems to get less than nothing.
TEST_F(SideIrradianceCpu, ClampsTheMeanOnly) {
  const Grid grid = unit_grid(3);
  std::vector<shared::Side> sides;
  for (int x = 0; x < 3; ++x) {
    shared::Side side{};
    side.normal = glm::normalize(glm::vec3(0.0f, 1.0f, 0.5f));
    side.coverage = 1.0f;
    side.face_m2 = 0.6f;
    side.area_m2 = side.face_m2 / shared::staircase_factor(side.normal);
    side.cell = shared::cell_index(grid, {x, 1, 1});
    side.face = 2;
    sides.push_back(side);
  }
  const VoxelGrid voxels(grid, sides);
  SideFlux flux{Powers(3, glm::vec4(0.0f)), {glm::vec4(1.0f), glm::vec4(0.0f), glm::vec4(0.0f)}};
  const float s = shared::staircase_factor(sides[0].normal), area = sides[0].area_m2;
  const float own = shared::staircase_own_share(sides[0].normal, 1);
  const float world = shared::staircase_world_share(sides[0].normal, 1);
  for (float share : {0.9f, 0.1f}) {
    BouncesCpu bounces(std::make_unique<MatrixTransport>(
        MatrixTransport::Matrix{{0, double(share), 0}, {double(share), 0, 0}, {0, 0, 0}}, voxels));
    const SideIrradiance e = after(voxels, flux, bounces);
    const float shaded = -own / (world * area), lit = share * s / (world * area);
    EXPECT_NEAR(e.indirect[0].x, std::max(0.5f * (shaded + lit), 0.0f), 1e-4f);
    EXPECT_NEAR(e.indirect[1].x, std::max((shaded + lit) / 3.0f, 0.0f), 1e-4f);
    EXPECT_NEAR(e.indirect[2].x, 0.5f * lit, 1e-4f);
    EXPECT_EQ(e.direct[0], glm::vec4(0.0f, 0.0f, 0.0f, 1.0f));
  }
}

}  // namespace
}  // namespace volgi::test
