// The closed box with a small ceiling emitter against its exact radiosity (docs/hard-cases.md, "refine").
#include <gtest/gtest.h>

#include "propagation/bounces_cpu.h"
#include "tests/support/box_radiosity.h"
#include "tests/support/hard_case.h"

namespace volgi::test {
namespace {

constexpr int kPatches = 16;

const BoxRadiosity& box() {
  static const BoxRadiosity radiosity(kPatches);
  return radiosity;
}

/// Irradiance on the walls straight from the emitter, 4 x 4 patches (0.5 m) in the ceiling's middle.
std::vector<double> direct_irradiance() {
  std::vector<double> emitted(box().patch_count(), 0.0);
  for (int c = 6; c < 10; ++c) {
    for (int b = 6; b < 10; ++b) emitted[box().index(3, b, c)] = 1.0;
  }
  return box().irradiance(emitted);
}

struct Exact {
  std::vector<double> first;     // irradiance after one reflection
  std::vector<double> indirect;  // after one or more
};

Exact exact_irradiance(double rho) {
  std::vector<double> order = box().bounce(direct_irradiance(), rho);
  Exact exact{order, order};
  for (int k = 0; k < 60; ++k) {
    order = box().bounce(order, rho);
    for (size_t i = 0; i < order.size(); ++i) exact.indirect[i] += order[i];
  }
  return exact;
}

struct Deviation {
  double rmse_percent, energy;
};

/// First bounce exact, bounces 2 ... n by the volume (docs/theory.md#composition): total indirect irradiance.
Deviation first_bounce_exact(float albedo, int cells, const SchemeOptions& scheme) {
  const BoxSides walls(box(), cells, albedo);
  const VoxelGrid voxels(walls.grid, walls.sides);
  const Exact exact = exact_irradiance(double(albedo));
  SideFlux flux;
  flux.emitted.assign(voxels.side_count(), glm::vec4(0.0f));
  for (size_t i = 0; i < voxels.side_count(); ++i) {
    flux.punctual.emplace_back(glm::vec3(albedo * float(exact.first[walls.patch_of[i]]) * voxels.sides()[i].area_m2),
                               0.0f);
  }
  BouncesCpu bounces(make_transport(voxels, scheme));
  BounceRules rules;
  rules.largest_albedo = albedo;
  bounces.run(voxels, flux, false, rules);

  std::vector<double> total(exact.first);
  const int sides_per_edge = cells / kPatches;
  const double sides_per_patch = double(sides_per_edge) * double(sides_per_edge);
  for (size_t i = 0; i < voxels.side_count(); ++i) {
    total[walls.patch_of[i]] +=
        double(bounces.received_indirect()[i].x) / double(voxels.sides()[i].area_m2) / sides_per_patch;
  }
  double squares = 0.0, sum = 0.0, reference = 0.0;
  for (size_t i = 0; i < total.size(); ++i) {
    squares += (total[i] - exact.indirect[i]) * (total[i] - exact.indirect[i]);
    sum += total[i];
    reference += exact.indirect[i];
  }
  const double count = double(total.size());
  return {100.0 * std::sqrt(squares / count) / (reference / count), sum / reference};
}

SchemeOptions ordinates(int directions, Ordinates rule) {
  SchemeOptions o;
  o.directions = directions;
  o.ordinates = rule;
  return o;
}

TEST(ClosedBox, RadiosityKeepsPower) {
  // Every patch sends all that it has: F is doubly stochastic on equal patches.
  std::vector<double> one(box().patch_count(), 0.0);
  one[box().index(3, 5, 9)] = 1.0;
  double sum = 0.0;
  for (double e : box().irradiance(one)) sum += e;
  EXPECT_NEAR(sum, 1.0, 1e-4);
  for (double e : box().irradiance(std::vector<double>(box().patch_count(), 1.0))) EXPECT_NEAR(e, 1.0, 1e-3);
}

TEST(ClosedBox, OrdinatesCarryBouncesAfterTheFirst) {
  for (float albedo : {0.3f, 0.5f, 0.7f}) {
    const Deviation step = first_bounce_exact(albedo, 16, ordinates(24, Ordinates::step));
    RecordProperty("step24_rmse_percent_" + std::to_string(int(albedo * 10)), std::to_string(step.rmse_percent));
    EXPECT_LT(step.rmse_percent, 2.0) << albedo;
    EXPECT_NEAR(step.energy, 1.0, 0.005) << albedo;
    const Deviation fine = first_bounce_exact(albedo, 16, ordinates(128, Ordinates::characteristic));
    RecordProperty("sc128_rmse_percent_" + std::to_string(int(albedo * 10)), std::to_string(fine.rmse_percent));
    EXPECT_LT(fine.rmse_percent, 0.7) << albedo;
  }
}

TEST(ClosedBox, ConservativeCarriesBouncesAfterTheFirst) {
  for (auto [order, limit] : {std::pair(1, 7.0), {2, 2.0}}) {
    SchemeOptions scheme;
    scheme.scheme = Scheme::conservative;
    scheme.sh_order = order;
    scheme.coarse_start = false;
    for (float albedo : {0.3f, 0.5f, 0.7f}) {
      const Deviation d = first_bounce_exact(albedo, 16, scheme);
      RecordProperty("order" + std::to_string(order) + "_rmse_percent_" + std::to_string(int(albedo * 10)),
                     std::to_string(d.rmse_percent));
      EXPECT_LT(d.rmse_percent, limit) << "order " << order << ", albedo " << albedo;
      EXPECT_NEAR(d.energy, 1.0, 0.01) << albedo;
    }
  }
}

TEST(ClosedBox, RefiningTheGridDoesNotHurt) {
  double before = 1e30;
  for (int cells : {16, 32, 64}) {
    const Deviation d = first_bounce_exact(0.7f, cells, SchemeOptions{});
    if (cells > 16)
      expect_hard_case({"refine",
                        "ordinates, closed_box, " + std::to_string(cells) + " cells, error over that of half as many",
                        "CPU",
                        d.rmse_percent / before,
                        1.0,
                        {},
                        {},
                        "times"});
    before = d.rmse_percent;
  }
}

}  // namespace
}  // namespace volgi::test
