// Sides lit by virtual lights, and what the volume makes of it: the first bounce belongs to the screen.
#include "propagation/light_in/side_gather_cpu.h"

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

VirtualLightsForSides for_sides(const VirtualLightsCpu& lights) { return {lights.lights, lights.reflected, {}, 0.0f}; }

/// Octahedral, 16 bits a number (shared::SubLight); for directions along an axis.
std::uint32_t packed(glm::vec3 axis) { return glm::packSnorm2x16(glm::vec2(axis)); }

struct Gathered {
  VoxelGrid voxels;
  VirtualLightsCpu lights;
  std::vector<glm::vec4> irradiance;

  Gathered(const Scene& scene, int cells, int count, int stride, glm::vec3 shift_cells = glm::vec3(0.0f))
      : Gathered(scene, EmbreeScene(scene), make_grid(scene, cells, shift_cells), count, stride) {}
  Gathered(const Scene& scene, const EmbreeScene& embree, const Grid& grid, int count, int stride)
      : Gathered(scene, embree, grid, virtual_lights_cpu(embree, EmitterPoints(scene), count), stride) {}
  Gathered(const Scene& scene, const EmbreeScene& embree, const Grid& grid, VirtualLightsCpu of, int stride)
      : voxels(voxelize_cpu(scene, grid)), lights(std::move(of)) {
    irradiance = side_gather(voxels, embree, for_sides(lights), 0, lights.lights.size(), stride);
  }

  double power(size_t i) const { return double(irradiance[i].x) * double(voxels.sides()[i].area_m2); }
  double power() const {
    double sum = 0.0;
    for (size_t i = 0; i < irradiance.size(); ++i) sum += power(i);
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

std::vector<double> by_patch(const Gathered& g) {
  std::vector<double> out(box().patch_count(), 0.0);
  for (size_t i = 0; i < g.irradiance.size(); ++i) out[g.patch(i)] += g.power(i) / box().patch_area();
  return out;
}

// The power is what a convex box must get; the pattern, what so few lights make of radiosity's.
TEST(SideGather, AgreesWithRadiosity) {
  Scene lit = closed_box();
  lit.lights = {lamp()};
  const std::vector<double> first = box().bounce(lamp_irradiance(), double(kAlbedo));
  Scene emissive = closed_box();
  add_ceiling_emitter(emissive);
  for (auto [count, limit] : {std::pair(1024, 8.0), {8192, 2.0}}) {
    const Gathered g(lit, kPatches, count, 1);
    EXPECT_EQ(g.lights.reflected, count);
    // Disks that stand for more surface than their distance lose power near edges: as 1 / sqrt(count).
    RecordProperty("lamp_power_" + std::to_string(count), std::to_string(g.power() / double(kAlbedo)));
    EXPECT_NEAR(g.power() / double(kAlbedo), 1.0, 1.2 / std::sqrt(double(count)));
    const double error = rmse_percent(by_patch(g), first);
    RecordProperty("lamp_rmse_percent_" + std::to_string(count), std::to_string(error));
    EXPECT_LT(error, limit);
    const Gathered e(emissive, kPatches, count, 1);
    EXPECT_EQ(e.lights.emitted(), count);
    double outside = 0.0, exact = 0.0;  // of the ceiling: the emitter hangs below it, in front of sides of its own
    const std::vector<double> arriving = by_patch(e), direct = emitter_irradiance();
    for (size_t i = 0; i < direct.size(); ++i) outside += arriving[i], exact += direct[i];
    EXPECT_NEAR(outside / exact, 1.0, 0.01);
    RecordProperty("emitter_rmse_percent_" + std::to_string(count), std::to_string(rmse_percent(arriving, direct)));
    EXPECT_LT(rmse_percent(arriving, direct), 2.0);
  }
}

// Tilted sides stand for their plane: turned, the box's walls get and reflect the same power.
TEST(SideGather, TurnedBoxReflectsTheSame) {
  Scene scene;
  add_box_inside(scene, add_material(scene, glm::vec3(kAlbedo)), glm::vec3(0.0f), glm::vec3(1.0f),
                 rotation(glm::normalize(glm::vec3(1, 2, 3)), 30.0f));
  scene.lights = {lamp()};
  scene.lights[0].position = glm::vec3(0.0f);
  const Gathered g(scene, 32, 8192, 5);
  double flux = 0.0;
  for (const glm::vec4& f : reflected_flux(g.voxels, g.irradiance)) flux += double(f.x);
  RecordProperty("power_ratio", std::to_string(flux / double(kAlbedo * kAlbedo)));
  EXPECT_NEAR(flux / double(kAlbedo * kAlbedo), 1.0, 0.02);
}

// Walls on the faces of cells, between, and through the centres, where a wall's lowest side has its middle on the
// floor: that asked for its light at the floor's level got none from there, and all sides together 6 % too little (at
// half a cell).
TEST(SideGather, PowerDoesNotHangOnWhereWallsLieInCells) {
  Scene scene = closed_box();
  scene.lights = {lamp()};
  for (const float shift : {0.0f, 0.25f, 0.5f, 0.75f}) {
    const Gathered g(scene, 16, 8192, 1, glm::vec3(shift));
    RecordProperty("power_" + std::to_string(shift), std::to_string(g.power() / double(kAlbedo)));
    EXPECT_NEAR(g.power() / double(kAlbedo), 1.0, 0.012) << shift;
  }
}

constexpr double kNothing = 1e-12;  // lights and sides of one plane, by rounding

/// Share of the light that sides get which only cells beyond `wall_x` see.
double leaked(const Scene& scene, int cells, float shift, float wall_x) {
  const Gathered g(scene, cells, 1024, 1, glm::vec3(shift));
  double dark = 0.0;
  size_t darks = 0;
  for (size_t i = 0; i < g.irradiance.size(); ++i) {
    const glm::ivec3 cell = shared::cell_coord(g.voxels.grid(), g.voxels.sides()[i].cell);
    if (shared::world_from_cell(g.voxels.grid(), glm::vec3(cell) + 0.5f).x <= wall_x) continue;
    dark += g.power(i);
    ++darks;
  }
  EXPECT_GT(darks, g.irradiance.size() / 4);
  EXPECT_GT(g.power(), 0.0);
  return dark / g.power();
}

// Walls thinner than a cell, of no thickness, and through cells' centres.
TEST(SideGather, NothingPassesThinWalls) {
  const Scene thin = load_scene(source_dir() / "data/thin_wall.glb");
  const float beyond = float(0.0101 - thin.world_origin.x);
  for (int cells : {12, 16, 24, 32}) {
    for (float shift : {0.0f, 0.25f, 0.37f, 0.5f}) {
      EXPECT_LT(leaked(thin, cells, shift, beyond), kNothing) << cells << " cells, shifted by " << shift;
    }
  }
  for (float x : {0.0f, 0.01f, 0.0625f, 0.0626f}) {
    Scene paper = closed_box();
    add_quad(paper, 0, {x, -1, -1}, {0, 2, 0}, {0, 0, 2});
    paper.lights = {point_light({-0.5f, 0.2f, 0.1f}, glm::vec3(1.0f))};
    EXPECT_LT(leaked(paper, 16, 0.0f, x + 0.001f), kNothing) << x;
  }
}

// The mean stays; single sides take what few lights give.
TEST(SideGather, StrideKeepsTheMean) {
  Scene scene = closed_box();
  add_ceiling_emitter(scene);
  scene.lights = {lamp(), lamp()};
  scene.lights[1].position = {0.5f, -0.3f, 0.2f};
  const EmbreeScene embree(scene);
  const Grid grid = make_grid(scene, kPatches, glm::vec3(0.0f));
  const VirtualLightsCpu lights = virtual_lights_cpu(embree, EmitterPoints(scene), 1024, true);
  const Gathered all(scene, embree, grid, lights, 1);
  for (auto [stride, limit] : {std::pair(4, 8.0), {16, 20.0}, {64, 50.0}}) {
    const Gathered few(scene, embree, grid, lights, stride);
    EXPECT_NEAR(few.power() / all.power(), 1.0, 0.02) << stride;
    double squares = 0.0;
    std::vector<int> taken(size_t(stride), 0);
    for (size_t i = 0; i < all.irradiance.size(); ++i) {
      const Side& side = all.voxels.sides()[i];
      ++taken[size_t(first_light_of_side(shared::cell_coord(all.voxels.grid(), side.cell), side.face, stride))];
      squares += std::pow(few.power(i) - all.power(i), 2.0);
    }
    const double rms = 100.0 * std::sqrt(squares * double(all.irradiance.size())) / all.power();
    RecordProperty("side_rms_percent_" + std::to_string(stride), std::to_string(rms));
    EXPECT_LT(rms, limit) << stride;
    const double mean = double(all.irradiance.size()) / stride;
    for (int n : taken) EXPECT_NEAR(n / mean, 1.0, 0.5) << stride;
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
  from.near_zone = 4.0f;
  return from;
}

// A square of the floor, and the wall that meets it: the exact irradiance is a sum over a fine raster of points.
TEST(SideGather, SidesNearALightGetTheLightOfItsSubLights) {
  const Scene scene = closed_box();
  const EmbreeScene embree(scene);
  const VoxelGrid voxels = voxelize_cpu(scene, make_grid(scene, kPatches, glm::vec3(0.0f)));
  const VirtualLightsForSides subdivision = subdivided_square(1.9f);
  VirtualLightsForSides whole = subdivision;
  whole.sublights.clear();
  const auto error = [&](const VirtualLightsForSides& from) {
    const std::vector<glm::vec4> found = side_gather(voxels, embree, from, 0, 1, 1);
    double squares = 0.0, mean = 0.0;
    for (size_t i = 0; i < found.size(); ++i) {
      const Side& side = voxels.sides()[i];
      if (side.normal.x < 0.9f) continue;  // the wall at x = -1
      glm::vec3 at = glm::vec3(shared::cell_coord(voxels.grid(), side.cell)) + 0.5f;
      at[side.face >> 1] = side.depth;
      const glm::vec3 x = shared::world_from_cell(voxels.grid(), at);
      double exact = 0.0;
      constexpr int FINE = 64;
      for (int k = 0; k < FINE * FINE; ++k) {
        const glm::vec2 uv = (glm::vec2(k % FINE, k / FINE) + 0.5f) * (1.9f / FINE) - 0.95f;
        const glm::dvec3 w = glm::dvec3(uv.x, -1.0, uv.y) - glm::dvec3(x);
        const double squared = glm::dot(w, w);
        exact += w.x * -w.y / (glm::pi<double>() * squared * squared) / (FINE * FINE);
      }
      squares += std::pow(double(found[i].x) - exact, 2.0);
      mean += exact;
    }
    return 100.0 * std::sqrt(squares * 256.0) / mean;
  };
  const double by_sublights = error(subdivision), by_light = error(whole);
  RecordProperty("sublights_percent", std::to_string(by_sublights));
  RecordProperty("light_percent", std::to_string(by_light));
  EXPECT_LT(by_sublights, 0.5 * by_light);
}

TEST(SideGather, SameOnAnyNumberOfThreads) {
  const Scene scene = load_scene(source_dir() / "data/thin_wall.glb");
  const auto run = [&](size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    const EmbreeScene embree(scene);
    const VirtualLightsCpu lights = virtual_lights_cpu(embree, EmitterPoints(scene), 512, true);
    return Gathered(scene, embree, make_grid(scene, 16, glm::vec3(0.0f)), lights, 5).irradiance;
  };
  const std::vector<glm::vec4> one = run(1);
  EXPECT_EQ(one, run(2));
  EXPECT_EQ(one, run(5));
}

// Few sides see every light, many share them.
TEST(SideGather, StrideFollowsTheNumberOfSides) {
  EXPECT_EQ(automatic_stride(0, 1024), 1);
  EXPECT_EQ(automatic_stride(512, 1024), 1);
  EXPECT_EQ(automatic_stride(513, 1024), 2);
  EXPECT_EQ(automatic_stride(8192, 1024), 16);
  EXPECT_EQ(automatic_stride(1000000, 1024), 32);
}

VolumeOptions first_bounce_options(std::optional<int> bounces) {
  VolumeOptions o;
  o.grid_cells = kPatches;
  o.source = VolumeOptions::Source::first_bounce;
  o.bounces = bounces;
  return o;
}

void run(VolumeCpu& volume, const Scene& scene, const VolumeOptions& options, int lights, int stride) {
  const EmbreeScene embree(scene);
  const VirtualLightsCpu list = virtual_lights_cpu(embree, EmitterPoints(scene), lights, true);
  volume.voxelize();
  volume.light_in(
      flux_after_first_bounce(volume.voxels(), embree, for_sides(list), options.bounces.has_value(), stride));
  volume.propagate();
  volume.irradiate();
}

/// Power that the volume's light brings to the walls [W].
double indirect_power(const Scene& scene, std::optional<int> bounces) {
  const VolumeOptions options = first_bounce_options(bounces);
  VolumeCpu volume(scene, options);
  run(volume, scene, options, 16384, 64);  // many, for their energy
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
    EXPECT_NEAR(indirect_power(lit, bounces), of_lamp, 0.025 * of_lamp) << bounces;
    EXPECT_NEAR(indirect_power(emissive, bounces), of_emitter, 0.025 * of_emitter) << bounces;
    EXPECT_NEAR(indirect_power(both, bounces), of_lamp + of_emitter, 0.025 * (of_lamp + of_emitter)) << bounces;
  }
  EXPECT_NEAR(indirect_power(both, {}) / ((rho + rho * rho) / (1.0 - rho)), 1.0, 0.025);
}

// As tests/hardcases/closed_box_test.cpp, but what sides start from is gathered.
TEST(VolumeAfterFirstBounce, TotalIndirectOfTheClosedBox) {
  Scene lit = closed_box();
  lit.lights = {lamp()};
  const std::vector<double> first = box().bounce(lamp_irradiance(), double(kAlbedo));
  std::vector<double> exact(first), order(first), total(first);
  for (int k = 0; k < 60; ++k) {
    order = box().bounce(order, double(kAlbedo));
    for (size_t i = 0; i < order.size(); ++i) exact[i] += order[i];
  }
  for (int stride : {1, 32}) {
    const VolumeOptions options = first_bounce_options({});
    VolumeCpu volume(lit, options);
    run(volume, lit, options, 1024, stride);
    total = first;
    for (size_t i = 0; i < volume.voxels().side_count(); ++i) {
      const Side& side = volume.voxels().sides()[i];
      const glm::ivec3 c = shared::cell_coord(volume.grid(), side.cell);
      const int axis = side.face >> 1;
      total[box().index(side.face, c[shared::axis_b(axis)], c[shared::axis_c(axis)])] +=
          double(volume.irradiance().indirect[i].x);
    }
    const double error = rmse_percent(total, exact);
    RecordProperty("rmse_percent_stride_" + std::to_string(stride), std::to_string(error));
    EXPECT_LT(error, 3.0) << stride;
  }
}

TEST(VolumeAfterFirstBounce, IsDarkWithoutLights) { EXPECT_EQ(indirect_power(closed_box(), {}), 0.0); }

}  // namespace
}  // namespace volgi::test
