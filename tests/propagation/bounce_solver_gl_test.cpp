// All bounces at once on the GPU: conjugate gradients, warm starts, amortised runs; each against its twin on the CPU.
#include <gtest/gtest.h>

#include "core/error.h"
#include "propagation/bounces_cpu.h"
#include "propagation/bounces_gl.h"
#include "propagation/side_irradiance_gl.h"
#include "propagation/transport_conservative_gl.h"
#include "propagation/transport_ordinates_gl.h"
#include "tests/propagation/step_transport.h"
#include "tests/propagation/transport_scene.h"
#include "voxel/emitter_pieces.h"

namespace volgi::test {
namespace {

constexpr int kDirections = 24;

/// A scheme whose orders take many passes and cannot be interrupted.
class WholeOrders : public TransportGl {
 public:
  void carry(const VoxelGridGl& voxels, const gl::Buffer& sent, const gl::Buffer& received, const BounceRules& rules,
             BounceReport& report) override {
    whole_.carry(voxels, sent, received, rules, report);
  }
  RadianceVolumeGl radiance(const VoxelGridGl& voxels, const gl::Buffer& sent) override {
    return whole_.radiance(voxels, sent);
  }
  bool iterative() const override { return true; }
  size_t bytes() const override { return whole_.bytes(); }

 private:
  ConservativeTransportGl whole_{unit_grid(10)};
};

class SolverGl : public GlTest {
 protected:
  void SetUp() override {
    GlTest::SetUp();
    if (IsSkipped()) return;
    scene_ = furnished_box();
    add_square(scene_, add_material(scene_, glm::vec3(0.2f), glm::vec3(5.0f, 4.0f, 3.0f)), {0.0f, 0.9f, 0.0f},
               {0.0f, -1.0f, 0.0f}, 0.3f);
    voxels_ = std::make_unique<SlicedVoxelization>(unit_grid(10));
    const Voxels v = voxelize(context(), *voxels_, scene_);
    cpu_voxels_ = VoxelGrid(v.grid, v.sides);
    // As emission, and as punctual light from elsewhere.
    pieces_ = emitter_pieces(scene_, v.grid);
    for (const FluxSample& p : pieces_) lamp_.push_back({p.position, p.normal, glm::vec3(1.0f, 0.0f, 0.01f)});
    rules_.largest_albedo = 0.8f;
  }

  /// Sets the light of both: `scale` times emission and lamp.
  void light(glm::vec3 scale) {
    std::vector<FluxSample> pieces = pieces_, lamp = lamp_;
    for (FluxSample& p : pieces) p.flux *= scale;
    for (FluxSample& p : lamp) p.flux *= scale;
    gl::PassTimer timer(context().software(), false);
    if (!flux_) flux_ = std::make_unique<SideFluxGl>();
    flux_->begin(voxels_->voxels());
    flux_->inject_emitters(voxels_->voxels(), pieces, timer);
    cpu_flux_.emitted = flux_->emitted().download<glm::vec4>(cpu_voxels_.side_count());
    cpu_flux_.punctual.assign(cpu_voxels_.side_count(), glm::vec4(0.0f));
    glm::vec3 lost(0.0f);
    deposit(cpu_voxels_, lamp, cpu_flux_.punctual, lost);
    flux_->punctual().upload(cpu_flux_.punctual.data(), cpu_flux_.punctual.size() * sizeof(glm::vec4));
  }
  std::unique_ptr<TransportGl> ordinates() {
    return std::make_unique<OrdinatesTransportGl>(unit_grid(10), kDirections);
  }
  BouncesCpu twin() { return BouncesCpu(std::make_unique<StepTransport>(cpu_voxels_, kDirections)); }
  BounceReport run(BouncesGl& bounces) {
    gl::PassTimer timer(context().software(), false);
    return bounces.run(voxels_->voxels(), *flux_, true, rules_, timer);
  }
  Powers direct(const BouncesGl& b) { return b.received_direct().download<glm::vec4>(cpu_voxels_.side_count()); }
  Powers indirect(const BouncesGl& b) { return b.received_indirect().download<glm::vec4>(cpu_voxels_.side_count()); }

  /// Largest difference over the largest power.
  static double difference(const Powers& a, const Powers& b) {
    double worst = 0.0, largest = 0.0;
    for (size_t i = 0; i < a.size(); ++i) {
      for (int band = 0; band < 3; ++band) {
        worst = std::max(worst, double(std::abs(a[i][band] - b[i][band])));
        largest = std::max(largest, double(std::abs(b[i][band])));
      }
    }
    return worst / std::max(largest, 1e-30);
  }

  Scene scene_;
  std::unique_ptr<SlicedVoxelization> voxels_;
  VoxelGrid cpu_voxels_;
  std::vector<FluxSample> pieces_, lamp_;
  std::unique_ptr<SideFluxGl> flux_;
  SideFlux cpu_flux_;
  BounceRules rules_;
};

TEST_F(SolverGl, ConjugateGradientsAsOnTheCpu) {
  for (float scale : {1.0f, 1e-6f, 1e9f}) {
    light(glm::vec3(scale, scale, 0.0f));
    BouncesGl gpu(ordinates());
    BouncesCpu cpu = twin();
    const BounceReport a = run(gpu), b = cpu.run(cpu_voxels_, cpu_flux_, true, rules_);
    EXPECT_TRUE(a.converged && a.conjugate_gradients);
    EXPECT_EQ(a.orders, b.orders);
    EXPECT_NEAR(a.sent.x / b.sent.x, 1.0f, 1e-5f);
    EXPECT_LE(a.left.x, BounceRules::kTolerance * a.sent.x);
    EXPECT_LE(difference(direct(gpu), cpu.received_direct()), 1e-5);
    EXPECT_LE(difference(indirect(gpu), cpu.received_indirect()), 1e-5);
    const Powers sent = gpu.sent(voxels_->voxels(), *flux_).download<glm::vec4>(cpu_voxels_.side_count());
    EXPECT_LE(difference(sent, cpu.sent(cpu_voxels_, cpu_flux_)), 1e-5);
  }
}

TEST_F(SolverGl, ConjugateGradientsAsOrderByOrder) {
  light(glm::vec3(1.0f));
  BouncesGl all(ordinates()), orders(ordinates());
  const BounceReport quick = run(all);
  rules_.solver = BounceRules::Solver::plain;
  const BounceReport slow = run(orders);
  EXPECT_LT(quick.passes, slow.passes);
  EXPECT_EQ(direct(all), direct(orders));
  EXPECT_LE(difference(indirect(all), indirect(orders)), double(BounceRules::kTolerance));
}

TEST_F(SolverGl, WarmStartsStayAndFollow) {
  rules_.warm_start = true;
  for (auto solver : {BounceRules::Solver::automatic, BounceRules::Solver::plain}) {
    rules_.solver = solver;
    light(glm::vec3(1.0f));
    BouncesGl bounces(ordinates());
    const int cold = run(bounces).orders;
    run(bounces);
    const Powers settled = indirect(bounces);
    for (int k = 0; k < 20; ++k) EXPECT_EQ(run(bounces).orders, 2);
    EXPECT_LE(difference(indirect(bounces), settled), 0.1 * double(BounceRules::kTolerance));
    const Powers before = indirect(bounces);
    run(bounces);
    EXPECT_LE(difference(indirect(bounces), before), 1e-6);  // at rest
    // Another light: as from black, and sooner.
    light(glm::vec3(1.1f, 0.0f, 2.0f));
    const BounceReport warm = run(bounces);
    EXPECT_LT(warm.orders, cold);
    BouncesGl fresh(ordinates());
    run(fresh);
    EXPECT_LE(difference(indirect(bounces), indirect(fresh)), double(BounceRules::kTolerance));
    light(glm::vec3(0.0f));
    EXPECT_TRUE(run(bounces).converged);
    EXPECT_EQ(sum(indirect(bounces)), glm::dvec3(0.0));
  }
}

TEST_F(SolverGl, AmortisedRunsAsOnTheCpu) {
  for (int passes : {1, 3}) {
    rules_.passes_per_run = passes;
    light(glm::vec3(1.0f));
    BouncesGl gpu(ordinates());
    BouncesCpu cpu = twin();
    for (int k = 0; k < 6; ++k) {
      if (k == 3) light(glm::vec3(0.5f, 1.0f, 2.0f));
      EXPECT_EQ(run(gpu).passes, passes);
      cpu.run(cpu_voxels_, cpu_flux_, true, rules_);
      EXPECT_LE(difference(direct(gpu), cpu.received_direct()), 1e-5);
      EXPECT_LE(difference(indirect(gpu), cpu.received_indirect()), 1e-5);
    }
  }
}

TEST_F(SolverGl, AmortisedPulsesGoOn) {
  light(glm::vec3(1.0f));
  rules_.passes_per_run = 8;
  BouncesGl whole(std::make_unique<WholeOrders>());
  try {
    run(whole);
    ADD_FAILURE() << "orders that cannot be interrupted were";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::usage);
  }
  BouncesGl bounces(std::make_unique<ConservativeTransportGl>(unit_grid(10)));
  int orders = 0;
  Powers before;
  for (int k = 0; k < 200; ++k) {
    const BounceReport report = run(bounces);
    EXPECT_EQ(report.passes, 8);
    orders += report.orders;
    if (k > 0 && report.orders == 0 && k < 40) {
      EXPECT_EQ(indirect(bounces), before);
    }
    if (k < 40) before = indirect(bounces);
  }
  EXPECT_LT(orders, 100);
  // The same equation, solved in one run.
  rules_.passes_per_run.reset();
  rules_.warm_start = true;
  BouncesGl at_once(std::make_unique<ConservativeTransportGl>(unit_grid(10)));
  EXPECT_TRUE(run(at_once).converged);
  EXPECT_NEAR(sum(indirect(bounces)).x / sum(indirect(at_once)).x, 1.0, 2.0 * double(BounceRules::kTolerance));
}

TEST_F(SolverGl, IrradianceAsOnTheCpu) {
  light(glm::vec3(1.0f));
  rules_.bounces = 3;
  BouncesGl gpu(ordinates());
  BouncesCpu cpu = twin();
  run(gpu);
  cpu.run(cpu_voxels_, cpu_flux_, true, rules_);
  gl::PassTimer timer(context().software(), false);
  SideIrradianceGl irradiance;
  irradiance.run(voxels_->voxels(), *flux_, gpu, timer);
  const SideIrradiance expected = side_irradiance(cpu_voxels_, cpu_flux_, cpu);
  const size_t count = cpu_voxels_.side_count();
  EXPECT_LE(difference(irradiance.direct().download<glm::vec4>(count), expected.direct), 1e-5);
  EXPECT_LE(difference(irradiance.indirect().download<glm::vec4>(count), expected.indirect), 1e-5);
}

}  // namespace
}  // namespace volgi::test
