// The papers' schemes: what one pass does to one lobe, by hand; symmetry; mirrors; read-out.
#include "propagation/pulse_volume_gl.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "shaders/shared/sh.shared.h"
#include "tests/support/gl_test.h"
#include "tests/support/volume_scenes.h"
#include "tests/support/voxels.h"

namespace volgi::test {
namespace {

constexpr int kN = 9;
constexpr double kPi = glm::pi<double>();

/// One side alone in the middle of a grid of kN^3 cells of edge 1, that sends along `normal`.
Voxels one_side(glm::vec3 normal) {
  Voxels v;
  v.grid = unit_grid(kN);
  v.grid.cell_size_m = 1.0f;
  v.cells.assign(size_t(kN) * kN * kN, glm::uvec2(0));
  const int middle = shared::cell_index(v.grid, glm::ivec3(kN / 2));
  for (int i = middle + 1; i < kN * kN * kN; ++i) v.cells[size_t(i)].x = 1;
  v.cells[size_t(middle)] = {0, 1};
  Side side{};
  side.normal = normal;
  side.coverage = side.area_m2 = side.face_m2 = 1.0f;
  side.cell = middle;
  v.sides.push_back(side);
  return v;
}

class PulseGl : public GlTest, public testing::WithParamInterface<int> {
 protected:
  using Radiance = std::vector<std::vector<glm::vec4>>;

  SchemeOptions options(Scheme scheme) const {
    SchemeOptions o;
    o.scheme = scheme;
    o.sh_order = GetParam();
    return o;
  }
  static gl::Texture filled(const Voxels& v, const std::vector<glm::vec4>& texels) {
    gl::Texture t = gl::Texture::make_3d(GL_RGBA32F, v.grid.cells);
    glTextureSubImage3D(t.id(), 0, 0, 0, 0, v.grid.cells.x, v.grid.cells.y, v.grid.cells.z, GL_RGBA, GL_FLOAT,
                        texels.data());
    return t;
  }
  Radiance run(const Voxels& v, const SchemeOptions& o, const std::vector<glm::vec4>& flux, int iterations,
               BounceReport* report = nullptr) {
    if (surfaces_.empty()) surfaces_.assign(v.cells.size(), glm::vec4(0.0f));
    if (albedo_.empty()) albedo_.assign(v.cells.size(), glm::vec4(0.5f, 0.25f, 1.0f, 0.0f));
    if (emission_.empty()) emission_.assign(v.cells.size(), glm::vec4(0.0f));
    gl::PassTimer timer(context().software(), false);
    PulseVolumeGl pulse(v.grid, o);
    const BounceReport r = pulse.run(upload(v), {filled(v, surfaces_), filled(v, albedo_), filled(v, emission_)},
                                     gl::Buffer(flux), iterations, timer);
    if (report != nullptr) *report = r;
    return pulse.radiance().download();
  }
  /// 4 pi times the mean radiance of a cell, over what one watt in it amounts to: the power that went through it.
  static double power(const Voxels& v, const Radiance& sh, glm::ivec3 c) {
    const float per_watt = shared::radiance_from_lobe(v.grid.cell_size_m);
    return double(sh[0][size_t(shared::cell_index(v.grid, c))].x / per_watt);
  }
  static float irradiance(const Voxels& v, const Radiance& sh, glm::ivec3 c, glm::vec3 n) {
    const auto i = size_t(shared::cell_index(v.grid, c));
    const glm::vec4 low = shared::sh_basis_1(-n);
    const float pi = glm::pi<float>();
    float sum = pi * sh[0][i].x;
    for (size_t k = 1; k < 4; ++k) sum += 2.0f * pi / 3.0f * low[glm::length_t(k)] * sh[k][i].x;
    return sum / std::sqrt(4.0f * pi);
  }

  std::vector<glm::vec4> surfaces_, albedo_, emission_;  // by cell: mean normal and occupancy; albedo; radiosity
  const glm::ivec3 middle_{kN / 2};
  const std::vector<glm::vec4> flux_{glm::vec4(1.0f, 2.0f, 0.0f, 0.0f)};
};

/// Intensity of a clamped cosine lobe of power 1 along the axis, cut off after `order`.
double cosine_intensity(double cosine, int order) {
  const double p2 = 1.5 * cosine * cosine - 0.5;
  return (1.0 + 2.0 * cosine + (order == 2 ? 1.25 * p2 : 0.0)) / (4.0 * kPi);
}

// Injection by MAX, emission only: the cell's largest radiosity B is a light of power B h^2 about its mean normal,
// whatever the sides' areas; a cone of 90 degrees ahead takes its share into the next cell, by hand from the lobe's
// coefficients.
TEST_P(PulseGl, InjectsTheLargestRadiosityOfACell) {
  Voxels v = one_side({1.0f, 0.0f, 0.0f});
  v.grid.cell_size_m = 0.5f;
  const auto middle = size_t(shared::cell_index(v.grid, middle_));
  surfaces_.assign(v.cells.size(), glm::vec4(0.0f));
  surfaces_[middle] = {1.0f, 0.0f, 0.0f, 1.0f};
  surfaces_[middle + 1] = {0.0f, 0.0f, 0.0f,
                           1.0f};  // what arrives ahead is read there: it has no normal, and turns back
  emission_.assign(v.cells.size(), glm::vec4(0.0f));
  emission_[middle] = {8.0f, 4.0f, 0.0f, 0.0f};
  SchemeOptions o = options(Scheme::gaitatzes2010);
  o.injection = SchemeOptions::Injection::max;
  BounceReport report;
  const Radiance sh = run(v, o, {glm::vec4(0.0f)}, 1, &report);
  EXPECT_NEAR(report.sent.x, 8.0f * 0.25f, 1e-6f);
  EXPECT_NEAR(report.sent.y, 4.0f * 0.25f, 1e-6f);
  // The 90-degree cone, c = cos 45 degrees: half the lobe's isotropic part 1 - c, and of P_1 and P_2 what
  // docs/theory.md says.
  const double c = std::sqrt(0.5), share_0 = 0.5 * (1.0 - c);
  const double share_1 = 3.0 * (2.0 / 3.0) * 0.25 * (1.0 - c * c);
  const double share_2 = GetParam() == 2 ? 5.0 * 0.25 * 0.25 * c * (1.0 - c * c) : 0.0;
  EXPECT_NEAR(power(v, sh, middle_ + glm::ivec3(1, 0, 0)), 2.0 * (share_0 + share_1 + share_2), 1e-5);
}

// Sides' flux over their areas counts in the cell that holds the surface: here the one behind the face.
TEST_P(PulseGl, InjectsWhatSidesReflectByMax) {
  const Voxels v =
      one_side({1.0f, 0.0f, 0.0f});  // on the lower x face of the middle: its surface lies in the cell below
  surfaces_.assign(v.cells.size(), glm::vec4(0.0f));
  surfaces_[size_t(shared::cell_index(v.grid, middle_ - glm::ivec3(1, 0, 0)))] = {1.0f, 0.0f, 0.0f, 1.0f};
  SchemeOptions o = options(Scheme::gaitatzes2010);
  o.injection = SchemeOptions::Injection::max;
  BounceReport report;
  run(v, o, flux_, 1, &report);
  EXPECT_NEAR(report.sent.x, 1.0f, 1e-6f);
  EXPECT_NEAR(report.sent.y, 2.0f, 1e-6f);
}

// One pass from a cosine lobe along +x: what the cell in front and a cell beside get, from the solid angles.
TEST_P(PulseGl, LpvOnePassByHand) {
  const Voxels v = one_side({1.0f, 0.0f, 0.0f});
  const Radiance sh = run(v, options(Scheme::lpv2009), flux_, 1);
  const double side = kPi / 6.0 - std::asin(0.1), far = 4.0 * kPi / 6.0 - 4.0 * side;
  const double along = 2.0 / std::sqrt(5.0), across = 1.0 / std::sqrt(5.0);
  const auto intensity = [](double cosine) { return std::max(0.0, cosine_intensity(cosine, GetParam())); };
  EXPECT_NEAR(power(v, sh, middle_ + glm::ivec3(1, 0, 0)), far * intensity(1.0) + 4.0 * side * intensity(along), 2e-6);
  // Beside: the far face at 90 degrees; faces at cosines across, -across and twice 0.
  const double beside = (far + 2.0 * side) * intensity(0.0) + side * (intensity(across) + intensity(-across));
  for (glm::ivec3 d : {glm::ivec3(0, 1, 0), {0, -1, 0}, {0, 0, 1}, {0, 0, -1}}) {
    EXPECT_NEAR(power(v, sh, middle_ + d), beside, 2e-6);
  }
  EXPECT_EQ(power(v, sh, middle_ + glm::ivec3(1, 1, 0)), 0.0);
}

// What has gone through cells only grows with passes, and fills a ball of so many steps.
TEST_P(PulseGl, LpvAccumulates) {
  const Voxels v = one_side({0.0f, 0.0f, -1.0f});
  BounceReport report;
  const Radiance two = run(v, options(Scheme::lpv2009), flux_, 2);
  const Radiance four = run(v, options(Scheme::lpv2009), flux_, 4, &report);
  EXPECT_EQ(report.passes, 4);
  EXPECT_NEAR(report.sent.y, 2.0f, 1e-6f);
  EXPECT_GT(report.left.x, 0.1f);
  double before = 0.0, after = 0.0;
  for (int i = 0; i < int(v.cells.size()); ++i) {
    const glm::ivec3 c = shared::cell_coord(v.grid, i);
    EXPECT_GE(power(v, four, c), power(v, two, c) - 1e-6);
    const glm::ivec3 d = glm::abs(c - middle_);
    if (d.x + d.y + d.z > 4) {
      EXPECT_EQ(power(v, four, c), 0.0);
    }
    before += power(v, two, c);
    after += power(v, four, c);
    for (const auto& coefficient : four) {
      EXPECT_NEAR(coefficient[size_t(i)].y, 2.0f * coefficient[size_t(i)].x, 1e-5f);
      EXPECT_EQ(coefficient[size_t(i)].z, 0.0f);
    }
  }
  EXPECT_GT(power(v, four, middle_ - glm::ivec3(0, 0, 4)), 0.0);
  EXPECT_GT(after, 1.5 * before);
}

// A lobe along z is the same in the four directions around; mirror images for both schemes.
TEST_P(PulseGl, SpreadsEvenly) {
  const Voxels v = one_side({0.0f, 0.0f, 1.0f});
  surfaces_.assign(v.cells.size(), glm::vec4(0.0f, 0.0f, 0.0f, 0.3f));  // reads something out everywhere
  for (Scheme scheme : {Scheme::lpv2009, Scheme::gaitatzes2010}) {
    const Radiance sh = run(v, options(scheme), flux_, 3);
    for (int i = 0; i < int(v.cells.size()); ++i) {
      const glm::ivec3 c = shared::cell_coord(v.grid, i);
      const glm::ivec3 d = c - middle_;
      const double here = power(v, sh, c);
      EXPECT_NEAR(power(v, sh, middle_ + glm::ivec3(-d.x, d.y, d.z)), here, 1e-6);
      EXPECT_NEAR(power(v, sh, middle_ + glm::ivec3(d.y, d.x, d.z)), here, 1e-6);
    }
    EXPECT_GT(power(v, sh, middle_ + glm::ivec3(0, 0, 2)), power(v, sh, middle_ + glm::ivec3(2, 0, 0)));
  }
}

// A cone of the lobe's flux goes straight on in void; nothing is accumulated there.
TEST_P(PulseGl, GaitatzesVoidKeepsNothing) {
  const Voxels v = one_side({1.0f, 0.0f, 0.0f});
  BounceReport report;
  const Radiance sh = run(v, options(Scheme::gaitatzes2010), flux_, 1, &report);
  for (const auto& coefficient : sh) {
    for (const glm::vec4& x : coefficient) EXPECT_EQ(x, glm::vec4(0.0f));
  }
  // Flux through the cone of 45 degrees about its axis, and about the four axes across.
  const double c = std::sqrt(0.5), solid = (1.0 - c) / 2.0, z1 = (1.0 + c) / 2.0, z2 = c * (1.0 + c) / 2.0;
  const double second = GetParam() == 2 ? 1.25 * z2 : 0.0;
  const double ahead = solid * (1.0 + 2.0 * z1 + second), across = solid * (1.0 - 0.5 * second);
  const double behind = std::max(0.0, solid * (1.0 - 2.0 * z1 + second));
  EXPECT_NEAR(double(report.left.x), ahead + 4.0 * across + behind, 1e-5);
}

// A wall at x = 7 that faces -x: light comes back from it, times its albedo, and only there is it accumulated, as what
// arrives: the wall's own normal is lit, its back is not.
TEST_P(PulseGl, GaitatzesReflectsAtAWall) {
  const Voxels v = one_side({1.0f, 0.0f, 0.0f});
  surfaces_.assign(v.cells.size(), glm::vec4(0.0f));
  for (int i = 0; i < int(v.cells.size()); ++i) {
    if (shared::cell_coord(v.grid, i).x == 7) surfaces_[size_t(i)] = glm::vec4(-1.0f, 0.0f, 0.0f, 1.0f);
  }
  const glm::ivec3 wall(7, middle_.y, middle_.z);
  const Radiance sh = run(v, options(Scheme::gaitatzes2010), flux_, 3);  // three steps to the wall
  EXPECT_GT(power(v, sh, wall), 0.0);
  EXPECT_EQ(power(v, sh, wall - glm::ivec3(1, 0, 0)), 0.0);
  EXPECT_GT(irradiance(v, sh, wall, {-1.0f, 0.0f, 0.0f}), 2.0f * irradiance(v, sh, wall, {0.0f, 1.0f, 0.0f}));
  EXPECT_LT(irradiance(v, sh, wall, {1.0f, 0.0f, 0.0f}), 0.05f * irradiance(v, sh, wall, {-1.0f, 0.0f, 0.0f}));
  // Every step keeps the flux through one cone, on a straight line; what others add along it comes later.
  const double c = std::sqrt(0.5), solid = (1.0 - c) / 2.0, z1 = (1.0 + c) / 2.0, z2 = c * (1.0 + c) / 2.0;
  const double second = GetParam() == 2 ? 5.0 * z2 * z2 : 0.0;
  const double from_cosine = solid * (1.0 + 2.0 * z1 + (GetParam() == 2 ? 1.25 * z2 : 0.0));
  const double from_cone = solid * (1.0 + 3.0 * z1 * z1 + second);
  EXPECT_NEAR(power(v, sh, wall), from_cosine * from_cone * from_cone, 1e-5);

  // The albedo is what is left in flight, not what is accumulated.
  albedo_.assign(v.cells.size(), glm::vec4(0.0f));
  BounceReport black, half, constant;
  EXPECT_EQ(run(v, options(Scheme::gaitatzes2010), flux_, 3, &black), sh);
  SchemeOptions as_in_paper = options(Scheme::gaitatzes2010);
  as_in_paper.constant_albedo = true;
  run(v, as_in_paper, flux_, 3, &constant);
  albedo_.assign(v.cells.size(), glm::vec4(0.5f));
  run(v, options(Scheme::gaitatzes2010), flux_, 3, &half);
  EXPECT_EQ(half.left, constant.left);
  EXPECT_GT(half.left.x, black.left.x + 0.1f * float(power(v, sh, wall)));
  // Behind the wall it stays dark.
  const Radiance later = run(v, options(Scheme::gaitatzes2010), flux_, 12);
  double behind = 0.0;
  for (int y = 0; y < kN; ++y) {
    for (int z = 0; z < kN; ++z) behind += power(v, later, {8, y, z});
  }
  EXPECT_EQ(behind, 0.0);
}

// White cells that hold half of what passes, a hundred passes.
TEST_P(PulseGl, NumbersStayFinite) {
  const Voxels v = one_side(glm::normalize(glm::vec3(1.0f, 2.0f, -0.5f)));
  surfaces_.assign(v.cells.size(), glm::vec4(0.0f, 0.0f, 0.0f, 0.5f));
  albedo_.assign(v.cells.size(), glm::vec4(1.0f));
  for (Scheme scheme : {Scheme::lpv2009, Scheme::gaitatzes2010}) {
    for (const auto& coefficient : run(v, options(scheme), flux_, 100)) {
      for (const glm::vec4& x : coefficient) EXPECT_TRUE(std::isfinite(x.x) && std::isfinite(x.y));
    }
  }
}

TEST_P(PulseGl, OnlyThePapersSchemes) {
  EXPECT_THROW(PulseVolumeGl(unit_grid(4), options(Scheme::conservative)), Error);
}

INSTANTIATE_TEST_SUITE_P(Orders, PulseGl, testing::Values(1, 2));

}  // namespace
}  // namespace volgi::test
