// Orders: `--bounces N` gives partial sums that grow towards the whole.
#include "propagation/bounces_gl.h"

#include <gtest/gtest.h>

#include <functional>

#include "propagation/transport_conservative_gl.h"
#include "propagation/transport_ordinates_gl.h"
#include "tests/propagation/transport_scene.h"
#include "voxel/emitter_pieces.h"

namespace volgi::test {
namespace {

class BouncesGlTest : public GlTest {
 protected:
  void SetUp() override {
    GlTest::SetUp();
    if (IsSkipped()) return;
    scene_ = furnished_box();
    // An emitter under the ceiling.
    add_square(scene_, add_material(scene_, glm::vec3(0.2f), glm::vec3(5.0f, 4.0f, 3.0f)), {0.0f, 0.9f, 0.0f},
               {0.0f, -1.0f, 0.0f}, 0.3f);
    voxels_ = std::make_unique<SlicedVoxelization>(unit_grid(10));
    sides_ = voxelize(context(), *voxels_, scene_).sides.size();
    flux_ = std::make_unique<SideFluxGl>();
    flux_->begin(voxels_->voxels());
    gl::PassTimer timer(context().software(), false);
    flux_->inject_emitters(voxels_->voxels(), emitter_pieces(scene_, voxels_->voxels().grid), timer);
  }

  struct Result {
    BounceReport report;
    Powers direct, indirect, but_last;
  };
  Result run(std::unique_ptr<TransportGl> transport, const BounceRules& rules) {
    gl::PassTimer timer(context().software(), false);
    BouncesGl bounces(std::move(transport));
    const BounceReport report = bounces.run(voxels_->voxels(), *flux_, true, rules, timer);
    return {report, bounces.received_direct().download<glm::vec4>(sides_),
            bounces.received_indirect().download<glm::vec4>(sides_),
            bounces.received_but_last().download<glm::vec4>(sides_)};
  }
  std::unique_ptr<TransportGl> ordinates() { return std::make_unique<OrdinatesTransportGl>(unit_grid(10), 24); }
  std::unique_ptr<TransportGl> conservative() { return std::make_unique<ConservativeTransportGl>(unit_grid(10)); }

  void expect_partial_sums(const std::function<std::unique_ptr<TransportGl>()>& make) {
    BounceRules rules;
    rules.largest_albedo = 0.8f;
    const Result whole = run(make(), rules);
    EXPECT_TRUE(whole.report.converged);
    Powers before(sides_, glm::vec4(0.0f));
    for (int n : {0, 1, 2, 4, 40}) {
      rules.bounces = n;
      const Result part = run(make(), rules);
      EXPECT_EQ(part.report.orders, n + 1);  // the arrival of emission is bounce 0
      EXPECT_EQ(part.direct, whole.direct);
      for (size_t i = 0; i < sides_; ++i) {
        for (int band = 0; band < 3; ++band) EXPECT_GE(part.indirect[i][band], before[i][band] * 0.999999f);
      }
      if (n == 1 || n == 2) {
        EXPECT_EQ(part.but_last, before);
      }
      before = part.indirect;
      if (n == 0) {
        EXPECT_EQ(sum(part.indirect), glm::dvec3(0.0));
      }
    }
    for (int band = 0; band < 3; ++band) {
      EXPECT_NEAR(sum(whole.indirect)[band] / sum(before)[band], 1.0, 2.0 * double(BounceRules::kTolerance));
    }
  }

  Scene scene_;
  std::unique_ptr<SlicedVoxelization> voxels_;
  std::unique_ptr<SideFluxGl> flux_;  // needs the context of SetUp
  size_t sides_ = 0;
};

TEST_F(BouncesGlTest, OrdinatesPartialSums) {
  expect_partial_sums([&] { return ordinates(); });
}

TEST_F(BouncesGlTest, ConservativePartialSums) {
  expect_partial_sums([&] { return conservative(); });
}

// Power balance of a closed box: what was emitted has been absorbed, but for what is left. Order by order that is still
// to be sent; conjugate gradients are off by it at most, either way.
TEST_F(BouncesGlTest, AllThatIsEmittedIsAbsorbed) {
  const std::vector<Side> sides = voxels_->voxels().download_sides();
  const auto flux = flux_->emitted().download<glm::vec4>(sides_);
  for (auto solver : {BounceRules::Solver::plain, BounceRules::Solver::conjugate_gradients}) {
    BounceRules rules;
    rules.largest_albedo = 0.8f;
    rules.solver = solver;
    const Result r = run(ordinates(), rules);
    glm::dvec3 emitted(0.0), absorbed(0.0);
    for (size_t i = 0; i < sides_; ++i) {
      const Side& s = sides[i];
      emitted += glm::dvec3(shared::side_sent_power(glm::vec3(flux[i]), s.albedo, s.area_m2, s.face_m2));
      const glm::vec3 kept = 1.0f - shared::side_returned_fraction(s.albedo, s.area_m2, s.face_m2);
      absorbed += glm::dvec3(kept) * (glm::dvec3(r.direct[i]) + glm::dvec3(r.indirect[i]));
    }
    for (int band = 0; band < 3; ++band) {
      const double missing = emitted[band] - absorbed[band], left = double(r.report.left[band]);
      if (solver == BounceRules::Solver::plain) {
        EXPECT_NEAR(missing / emitted[band], left / emitted[band], 1e-4);
      } else {
        EXPECT_LE(std::abs(missing), left + 1e-5 * emitted[band]);
      }
    }
  }
}

// Together: one order in which hits are sent on at once, for schemes that iterate.
TEST_F(BouncesGlTest, TogetherCarriesNearlyTheSame) {
  BounceRules rules;
  rules.largest_albedo = 0.8f;
  const Result orders = run(conservative(), rules);
  rules.iterations = 400;
  const Result together = run(conservative(), rules);
  EXPECT_NEAR(sum(together.indirect).x / sum(orders.indirect).x, 1.0, 0.02);
}

TEST_F(BouncesGlTest, SameInputSameBytes) {
  BounceRules rules;
  rules.largest_albedo = 0.8f;
  const Result a = run(ordinates(), rules);
  const Result b = run(ordinates(), rules);
  EXPECT_EQ(a.indirect, b.indirect);
  EXPECT_EQ(a.report.orders, b.report.orders);
}

}  // namespace
}  // namespace volgi::test
