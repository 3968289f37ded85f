// Sides lit by virtual lights, and what the volume makes of it: the first bounce belongs to the screen.
#include "propagation/light_in/reflected_flux_cpu.h"

#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "core/error.h"
#include "core/visibility/virtual_lights_cpu.h"
#include "propagation/volume_cpu.h"
#include "tests/support/box_radiosity.h"
#include "tests/support/paths.h"
#include "tests/support/volume_scenes.h"
#include "voxel/voxelize_cpu.h"

namespace volgi::test {
namespace {

using shared::Side;

constexpr int kPatches = 16;
constexpr float kAlbedo = 0.7f;
const glm::vec3 kLamp(0.0f, 0.5f, 0.0f);

const BoxRadiosity& box() {
  static const BoxRadiosity radiosity(kPatches);
  return radiosity;
}

/// [-1,1]^3, open to nothing.
Scene closed_box() {
  Scene scene;
  add_box_inside(scene, add_material(scene, glm::vec3(kAlbedo)), glm::vec3(0.0f), glm::vec3(1.0f));
  return scene;
}

/// Half a metre square in the middle of the ceiling, of 1 W.
void add_ceiling_emitter(Scene& scene) {
  const int material = add_material(scene, glm::vec3(kAlbedo), glm::vec3(1.0f / (0.25f * glm::pi<float>())));
  add_square(scene, material, {0.0f, 0.9999f, 0.0f}, {0.0f, -1.0f, 0.0f}, 0.25f);
}

VirtualLightsForSides for_sides(const VirtualLightsCpu& lights) { return {lights.lights, lights.reflected, {}, 0}; }

/// Octahedral, 16 bits a number (shared::SubLight); for directions along an axis.
std::uint32_t packed(glm::vec3 axis) { return glm::packSnorm2x16(glm::vec2(axis)); }

/// What sides reflect of virtual lights.
struct Reflected {
  VoxelGrid voxels;
  VirtualLightsCpu lights;
  SideFlux flux;

  Reflected(const Scene& scene, int cells, int count, size_t rays, glm::vec3 shift_cells = glm::vec3(0.0f))
      : Reflected(scene, EmbreeScene(scene), make_grid(scene, cells, shift_cells), count, rays) {}
  Reflected(const Scene& scene, const EmbreeScene& embree, const Grid& grid, int count, size_t rays)
      : voxels(voxelize_cpu(scene, grid)), lights(virtual_lights_cpu(embree, EmitterPoints(scene), count, true)) {
    flux = flux_after_first_bounce(voxels, embree, for_sides(lights), false, rays);
  }

  /// That a side of albedo kAlbedo receives [W].
  double power(size_t i) const { return double(flux.punctual[i].x) / double(kAlbedo); }
  double power() const {
    double sum = 0.0;
    for (size_t i = 0; i < flux.punctual.size(); ++i) sum += power(i);
    return sum;
  }
  double sent() const {
    double sum = 0.0;
    for (const shared::VirtualLight& l : lights.lights) sum += double(l.flux.x);
    return sum;
  }
  size_t patch(size_t i) const {
    const Side& side = voxels.sides()[i];
    const glm::ivec3 c = shared::cell_coord(voxels.grid(), side.cell) * kPatches / voxels.grid().cells;
    const int axis = side.face >> 1;
    return box().index(side.face, c[shared::axis_b(axis)], c[shared::axis_c(axis)]);
  }
};

/// Irradiance of the walls straight from the lamp, 1 W in all directions together.
std::vector<double> lamp_irradiance() {
  std::vector<double> out(box().patch_count());
  constexpr int kPoints = 4;  // on an edge of a patch
  for (int wall = 0; wall < 6; ++wall) {
    for (int c = 0; c < kPatches * kPoints; ++c) {
      for (int b = 0; b < kPatches * kPoints; ++b) {
        const int axis = wall >> 1;
        glm::dvec3 at(0.0);
        at[axis] = (wall & 1) != 0 ? 1.0 : -1.0;
        at[shared::axis_b(axis)] = 2.0 * (b + 0.5) / (kPatches * kPoints) - 1.0;
        at[shared::axis_c(axis)] = 2.0 * (c + 0.5) / (kPatches * kPoints) - 1.0;
        const glm::dvec3 d = at - glm::dvec3(kLamp);
        const double distance = glm::length(d);
        out[box().index(wall, b / kPoints, c / kPoints)] +=
            std::abs(d[axis]) / (distance * distance * distance * 4.0 * M_PI * kPoints * kPoints);
      }
    }
  }
  return out;
}

std::vector<double> emitter_irradiance() {
  std::vector<double> emitted(box().patch_count(), 0.0);
  for (int c = 6; c < 10; ++c) {
    for (int b = 6; b < 10; ++b) emitted[box().index(3, b, c)] = 4.0;  // 1 W from 0.25 m^2
  }
  return box().irradiance(emitted);
}

Light lamp() { return point_light(kLamp, glm::vec3(0.25f * glm::one_over_pi<float>())); }

double rmse_percent(const std::vector<double>& values, const std::vector<double>& exact) {
  double squares = 0.0, sum = 0.0;
  for (size_t i = 0; i < exact.size(); ++i) {
    squares += (values[i] - exact[i]) * (values[i] - exact[i]);
    sum += exact[i];
  }
  return 100.0 * std::sqrt(squares * double(exact.size())) / sum;
}

std::vector<double> by_patch(const Reflected& r) {
  std::vector<double> out(box().patch_count(), 0.0);
  for (size_t i = 0; i < r.flux.punctual.size(); ++i) out[r.patch(i)] += r.power(i) / box().patch_area();
  return out;
}

// Power is kept to rounding, whatever the lights; the pattern is what so many rays make of radiosity's: a patch of the
// wall opposite a lamp gets rays / 1536 of them, and is wrong by the root of that: 15 and 3.8 %.
TEST(ReflectedFlux, AgreesWithRadiosity) {
  Scene lit = closed_box();
  lit.lights = {lamp()};
  const std::vector<double> first = box().bounce(lamp_irradiance(), double(kAlbedo));
  Scene emissive = closed_box();
  add_ceiling_emitter(emissive);
  for (auto [rays, limit] : {std::pair(size_t(1) << 16, 18.0), {size_t(1) << 20, 4.6}}) {
    const Reflected r(lit, kPatches, 4096, rays);
    EXPECT_NEAR(r.power() / double(kAlbedo), 1.0, 2e-4);
    const double error = rmse_percent(by_patch(r), first);
    RecordProperty("lamp_rmse_percent_" + std::to_string(rays), std::to_string(error));
    EXPECT_LT(error, limit);
    const Reflected e(emissive, kPatches, 4096, rays);
    EXPECT_NEAR(e.power(), 1.0, 2e-4);
    const double arriving = rmse_percent(by_patch(e), emitter_irradiance());
    RecordProperty("emitter_rmse_percent_" + std::to_string(rays), std::to_string(arriving));
    EXPECT_LT(arriving, limit);
  }
}

// Where walls lie in cells, how they are turned, and how small things are beside cells changes nothing of the power.
TEST(ReflectedFlux, PowerDoesNotHangOnCells) {
  Scene scene = closed_box();
  scene.lights = {lamp()};
  for (const float shift : {0.0f, 0.25f, 0.5f, 0.75f})
    EXPECT_NEAR(Reflected(scene, 16, 1024, 1 << 14, glm::vec3(shift)).power() / double(kAlbedo), 1.0, 2e-4) << shift;
  Scene turned;
  add_box_inside(turned, add_material(turned, glm::vec3(kAlbedo)), glm::vec3(0.0f), glm::vec3(1.0f),
                 rotation(glm::normalize(glm::vec3(1, 2, 3)), 30.0f));
  turned.lights = {lamp()};
  turned.lights[0].position = glm::vec3(0.0f);
  EXPECT_NEAR(Reflected(turned, 32, 1024, 1 << 14).power() / double(kAlbedo), 1.0, 2e-4);
}

/// Steps of that height and depth over the floor, up to x = 1.
Scene box_with_steps(float step) {
  Scene scene = closed_box();
  for (float x = -1.0f; x < 1.0f - 0.5f * step; x += step) {
    const float y = -1.0f + 0.4f * (x + 1.0f);
    add_quad(scene, 0, {x, y, -1}, {0, 0, 2}, {step, 0, 0});
    add_quad(scene, 0, {x + step, y, -1}, {0, 0, 2}, {0, 0.4f * step, 0});
  }
  return scene;
}

// Steps of half a cell: their risers are lit by their treads, which no single point of a side knows.
TEST(ReflectedFlux, StepsSmallerThanCellsLoseNothing) {
  Scene scene = box_with_steps(0.0625f);
  scene.lights = {lamp()};
  const Reflected r(scene, 16, 4096, 1 << 14);
  // A ray in three thousand ends on the very rim of the grid, in the plane of a wall, and finds no side: that is said.
  EXPECT_NEAR(r.power() / r.sent(), 1.0, 1e-3);
  EXPECT_NEAR((r.power() + double(r.flux.lost.x) / double(kAlbedo)) / r.sent(), 1.0, 2e-4);
}

/// Share of the light that sides get which only cells beyond `wall_x` see.
double leaked(const Scene& scene, int cells, float shift, float wall_x) {
  const Reflected r(scene, cells, 1024, 1 << 15, glm::vec3(shift));
  double dark = 0.0;
  size_t darks = 0;
  for (size_t i = 0; i < r.flux.punctual.size(); ++i) {
    const glm::ivec3 cell = shared::cell_coord(r.voxels.grid(), r.voxels.sides()[i].cell);
    if (shared::world_from_cell(r.voxels.grid(), glm::vec3(cell) + 0.5f).x <= wall_x) continue;
    dark += r.power(i);
    ++darks;
  }
  EXPECT_GT(darks, r.flux.punctual.size() / 4);
  EXPECT_GT(r.power(), 0.0);
  return dark / r.power();
}

// Walls thinner than a cell, of no thickness, and through cells' centres. Where a sheet stands off the cells' faces,
// what lights the floor between it and the face counts for the floor behind (docs/hard-cases.md, thin).
TEST(ReflectedFlux, NothingPassesThinWalls) {
  const Scene thin = load_scene(source_dir() / "data/thin_wall.glb");
  const float beyond = float(0.0101 - thin.world_origin.x);
  for (int cells : {12, 16, 24, 32}) {
    for (float shift : {0.0f, 0.25f, 0.37f, 0.5f})
      EXPECT_EQ(leaked(thin, cells, shift, beyond), 0.0) << cells << " cells, shifted by " << shift;
  }
  for (float x : {0.0f, 0.01f, 0.0625f, 0.0626f}) {
    Scene paper = closed_box();
    add_quad(paper, 0, {x, -1, -1}, {0, 2, 0}, {0, 0, 2});
    paper.lights = {point_light({-0.5f, 0.2f, 0.1f}, glm::vec3(1.0f))};
    EXPECT_LT(leaked(paper, 16, 0.0f, x + 0.001f), x == 0.0f ? 1e-12 : 0.005) << x;
  }
}

/// A light on the floor, and the four coarse and sixteen fine sub-lights that make up the same square.
VirtualLightsForSides subdivided_square(float edge) {
  VirtualLightsForSides from;
  const auto sublight = [&](glm::vec2 middle, float part) {
    return shared::SubLight{{middle.x, -1.0f, middle.y}, edge * edge * part, glm::vec3(part), packed({0, 1, 0})};
  };
  for (int k = 0; k < 20; ++k) {
    const int n = k < 4 ? 2 : 4, cell = k < 4 ? k : (k - 4) % 4 + 4 * ((k - 4) / 4);
    // The fine ones of a coarse one follow on one another.
    const glm::ivec2 at = k < 4 ? glm::ivec2(k % 2, k / 2)
                                : 2 * glm::ivec2((cell / 4) % 2, cell / 8) + glm::ivec2(cell % 2, (cell % 4) / 2);
    from.sublights.push_back(sublight((glm::vec2(at) + 0.5f) * (edge / float(n)) - 0.5f * edge, 1.0f / float(n * n)));
  }
  from.lights = {{{0.0f, -1.0f, 0.0f}, edge * edge, {0, 1, 0}, VIRTUAL_LIGHT_REFLECTED, glm::vec3(1.0f), 0}};
  from.reflected = 1;
  return from;
}

// The fine ones send a light's power: what the wall at x = -1 gets of a square of the floor is what they show it.
TEST(ReflectedFlux, SubLightsSendForTheirLight) {
  const Scene scene = closed_box();
  const EmbreeScene embree(scene);
  const VirtualLightsForSides parts = subdivided_square(1.9f);
  double exact = 0.0, found = 0.0;
  for (size_t k = 4; k < 20; ++k) {
    // Of a point at distance d from the wall, in the plane that meets it: the wall without end has 1/2, cut off at
    // heights of 2 and sides of 1 what a fine sum says.
    constexpr int FINE = 256;
    for (int n = 0; n < FINE * FINE; ++n) {
      const glm::dvec3 at(-1.0, 2.0 * (n % FINE + 0.5) / FINE - 1.0, 2.0 * (n / FINE + 0.5) / FINE - 1.0);
      const glm::dvec3 w = at - glm::dvec3(parts.sublights[k].position);
      exact += w.y * -w.x / (M_PI * std::pow(glm::dot(w, w), 2.0)) * (4.0 / (FINE * FINE)) / 16.0;
    }
  }
  for (const FluxSample& s : reflected_flux(embree, parts, 0, 1, 1 << 16))
    found += s.normal.x > 0.5f ? double(s.flux.x) / double(kAlbedo) : 0.0;
  EXPECT_NEAR(found / exact, 1.0, 0.005);
}

// The sun on the outside of a box sends 30 times of what the lamp inside does, away from it. What rays that meet
// nothing know is where others should go; without that the pattern of so many rays is off by 112 %, now by 20.
TEST(ReflectedFlux, LightsOutsideDoNotTakeTheRaysOfARoom) {
  Scene scene = closed_box();
  scene.lights = {lamp(), sun_light({0.3f, -1.0f, 0.2f}, glm::vec3(10.0f))};
  const auto inside = [&](size_t rays) {
    const Reflected r(scene, kPatches, 4096, rays);
    EXPECT_GT(r.sent(), 20.0);
    return by_patch(r);
  };
  const double error = rmse_percent(inside(size_t(1) << 16), inside(size_t(1) << 22));
  RecordProperty("rmse_percent", std::to_string(error));
  EXPECT_LT(error, 24.0);
}

TEST(ReflectedFlux, SameOnAnyNumberOfThreads) {
  const Scene scene = load_scene(source_dir() / "data/thin_wall.glb");
  const auto run = [&](size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    return Reflected(scene, 16, 512, 10000).flux.punctual;
  };
  const std::vector<glm::vec4> one = run(1);
  EXPECT_EQ(one, run(2));
  EXPECT_EQ(one, run(5));
}

// The sequence goes on from picture to picture: the mean of four has the error of four times as many rays.
TEST(ReflectedFlux, PicturesThatAreAveragedHaveOtherRays) {
  Scene scene = closed_box();
  scene.lights = {lamp()};
  const EmbreeScene embree(scene);
  const VoxelGrid voxels = voxelize_cpu(scene, make_grid(scene, kPatches, glm::vec3(0.0f)));
  VirtualLightsForSides from = for_sides(virtual_lights_cpu(embree, EmitterPoints(scene), 4096, true));
  const std::vector<glm::vec4> many = flux_after_first_bounce(voxels, embree, from, false, 1 << 22).punctual;
  const auto error = [&](int pictures) {
    std::vector<glm::vec4> sum(many.size(), glm::vec4(0.0f));
    for (from.sample = 0; from.sample < pictures; ++from.sample) {
      const std::vector<glm::vec4> one = flux_after_first_bounce(voxels, embree, from, false, 1 << 15).punctual;
      for (size_t i = 0; i < sum.size(); ++i) sum[i] += one[i] / float(pictures);
    }
    double squares = 0.0;
    for (size_t i = 0; i < sum.size(); ++i) squares += std::pow(double(sum[i].x - many[i].x), 2.0);
    return std::sqrt(squares);
  };
  EXPECT_LT(error(4), 0.6 * error(1));
}

TEST(ReflectedFlux, RaysFollowTheNumberOfSides) {
  EXPECT_EQ(automatic_rays(0), 65536u);
  EXPECT_EQ(automatic_rays(8192), 65536u);
  EXPECT_EQ(automatic_rays(40000), 320000u);
  EXPECT_EQ(automatic_rays(1000000), 524288u);
}

// A corner of a room: light that leaves one wall at distance d from the other flies to it, or on.
TEST(ReflectedFlux, FlightsHaveTheirLengths) {
  Scene scene = closed_box();
  scene.lights = {lamp()};
  const EmbreeScene embree(scene);
  const VirtualLightsForSides from = for_sides(virtual_lights_cpu(embree, EmitterPoints(scene), 1024, true));
  double sent = 0.0, power = 0.0;
  for (const shared::VirtualLight& l : from.lights) sent += double(l.flux.x + l.flux.y + l.flux.z);
  for (const Flight& f : flights(embree, from, 4096)) {
    power += double(f.power);
    EXPECT_GE(f.length_m, -1e-6f);  // some lie in an edge
    EXPECT_LE(f.length_m, std::sqrt(12.0f) + 1e-5f);
  }
  EXPECT_NEAR(power / sent, 1.0, 1e-4);
}

VolumeOptions first_bounce_options(std::optional<int> bounces) {
  VolumeOptions o;
  o.grid_cells = kPatches;
  o.source = VolumeOptions::Source::first_bounce;
  o.bounces = bounces;
  return o;
}

void run(VolumeCpu& volume, const Scene& scene, const VolumeOptions& options, int lights, size_t rays) {
  const EmbreeScene embree(scene);
  const VirtualLightsCpu list = virtual_lights_cpu(embree, EmitterPoints(scene), lights, true);
  volume.voxelize();
  volume.light_in(flux_after_first_bounce(volume.voxels(), embree, for_sides(list), options.bounces.has_value(), rays));
  volume.propagate();
  volume.irradiate();
}

/// Power that the volume's light brings to the walls [W].
double indirect_power(const Scene& scene, std::optional<int> bounces) {
  const VolumeOptions options = first_bounce_options(bounces);
  VolumeCpu volume(scene, options);
  run(volume, scene, options, 1024, 1 << 14);
  double sum = 0.0;
  for (size_t i = 0; i < volume.voxels().side_count(); ++i) {
    EXPECT_EQ(volume.irradiance().direct[i].x, 0.0f);
    sum += double(volume.irradiance().indirect[i].x) * double(volume.voxels().sides()[i].area_m2);
  }
  return sum;
}

// In a closed room of one albedo bounce k brings rho^k of what was sent.
TEST(VolumeAfterFirstBounce, CarriesTheBouncesThatAreLeft) {
  Scene lit = closed_box();
  lit.lights = {lamp()};
  Scene emissive = closed_box();
  add_ceiling_emitter(emissive);
  Scene both = emissive;
  both.lights = {lamp()};
  const double rho = double(kAlbedo);
  double of_lamp = 0.0, of_emitter = 0.0;
  for (int bounces = 1; bounces <= 4; ++bounces) {  // without one there is no volume
    if (bounces >= 1) of_emitter += std::pow(rho, bounces);
    if (bounces >= 2) of_lamp += std::pow(rho, bounces);
    EXPECT_NEAR(indirect_power(lit, bounces), of_lamp, 0.005 * of_lamp) << bounces;
    EXPECT_NEAR(indirect_power(emissive, bounces), of_emitter, 0.025 * of_emitter) << bounces;
    EXPECT_NEAR(indirect_power(both, bounces), of_lamp + of_emitter, 0.025 * (of_lamp + of_emitter)) << bounces;
  }
  EXPECT_NEAR(indirect_power(both, {}) / ((rho + rho * rho) / (1.0 - rho)), 1.0, 0.01);
}

// As tests/hardcases/closed_box_test.cpp, but what sides start from is brought by rays.
TEST(VolumeAfterFirstBounce, TotalIndirectOfTheClosedBox) {
  Scene lit = closed_box();
  lit.lights = {lamp()};
  const std::vector<double> first = box().bounce(lamp_irradiance(), double(kAlbedo));
  std::vector<double> exact(first), order(first), total(first);
  for (int k = 0; k < 60; ++k) {
    order = box().bounce(order, double(kAlbedo));
    for (size_t i = 0; i < order.size(); ++i) exact[i] += order[i];
  }
  for (const size_t rays : {size_t(1) << 16, size_t(1) << 20}) {
    const VolumeOptions options = first_bounce_options({});
    VolumeCpu volume(lit, options);
    run(volume, lit, options, 1024, rays);
    total = first;
    for (size_t i = 0; i < volume.voxels().side_count(); ++i) {
      const Side& side = volume.voxels().sides()[i];
      const glm::ivec3 c = shared::cell_coord(volume.grid(), side.cell);
      const int axis = side.face >> 1;
      total[box().index(side.face, c[shared::axis_b(axis)], c[shared::axis_c(axis)])] +=
          double(volume.irradiance().indirect[i].x);
    }
    const double error = rmse_percent(total, exact);
    RecordProperty("rmse_percent_" + std::to_string(rays), std::to_string(error));
    EXPECT_LT(error, 3.0) << rays;
  }
}

TEST(VolumeAfterFirstBounce, IsDarkWithoutLights) { EXPECT_EQ(indirect_power(closed_box(), {}), 0.0); }

}  // namespace
}  // namespace volgi::test
