// The `conservative` scheme: power in void is kept, nothing is negative, what is sent arrives.
#include "propagation/transport_conservative_gl.h"

#include <gtest/gtest.h>

#include "tests/propagation/transport_scene.h"

namespace volgi::test {
namespace {

class ConservativeGl : public GlTest {};

// One small square in the middle of an open box: until the light is at the boundary, seven passes, none can leave.
TEST_F(ConservativeGl, VoidKeepsPower) {
  Scene scene;
  add_square(scene, add_material(scene, glm::vec3(0.5f)), {0.03f, 0.05f, 0.02f}, {1.0f, 0.3f, -0.4f}, 0.16f);
  const Voxels v = voxelize(context(), scene, unit_grid(20));
  const VoxelGridGl gpu = upload(v);
  const Powers sent = random_powers(v.sides.size(), 3);
  const gl::Buffer from(sent);
  const gl::Buffer to(sent.size() * sizeof(glm::vec4));
  to.clear();
  ConservativeTransportGl transport(v.grid);
  transport.emit(gpu, from);
  double worst = 0.0;
  for (int pass = 0; pass <= 7; ++pass) {
    const glm::dvec3 total = glm::dvec3(transport.in_flight(gpu)) + sum(to.download<glm::vec4>(sent.size()));
    for (int band = 0; band < 3; ++band) worst = std::max(worst, std::abs(total[band] / sum(sent)[band] - 1.0));
    transport.advance(gpu, to, 1, false);
  }
  EXPECT_LT(worst, 1e-5);
  RecordProperty("worst", std::to_string(1e6 * worst) + "e-6");
  // And then it leaves.
  transport.advance(gpu, to, 200, false);
  EXPECT_LT(transport.in_flight(gpu).x, 1e-3 * sum(sent).x);
  EXPECT_LT(sum(to.download<glm::vec4>(sent.size())).x, 0.5 * sum(sent).x);
}

TEST_F(ConservativeGl, ClosedBoxReceivesWhatIsSent) {
  const Voxels v = voxelize(context(), furnished_box(), unit_grid(12));
  const VoxelGridGl gpu = upload(v);
  ConservativeTransportGl transport(v.grid);
  const Powers sent = random_powers(v.sides.size(), 4);
  BounceReport report;
  const Powers received = carry(transport, gpu, sent, &report);
  for (int band = 0; band < 3; ++band) {
    EXPECT_NEAR((sum(received)[band] + double(report.left[band])) / sum(sent)[band], 1.0, 1e-5);
    EXPECT_LE(report.left[band], BounceRules::kTolerance * BounceRules{}.absorption() * sum(sent)[band]);
  }
  for (const glm::vec4& p : received) EXPECT_TRUE(glm::all(glm::greaterThanEqual(p, glm::vec4(0.0f))));
}

TEST_F(ConservativeGl, IterationsAreCounted) {
  const Voxels v = voxelize(context(), furnished_box(), unit_grid(8));
  const VoxelGridGl gpu = upload(v);
  ConservativeTransportGl transport(v.grid);
  const Powers sent = random_powers(v.sides.size(), 5);
  const gl::Buffer from(sent);
  const gl::Buffer to(sent.size() * sizeof(glm::vec4));
  to.clear();
  BounceRules rules;
  rules.bounces = 1;
  rules.iterations = 11;
  BounceReport report;
  transport.carry(gpu, from, to, rules, report);
  EXPECT_EQ(report.passes, 11);
  for (int band = 0; band < 3; ++band) {
    EXPECT_NEAR((sum(to.download<glm::vec4>(sent.size()))[band] + double(report.left[band])) / sum(sent)[band], 1.0,
                1e-5);
  }
}

// A beam's worst case: one side alone sends.
TEST_F(ConservativeGl, NothingIsNegative) {
  const Voxels v = voxelize(context(), furnished_box(), unit_grid(12));
  const VoxelGridGl gpu = upload(v);
  ConservativeTransportGl transport(v.grid);
  for (size_t i = 0; i < v.sides.size(); i += 97) {
    Powers sent(v.sides.size(), glm::vec4(0.0f));
    sent[i] = glm::vec4(1.0f, 0.5f, 0.0f, 0.0f);
    for (const glm::vec4& p : carry(transport, gpu, sent)) {
      ASSERT_TRUE(glm::all(glm::greaterThanEqual(p, glm::vec4(0.0f))));
      ASSERT_EQ(p.b, 0.0f);
    }
  }
}

}  // namespace
}  // namespace volgi::test
