// Orders, conjugate gradients, warm starts and amortised runs on the CPU, against the series summed up in double.
#include "propagation/bounces_cpu.h"

#include <gtest/gtest.h>
#include <oneapi/tbb/task_arena.h>

#include "core/error.h"
#include "tests/propagation/cpu_rooms.h"

namespace volgi::test {
namespace {

using Solver = BounceRules::Solver;

double largest(const Powers& p) {
  double m = 0.0;
  for (const glm::vec4& v : p) m = std::max({m, double(v.x), double(v.y), double(v.z)});
  return m;
}

double power_error(const Powers& a, const Powers& b) {
  glm::dvec3 off(0.0);
  for (size_t i = 0; i < a.size(); ++i) off += glm::abs(glm::dvec3(a[i]) - glm::dvec3(b[i]));
  const glm::dvec3 all = glm::max(sum(b), glm::dvec3(1e-30));
  return std::max({off.x / all.x, off.y / all.y, off.z / all.z});
}

/// A box of sides that differ in everything, and a random exchange of power between them.
class BouncesCpuTest : public ::testing::Test {
 protected:
  BouncesCpuTest() : voxels_(make_voxels()), s_(random_exchange(voxels_, 5)) {
    rules_.largest_albedo = 0.9f;
    std::mt19937 random(7);
    std::uniform_real_distribution<float> uniform(0.0f, 1.0f);
    for (Powers* p : {&flux_.emitted, &flux_.punctual}) {
      for (size_t i = 0; i < voxels_.side_count(); ++i) {
        const float few = i % 17 == 0 ? 1.0f : 0.0f;
        p->emplace_back(few * uniform(random), few * uniform(random), few * 1e-3f * uniform(random), 0.0f);
      }
    }
  }

  static VoxelGrid make_voxels() {
    const VoxelGrid room = rooms_in_a_row(1, 6, glm::vec3(0.5f));
    std::vector<shared::Side> sides = room.sides();
    std::mt19937 random(3);
    std::uniform_real_distribution<float> uniform(0.0f, 1.0f);
    for (shared::Side& side : sides) {
      side.albedo = glm::vec3(0.9f * uniform(random), uniform(random) < 0.3f ? 0.0f : 0.8f, 0.9f);
      side.coverage = uniform(random) < 0.3f ? 0.05f + 0.9f * uniform(random) : 1.0f;
      side.face_m2 *= side.coverage;
      side.area_m2 = side.face_m2 / (1.0f + 0.7f * uniform(random));
    }
    return VoxelGrid(room.grid(), sides);
  }

  glm::dvec3 returned(size_t i) const {
    const shared::Side& s = voxels_.sides()[i];
    return glm::dvec3(shared::side_returned_fraction(s.albedo, s.area_m2, s.face_m2));
  }
  std::vector<glm::dvec3> sent(const Powers& flux) const {
    std::vector<glm::dvec3> powers;
    for (size_t i = 0; i < flux.size(); ++i) {
      const shared::Side& s = voxels_.sides()[i];
      powers.emplace_back(shared::side_sent_power(glm::vec3(flux[i]), s.albedo, s.area_m2, s.face_m2));
    }
    return powers;
  }
  std::vector<glm::dvec3> carried(const std::vector<glm::dvec3>& sent) const {
    std::vector<glm::dvec3> received(sent.size(), glm::dvec3(0.0));
    for (size_t i = 0; i < sent.size(); ++i) {
      for (size_t j = 0; j < sent.size(); ++j) received[i] += s_[i][j] * sent[j];
      received[i] *= double(voxels_.sides()[i].coverage);
    }
    return received;
  }
  static Powers rounded(const std::vector<glm::dvec3>& powers) {
    Powers p;
    for (const glm::dvec3& v : powers) p.emplace_back(glm::vec3(v), 0.0f);
    return p;
  }
  struct Answer {
    Powers direct, indirect;
  };
  /// The series, summed up in double.
  Answer series(const SideFlux& flux, bool emission, int bounces) const {
    std::vector<glm::dvec3> direct(voxels_.side_count(), glm::dvec3(0.0));
    if (emission) direct = carried(sent(flux.emitted));
    std::vector<glm::dvec3> now = sent(flux.punctual), all(now.size(), glm::dvec3(0.0));
    for (size_t i = 0; i < now.size(); ++i) now[i] += returned(i) * direct[i];
    for (int order = 0; order < bounces; ++order) {
      now = carried(now);
      for (size_t i = 0; i < now.size(); ++i) {
        all[i] += now[i];
        now[i] *= returned(i);
      }
    }
    return {rounded(direct), rounded(all)};
  }
  BouncesCpu matrix() const { return BouncesCpu(std::make_unique<MatrixTransport>(s_, voxels_)); }
  BouncesCpu pulse() const { return BouncesCpu(std::make_unique<PulseTransport>(s_, voxels_)); }
  SideFlux dimmed(glm::vec3 share) const {
    SideFlux flux = flux_;
    for (Powers* p : {&flux.emitted, &flux.punctual}) {
      for (glm::vec4& v : *p) v *= glm::vec4(share, 0.0f);
    }
    return flux;
  }
  SideFlux moved() const {
    SideFlux flux = flux_;
    std::rotate(flux.punctual.begin(), flux.punctual.begin() + 3, flux.punctual.end());
    for (size_t i = 0; i < flux.punctual.size(); ++i)
      flux.punctual[i] = 0.9f * flux_.punctual[i] + 0.1f * flux.punctual[i];
    return flux;
  }

  VoxelGrid voxels_;
  MatrixTransport::Matrix s_;
  SideFlux flux_;
  BounceRules rules_;
  static constexpr int kAll = 400;
};

TEST_F(BouncesCpuTest, PartialSums) {
  for (bool emission : {false, true}) {
    for (int n : {0, 1, 2, 7}) {
      rules_.bounces = n;
      BouncesCpu bounces = matrix();
      const BounceReport report = bounces.run(voxels_, flux_, emission, rules_);
      const Answer exact = series(flux_, emission, n);
      EXPECT_EQ(report.orders, n + (emission ? 1 : 0));
      EXPECT_EQ(report.passes, report.orders);
      EXPECT_LE(power_error(bounces.received_direct(), exact.direct), 1e-6);
      EXPECT_LE(power_error(bounces.received_indirect(), exact.indirect), 1e-6);
      if (n > 0) {
        EXPECT_LE(power_error(bounces.received_but_last(), series(flux_, emission, n - 1).indirect), 1e-6);
      }
    }
  }
}

TEST_F(BouncesCpuTest, BothSolversEndWithinTheTolerance) {
  for (bool emission : {false, true}) {
    const Answer exact = series(flux_, emission, kAll);
    int passes[2];
    for (Solver solver : {Solver::plain, Solver::automatic}) {
      rules_.solver = solver;
      BouncesCpu bounces = matrix();
      const BounceReport report = bounces.run(voxels_, flux_, emission, rules_);
      EXPECT_TRUE(report.converged);
      EXPECT_EQ(report.conjugate_gradients, solver == Solver::automatic);
      EXPECT_LE(power_error(bounces.received_direct(), exact.direct), 1e-6);
      EXPECT_LE(power_error(bounces.received_indirect(), exact.indirect), double(BounceRules::kTolerance));
      for (const glm::vec4& p : bounces.received_indirect()) EXPECT_GE(std::min({p.x, p.y, p.z}), 0.0f);
      // What is left is what would be sent next, and so bounds the error.
      for (int band = 0; band < 3; ++band) {
        const double missing = std::abs(sum(exact.indirect)[band] - sum(bounces.received_indirect())[band]);
        EXPECT_LE(missing, 1.001 * double(report.left[band] / rules_.absorption()) + 1e-6 * sum(exact.indirect)[band]);
      }
      passes[solver == Solver::plain] = report.passes;
    }
    EXPECT_LT(2 * passes[0], passes[1]);
  }
}

// P <- K(e + fP) from black ends when the series does: the same sums, and what is left is what would be sent next.
TEST_F(BouncesCpuTest, RenewalsEndAsOrdersDo) {
  rules_.solver = Solver::plain;
  BouncesCpu one_by_one = matrix(), renewed = matrix();
  const BounceReport a = one_by_one.run(voxels_, flux_, true, rules_);
  rules_.warm_start = true;
  const BounceReport b = renewed.run(voxels_, flux_, true, rules_);
  EXPECT_EQ(a.orders, b.orders);
  EXPECT_LE(power_error(renewed.received_indirect(), one_by_one.received_indirect()), 1e-5);
  for (int band = 0; band < 3; ++band) EXPECT_NEAR(b.left[band], a.left[band], 1e-6f * a.sent[band]);
}

// All that is sent ends on sides, or is left.
TEST_F(BouncesCpuTest, ReportsPowerSent) {
  for (Solver solver : {Solver::plain, Solver::conjugate_gradients}) {
    rules_.solver = solver;
    BouncesCpu bounces = matrix();
    const BounceReport report = bounces.run(voxels_, flux_, true, rules_);
    const Powers all = bounces.sent(voxels_, flux_);
    for (int band = 0; band < 3; ++band) {
      EXPECT_NEAR(double(report.sent[band]) / sum(all)[band], 1.0, 2e-3);
      EXPECT_LE(sum(all)[band], double(report.sent[band] + report.left[band]) * (1.0 + 1e-5));
    }
  }
}

TEST_F(BouncesCpuTest, ScalesWithTheLight) {
  BouncesCpu bounces = matrix();
  bounces.run(voxels_, flux_, true, rules_);
  for (float scale : {1e-12f, 1e12f}) {
    BouncesCpu scaled = matrix();
    const SideFlux flux = dimmed(glm::vec3(scale));
    scaled.run(voxels_, flux, true, rules_);
    EXPECT_NEAR(sum(scaled.received_indirect()).x / double(scale) / sum(bounces.received_indirect()).x, 1.0, 1e-5);
  }
}

TEST_F(BouncesCpuTest, WarmStartReachesTheSameAnswerSooner) {
  for (Solver solver : {Solver::plain, Solver::automatic}) {
    rules_.solver = solver;
    rules_.warm_start = true;
    BouncesCpu bounces = matrix();
    const int cold = bounces.run(voxels_, flux_, true, rules_).passes;
    const SideFlux changed = moved();
    const BounceReport warm = bounces.run(voxels_, changed, true, rules_);
    EXPECT_TRUE(warm.converged);
    EXPECT_LT(warm.passes, cold);
    EXPECT_LE(power_error(bounces.received_indirect(), series(changed, true, kAll).indirect),
              double(BounceRules::kTolerance));
    // Dimmed lights leave nothing of what they were, and a band that goes dark is dark.
    const SideFlux dim = dimmed({1e-4f, 0.5f, 0.0f});
    EXPECT_LE(bounces.run(voxels_, dim, true, rules_).passes, cold + 1);
    EXPECT_LE(power_error(bounces.received_indirect(), series(dim, true, kAll).indirect),
              double(BounceRules::kTolerance));
    const BounceReport dark = bounces.run(voxels_, dimmed(glm::vec3(0.0f)), true, rules_);
    EXPECT_TRUE(dark.converged);
    EXPECT_EQ(largest(bounces.received_indirect()), 0.0);
    bounces.run(voxels_, flux_, true, rules_);
    EXPECT_LE(power_error(bounces.received_indirect(), series(flux_, true, kAll).indirect),
              double(BounceRules::kTolerance));
  }
}

TEST_F(BouncesCpuTest, NoDriftInAStaticScene) {
  const Answer exact = series(flux_, true, kAll);
  for (Solver solver : {Solver::plain, Solver::automatic}) {
    rules_.solver = solver;
    rules_.warm_start = true;
    BouncesCpu bounces = matrix();
    bounces.run(voxels_, flux_, true, rules_);
    for (int run = 0; run < 200; ++run) {
      const BounceReport report = bounces.run(voxels_, flux_, true, rules_);
      ASSERT_EQ(report.passes, 2);  // the arrival of emission, and one bounce to see that all is well
    }
    EXPECT_LE(power_error(bounces.received_indirect(), exact.indirect), 1e-5);
  }
}

TEST_F(BouncesCpuTest, WarmStartNeedsAsManySides) {
  rules_.warm_start = true;
  BouncesCpu bounces = matrix();
  const BounceReport cold = bounces.run(voxels_, flux_, false, rules_);
  const VoxelGrid other = rooms_in_a_row(1, 4, glm::vec3(0.5f));
  bounces.set_transport(std::make_unique<StepTransport>(other, 8));
  bounces.run(other, ceiling_light(other, 0, glm::vec3(1.0f)), false, rules_);
  bounces.set_transport(std::make_unique<MatrixTransport>(s_, voxels_));
  EXPECT_EQ(bounces.run(voxels_, flux_, false, rules_).passes, cold.passes);
}

/// Runs until the answer has come within 1 % of `exact` and stays there.
int runs_until_near(BouncesCpu& bounces, const VoxelGrid& voxels, const SideFlux& flux, const BounceRules& rules,
                    const Powers& exact, int runs) {
  int near = 0;
  for (int run = 1; run <= runs; ++run) {
    const BounceReport report = bounces.run(voxels, flux, true, rules);
    EXPECT_LE(report.passes, *rules.passes_per_run);
    if (power_error(bounces.received_indirect(), exact) > 0.01) near = run;
  }
  return near + 1;
}

TEST_F(BouncesCpuTest, AmortisedOrdersFollowALightStep) {
  const SideFlux half = dimmed(glm::vec3(0.5f));
  const Answer full = series(flux_, true, kAll), dim = series(half, true, kAll);
  for (int passes : {1, 3}) {
    rules_.passes_per_run = passes;
    BouncesCpu bounces = matrix();
    const int up = runs_until_near(bounces, voxels_, flux_, rules_, full.indirect, 120);
    EXPECT_LE(power_error(bounces.received_indirect(), full.indirect), 1e-5);  // 120 runs: no drift
    const int down = runs_until_near(bounces, voxels_, half, rules_, dim.indirect, 120);
    EXPECT_LE(power_error(bounces.received_direct(), dim.direct), 1e-6);
    RecordProperty("runs_up_" + std::to_string(passes), up);
    // Orders fall by 0.8 at least; of `passes` of them one renews the arrival (every other of single ones).
    const double orders = std::log(0.01) / std::log(0.8) + 2.0;
    const double orders_per_run = passes == 1 ? 0.5 : double(passes - 1);
    EXPECT_LE(up, orders / orders_per_run + 2.0);
    EXPECT_LE(down, up);
  }
}

TEST_F(BouncesCpuTest, AmortisedPulseGoesOnInTheNextRun) {
  rules_.passes_per_run = 4;
  const Answer exact = series(flux_, false, kAll);
  BouncesCpu bounces = pulse();
  Powers before = bounces.received_indirect();
  int published = 0, orders = 0;
  for (int run = 0; run < 400; ++run) {
    const BounceReport report = bounces.run(voxels_, flux_, false, rules_);
    EXPECT_EQ(report.passes, 4);
    if (run > 0 && report.orders == 0) {
      EXPECT_EQ(bounces.received_indirect(), before);
    }
    published += report.orders > 0;
    orders += report.orders;
    before = bounces.received_indirect();
  }
  EXPECT_LT(published, 200);  // a pulse of 13 passes takes more than three runs
  EXPECT_EQ(orders, published);
  EXPECT_LE(power_error(bounces.received_indirect(), exact.indirect), double(BounceRules::kTolerance));
}

TEST_F(BouncesCpuTest, PulsesTakeOrdersAndWarmStarts) {
  const Answer exact = series(flux_, true, kAll);
  BouncesCpu bounces = pulse();
  const BounceReport cold = bounces.run(voxels_, flux_, true, rules_);
  EXPECT_FALSE(cold.conjugate_gradients);
  EXPECT_GT(cold.passes, 5 * cold.orders);
  EXPECT_LE(power_error(bounces.received_indirect(), exact.indirect), 3.0 * double(BounceRules::kTolerance));
  rules_.warm_start = true;
  const BounceReport warm = bounces.run(voxels_, flux_, true, rules_);
  EXPECT_LE(warm.orders, 4);
  EXPECT_LE(power_error(bounces.received_indirect(), exact.indirect), 3.0 * double(BounceRules::kTolerance));
}

TEST_F(BouncesCpuTest, SameBytesWithAnyNumberOfThreads) {
  Powers answers[2];
  for (int threads : {1, 2}) {
    oneapi::tbb::task_arena arena(threads);
    arena.execute([&] {
      BouncesCpu bounces = matrix();
      bounces.run(voxels_, flux_, true, rules_);
      answers[threads - 1] = bounces.received_indirect();
    });
  }
  EXPECT_EQ(answers[0], answers[1]);
}

TEST_F(BouncesCpuTest, RefusesWhatMakesNoSense) {
  const auto refused = [&](BouncesCpu bounces, const BounceRules& rules) {
    try {
      bounces.run(voxels_, flux_, false, rules);
    } catch (const Error& error) {
      return error.code() == ExitCode::usage;
    }
    return false;
  };
  BounceRules rules;
  EXPECT_FALSE(refused(matrix(), rules));
  rules.solver = Solver::conjugate_gradients;
  EXPECT_TRUE(refused(pulse(), rules));
  rules.bounces = 3;
  EXPECT_TRUE(refused(matrix(), rules));
  rules = {};
  rules.passes_per_run = 2;
  EXPECT_FALSE(refused(pulse(), rules));
  rules.iterations = 5;
  EXPECT_TRUE(refused(matrix(), rules));
  rules = {};
  rules.passes_per_run = 0;
  EXPECT_TRUE(refused(matrix(), rules));
  rules.passes_per_run = 2;
  rules.bounces = 1;
  EXPECT_TRUE(refused(matrix(), rules));
  rules.bounces.reset();
  rules.solver = Solver::conjugate_gradients;
  EXPECT_TRUE(refused(matrix(), rules));
}

}  // namespace
}  // namespace volgi::test
