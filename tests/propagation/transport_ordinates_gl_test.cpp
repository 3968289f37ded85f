// One transport order of the `ordinates` scheme: conserves, never negative, reciprocal, linear, and what a sweep in
// double precision says.
#include "propagation/transport_ordinates_gl.h"

#include <gtest/gtest.h>

#include "tests/propagation/double_sweep.h"
#include "tests/propagation/transport_scene.h"

namespace volgi::test {
namespace {

struct SetAndRule {
  int directions;
  Ordinates rule;
};

void expect_received(const Powers& received, const SweepResult& expected) {
  double largest = 0.0, worst = 0.0;
  for (size_t i = 0; i < received.size(); ++i) {
    for (int band = 0; band < 3; ++band) {
      largest = std::max(largest, expected.received[i][band]);
      worst = std::max(worst, std::abs(double(received[i][band]) - expected.received[i][band]));
    }
  }
  EXPECT_LT(worst, 2e-6 * largest);
}

class OrdinatesGl : public GlTest, public testing::WithParamInterface<SetAndRule> {
 protected:
  void SetUp() override {
    GlTest::SetUp();
    if (IsSkipped()) return;
    voxels_ = voxelize(context(), furnished_box(), unit_grid(12));
    gpu_ = upload(voxels_);
    transport_ = std::make_unique<OrdinatesTransportGl>(voxels_.grid, GetParam().directions, GetParam().rule);
  }
  Powers carry(const Powers& sent) { return test::carry(*transport_, gpu_, sent); }

  Voxels voxels_;
  VoxelGridGl gpu_;
  std::unique_ptr<OrdinatesTransportGl> transport_;
};

TEST_P(OrdinatesGl, ClosedBoxReceivesWhatIsSent) {
  const Powers sent = random_powers(voxels_.sides.size(), 1);
  const Powers received = carry(sent);
  for (int band = 0; band < 3; ++band) EXPECT_NEAR(sum(received)[band] / sum(sent)[band], 1.0, 1e-5);
  for (const glm::vec4& p : received) EXPECT_TRUE(glm::all(glm::greaterThanEqual(p, glm::vec4(0.0f))));
}

TEST_P(OrdinatesGl, DarknessStaysDark) {
  for (const glm::vec4& p : carry(Powers(voxels_.sides.size(), glm::vec4(0.0f))))
    EXPECT_EQ(glm::vec3(p), glm::vec3(0.0f));
}

// <b, S a> = <a, S b>, S = K / tau of the receiving side; half the sides dark, so that no sum hides the rest.
TEST_P(OrdinatesGl, IsReciprocal) {
  int partly = 0;
  for (const Side& side : voxels_.sides) partly += side.coverage < 0.99f;
  ASSERT_GT(partly, 20) << "some faces must be partly covered";
  for (unsigned seed = 0; seed < 4; ++seed) {
    Powers a = random_powers(voxels_.sides.size(), 10 + seed);
    Powers b = random_powers(voxels_.sides.size(), 20 + seed);
    for (size_t i = 0; i < a.size(); ++i) {
      if (a[i].x < 0.8f) a[i] = glm::vec4(0.0f);
      if (b[i].x < 0.8f) b[i] = glm::vec4(0.0f);
      if (seed == 3 && voxels_.sides[i].coverage > 0.99f) a[i] = glm::vec4(0.0f);  // from partly covered faces only
    }
    const Powers ka = carry(a);
    const Powers kb = carry(b);
    glm::dvec3 b_sa(0.0), a_sb(0.0);
    for (size_t i = 0; i < a.size(); ++i) {
      const double tau = double(voxels_.sides[i].coverage);
      b_sa += glm::dvec3(b[i]) * glm::dvec3(ka[i]) / tau;
      a_sb += glm::dvec3(a[i]) * glm::dvec3(kb[i]) / tau;
    }
    for (int band = 0; band < 3; ++band) EXPECT_NEAR(b_sa[band] / a_sb[band], 1.0, 1e-6);
    RecordProperty("deviation_" + std::to_string(seed), std::to_string(1e9 * (b_sa.x / a_sb.x - 1.0)) + "e-9");
  }
}

TEST_P(OrdinatesGl, IsLinear) {
  const Powers a = random_powers(voxels_.sides.size(), 31);
  const Powers b = random_powers(voxels_.sides.size(), 32);
  Powers both(a.size());
  for (size_t i = 0; i < a.size(); ++i) both[i] = a[i] + 2.5f * b[i];
  const Powers ka = carry(a);
  const Powers kb = carry(b);
  const Powers k = carry(both);
  for (size_t i = 0; i < a.size(); ++i) {
    for (int band = 0; band < 3; ++band) {
      const float expected = ka[i][band] + 2.5f * kb[i][band];
      EXPECT_NEAR(k[i][band], expected, 3e-6f * std::max(expected, 0.1f));
    }
  }
}

// Every side sends the same power an area of the grid: every side must receive what its face would pass.
TEST_P(OrdinatesGl, FurnaceIsAFixedPoint) {
  Powers sent;
  for (const Side& side : voxels_.sides) sent.emplace_back(side.coverage * glm::vec3(1.0f, 2.0f, 0.5f), 0.0f);
  const Powers received = carry(sent);
  for (size_t i = 0; i < sent.size(); ++i) {
    for (int band = 0; band < 3; ++band) EXPECT_NEAR(received[i][band] / sent[i][band], 1.0f, 2e-5f);
  }
}

TEST_P(OrdinatesGl, SameInputSameBytes) {
  const Powers sent = random_powers(voxels_.sides.size(), 41);
  EXPECT_EQ(carry(sent), carry(sent));
}

// Not a cube, so that no axis stands in for another.
TEST_P(OrdinatesGl, IsTheSweepInDouble) {
  Grid grid = unit_grid(12);
  grid.cells = {12, 9, 7};
  voxels_ = voxelize(context(), furnished_box(), grid);
  gpu_ = upload(voxels_);
  transport_ = std::make_unique<OrdinatesTransportGl>(grid, GetParam().directions, GetParam().rule);
  const Powers sent = random_powers(voxels_.sides.size(), 51);
  const SweepResult expected = double_sweep(voxels_, GetParam().directions, GetParam().rule, sent);
  const Powers received = carry(sent);
  expect_received(received, expected);
  double worst = 0.0, largest = 0.0;
  const auto radiance = transport_->radiance(gpu_, gl::Buffer(sent)).download();
  ASSERT_EQ(radiance.size(), 4u);
  for (size_t k = 0; k < 4; ++k) {
    for (size_t c = 0; c < voxels_.cells.size(); ++c) {
      for (int band = 0; band < 3; ++band) {
        largest = std::max(largest, std::abs(expected.radiance[k][c][band]));
        worst = std::max(worst, std::abs(double(radiance[k][c][band]) - expected.radiance[k][c][band]));
      }
    }
  }
  EXPECT_LT(worst, 2e-6 * largest);
}

// Isotropic light of radiance L sends pi L h^2 through every face: sh_00 is sqrt(4 pi) L, all others nothing.
TEST_P(OrdinatesGl, RadianceOfAFurnace) {
  const float h = voxels_.grid.cell_size_m;
  const glm::vec3 radiance(1.0f, 2.0f, 0.5f);
  Powers sent;
  for (const Side& side : voxels_.sides) {
    sent.emplace_back(side.coverage * glm::pi<float>() * h * h * radiance, 0.0f);
  }
  const auto sh = transport_->radiance(gpu_, gl::Buffer(sent)).download();
  for (size_t c = 0; c < voxels_.cells.size(); ++c) {
    for (int band = 0; band < 3; ++band) {
      EXPECT_NEAR(sh[0][c][band] / (std::sqrt(4.0f * glm::pi<float>()) * radiance[band]), 1.0f, 1e-5f);
      for (size_t k = 1; k < 4; ++k) EXPECT_NEAR(sh[k][c][band] / radiance[band], 0.0f, 1e-5f);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Sets, OrdinatesGl,
                         testing::Values(SetAndRule{8, Ordinates::step}, SetAndRule{24, Ordinates::step},
                                         SetAndRule{48, Ordinates::step}, SetAndRule{8, Ordinates::characteristic},
                                         SetAndRule{48, Ordinates::characteristic},
                                         SetAndRule{80, Ordinates::characteristic},
                                         SetAndRule{128, Ordinates::characteristic}),
                         [](const auto& test) {
                           const bool step = test.param.rule == Ordinates::step;
                           return (step ? "Step" : "Characteristic") + std::to_string(test.param.directions);
                         });

// 512 directions go in four batches through what 128 take.
using OrdinatesGlSources = GlTest;
TEST_F(OrdinatesGlSources, HaveDirectionsOfTheirOwn) {
  Grid grid = unit_grid(12);
  grid.cells = {12, 9, 7};
  const Voxels voxels = voxelize(context(), furnished_box(), grid);
  const VoxelGridGl gpu = upload(voxels);
  const OrdinateChoice all{128, Ordinates::step}, sources{512, Ordinates::characteristic};
  OrdinatesTransportGl transport(grid, all, sources);
  const Powers sent = random_powers(voxels.sides.size(), 52);
  for (const bool of_sources : {true, false, true}) {
    transport.carry_sources(of_sources);
    const OrdinateChoice choice = of_sources ? sources : all;
    expect_received(carry(transport, gpu, sent), double_sweep(voxels, choice.directions, choice.rule, sent));
  }
}

// A dispatch and a barrier cost a GPU more than a diagonal of cells does.
using OrdinatesGlDispatches = GlTest;
TEST_F(OrdinatesGlDispatches, AreAtMostHalfTheCellsOfAnEdge) {
  for (const int n : {8, 12, 16, 32, 33, 128}) {
    EXPECT_LE(OrdinatesTransportGl(unit_grid(n), 8).dispatches(), std::max(n / 2, 4)) << n;
  }
}

class OrdinatesGlOptions : public GlTest {};

// What goes with the grid (choose_ordinates), or what is asked for.
TEST_F(OrdinatesGlOptions, AreChosen) {
  SchemeOptions options;
  options.directions = 7;
  EXPECT_THROW(OrdinatesTransportGl(unit_grid(4), options), Error);
}

// A block of 8^3 cells, three lanes (a band of 24 directions, three to an octant) in each of 8 octants: four tiles that
// read and write 16 faces across z and 32 across x and y each, 80 texels. A word a cell and octant. A side: its light
// and three lanes written and read, in four octants.
TEST(OrdinatesGlBytes, OfOneBlockAreCounted) {
  Grid grid{};
  grid.cells = glm::ivec3(8);
  const size_t planes = 8 * 3 * 4 * 80 * 2 * 16, words = 8 * 512 * 4, a_side = 4 * (16 + 3 * (4 + 4));
  EXPECT_EQ(OrdinatesTransportGl::moved_bytes_for(grid, {24, Ordinates::step}, 10), planes + words + 10 * a_side);
}

}  // namespace
}  // namespace volgi::test
