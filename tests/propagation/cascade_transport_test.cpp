// `ordinates` through nested grids: what its operator must be, and one fine grid's answer inside.
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cstring>
#include <random>

#include "core/error.h"
#include "core/sky.h"
#include "propagation/bounces_cpu.h"
#include "propagation/light_in/direct_light_cpu.h"
#include "propagation/pixel_irradiance_cpu.h"
#include "propagation/transport_ordinates_cpu.h"
#include "propagation/volume_cpu.h"
#include "tests/support/volume_scenes.h"
#include "voxel/cascade_voxels.h"
#include "voxel/voxelize_cpu.h"

namespace volgi::test {
namespace {

using Powers = std::vector<glm::vec4>;

glm::dvec3 sum(const Powers& powers) {
  glm::dvec3 s(0.0);
  for (const glm::vec4& p : powers) s += glm::dvec3(p);
  return s;
}

const glm::vec3 HALF{14.0f, 6.0f, 9.0f};
glm::mat3 turn() { return glm::mat3(glm::rotate(glm::mat4(1.0f), 0.3f, glm::normalize(glm::vec3(0.2f, 1.0f, 0.1f)))); }

/// A closed room that no grid is parallel to, with boards in it, nested grids around its middle.
struct Room {
  Scene scene;
  Cascade cascade;
  std::vector<VoxelGrid> levels;
  VolumeSides sides;
  std::vector<bool> inside;  // by side: in the room

  Room(int ratio, int count)
      : scene(made()),
        cascade(nested(ratio, count)),
        levels(voxelize_cascade(scene, cascade, voxelization_mipmaps(scene))),
        sides(cascade, levels) {
    const glm::mat3 back = glm::transpose(turn());
    for (size_t i = 0; i < sides.count(); ++i) {
      const Grid& grid = sides.level(sides.level_of(i)).grid();
      const glm::vec3 middle = glm::vec3(shared::cell_coord(grid, sides[i].cell)) + 0.5f;
      inside.push_back(glm::all(glm::lessThan(glm::abs(back * shared::world_from_cell(grid, middle)), HALF)));
    }
  }
  Cascade nested(int ratio, int count) const {
    CascadeOptions options;
    options.levels = count;
    options.ratio = ratio;
    options.around = {1.0f, 0.5f, 2.0f};
    return make_cascade(make_grid(scene, 32), options);
  }
  Powers random_powers(unsigned seed) const {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> uniform(0.0f, 1.0f);
    Powers powers(sides.count(), glm::vec4(0.0f));
    for (size_t i = 0; i < powers.size(); ++i) {
      const glm::vec4 p(uniform(random), uniform(random), uniform(random), 0.0f);
      if (inside[i]) powers[i] = p;
    }
    return powers;
  }

 private:
  static Scene made() {
    Scene scene;
    const int grey = add_material(scene, glm::vec3(0.5f));
    add_box_inside(scene, grey, glm::vec3(0.0f), HALF, turn());
    add_square(scene, grey, glm::vec3(1.0f, -2.0f, 1.0f), turn() * glm::vec3(1.0f, 0.0f, 0.0f), 4.0f);
    add_square(scene, grey, glm::vec3(3.0f, 1.0f, 3.0f), glm::vec3(0.3f, 1.0f, 0.1f), 5.0f);
    return scene;
  }
};

Powers carry(OrdinatesTransportCpu& transport, const Powers& sent) {
  Powers received(sent.size(), glm::vec4(0.0f));
  BounceReport report;
  transport.carry(sent, received, BounceRules{}, report);
  return received;
}

struct Nested {
  int ratio, levels;
};
class CascadeTransport : public testing::TestWithParam<Nested> {};
INSTANTIATE_TEST_SUITE_P(All, CascadeTransport, testing::Values(Nested{2, 2}, Nested{2, 3}, Nested{4, 2}),
                         [](const auto& p) {
                           return "ratio" + std::to_string(p.param.ratio) + "levels" + std::to_string(p.param.levels);
                         });
constexpr OrdinateChoice CHOICES[] = {{24, Ordinates::step}, {128, Ordinates::characteristic}};

// Sums of floats in 10^5 cells: what power there is is kept to rounding, also at the rim's partly shut faces.
TEST_P(CascadeTransport, KeepsPower) {
  const Room room(GetParam().ratio, GetParam().levels);
  const Powers sent = room.random_powers(1);
  for (const OrdinateChoice choice : CHOICES) {
    OrdinatesTransportCpu transport(room.cascade, room.levels, choice);
    const glm::dvec3 before = sum(sent), after = sum(carry(transport, sent));
    for (int band = 0; band < 3; ++band) EXPECT_NEAR(after[band] / before[band], 1.0, 2e-6);
  }
}

// Even radiance stays even: no place of a rim shines or is dark.
TEST_P(CascadeTransport, IsExactInAFurnace) {
  const Room room(GetParam().ratio, GetParam().levels);
  Powers sent(room.sides.count(), glm::vec4(0.0f));
  for (size_t i = 0; i < sent.size(); ++i) {
    if (room.inside[i]) sent[i] = glm::vec4(glm::vec3(room.sides[i].face_m2), 0.0f);
  }
  for (const OrdinateChoice choice : CHOICES) {
    OrdinatesTransportCpu transport(room.cascade, room.levels, choice);
    const Powers received = carry(transport, sent);
    float worst = 0.0f;
    for (size_t i = 0; i < sent.size(); ++i) {
      if (room.inside[i]) worst = std::max(worst, std::abs(received[i].x / room.sides[i].face_m2 - 1.0f));
    }
    EXPECT_LT(worst, 2e-5f);
  }
}

TEST_P(CascadeTransport, IsReciprocalByAreaOfFaces) {
  const Room room(GetParam().ratio, GetParam().levels);
  std::mt19937 random(7);
  std::vector<size_t> some;
  for (size_t level = 0; level < room.sides.levels(); ++level) {
    for (int k = 0; k < 4;) {
      const size_t i = room.sides.first(level) + random() % room.levels[level].side_count();
      if (!room.inside[i]) continue;
      some.push_back(i);
      ++k;
    }
  }
  OrdinatesTransportCpu transport(room.cascade, room.levels, CHOICES[0]);
  std::vector<Powers> received;
  for (const size_t j : some) {
    Powers sent(room.sides.count(), glm::vec4(0.0f));
    sent[j] = glm::vec4(1e6f, 1e6f, 1e6f, 0.0f);
    received.push_back(carry(transport, sent));
  }
  int pairs = 0;
  for (size_t a = 0; a < some.size(); ++a) {
    for (size_t b = 0; b < a; ++b) {
      const double there = double(received[a][some[b]].x) / double(room.sides[some[b]].face_m2);
      const double back = double(received[b][some[a]].x) / double(room.sides[some[a]].face_m2);
      if (std::max(there, back) < 1e-6) continue;
      EXPECT_NEAR(there / back, 1.0, 1e-4);
      ++pairs;
    }
  }
  EXPECT_GT(pairs, 5);
}

TEST(CascadeTransportOf, OneLevelIsTheGridsToTheLastBit) {
  const Room room(2, 1);
  const Powers sent = room.random_powers(3);
  OrdinatesTransportCpu nested(room.cascade, room.levels, CHOICES[1]), plain(room.levels[0], CHOICES[1]);
  const Powers a = carry(nested, sent), b = carry(plain, sent);
  EXPECT_EQ(std::memcmp(a.data(), b.data(), a.size() * sizeof(glm::vec4)), 0);
}

// Nor on whether octants go at once or in turn.
TEST(CascadeTransportOf, NoNumberDependsOnThreads) {
  const Room room(2, 3);
  const Powers sent = room.random_powers(4);
  std::vector<Powers> answers;
  for (const size_t threads : {size_t(1), size_t(3)}) {
    for (const int octants_at_once : {1, 2, 8}) {
      const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
      OrdinatesTransportCpu transport(room.cascade, room.levels, CHOICES[0], {}, {.of_one = octants_at_once});
      answers.push_back(carry(transport, sent));
    }
  }
  for (const Powers& a : answers) EXPECT_EQ(std::memcmp(a.data(), answers[0].data(), a.size() * sizeof(glm::vec4)), 0);
}

TEST(CascadeTransportOf, ConjugateGradientsFindWhatOrdersFind) {
  const Room room(2, 2);
  SideFlux flux;
  flux.punctual = room.random_powers(5);
  flux.emitted.assign(room.sides.count(), glm::vec4(0.0f));
  std::vector<Powers> answers;
  for (const auto solver : {BounceRules::Solver::plain, BounceRules::Solver::conjugate_gradients}) {
    BounceRules rules;
    rules.solver = solver;
    BouncesCpu bounces(std::make_unique<OrdinatesTransportCpu>(room.cascade, room.levels, CHOICES[0]));
    EXPECT_TRUE(bounces.run(room.sides, flux, false, rules).converged);
    answers.push_back(bounces.received_indirect());
  }
  double difference = 0.0;
  for (size_t i = 0; i < answers[0].size(); ++i) difference += std::abs(double(answers[0][i].x - answers[1][i].x));
  EXPECT_LT(difference / sum(answers[0]).x, 2.0 * double(BounceRules::kTolerance));
}

/// Two squares with a street between houses, under an even sky.
Scene street() {
  Scene scene;
  const int grey = add_material(scene, glm::vec3(0.5f));
  add_quad(scene, grey, {-20.0f, 0.0f, -8.0f}, {0.0f, 0.0f, 16.0f}, {40.0f, 0.0f, 0.0f});
  for (const float z : {-6.0f, 6.0f}) {
    for (float x = -18.0f; x < 20.0f; x += 6.0f) add_box(scene, grey, {x, 2.5f, z}, {2.6f, 2.5f, 2.0f});
  }
  return scene;
}

std::vector<double> mean_of_ground(const VolumeCpu& volume, float reach_m) {
  std::vector<double> mean(2, 0.0);
  double area = 0.0;
  const VolumeSides sides = volume.sides();
  for (size_t level = 0; level < sides.levels(); ++level) {
    const VoxelGrid& voxels = sides.level(level);
    for (size_t i = 0; i < voxels.side_count(); ++i) {
      const shared::Side& side = voxels.sides()[i];
      const glm::vec3 at =
          shared::world_from_cell(voxels.grid(), glm::vec3(shared::cell_coord(voxels.grid(), side.cell)) + 0.5f);
      if (side.normal.y < 0.9f || at.y > 1.0f || std::abs(at.x) > reach_m || std::abs(at.z) > 3.0f) continue;
      mean[0] += double(side.area_m2) * double(volume.irradiance(level).direct[i].x);
      mean[1] += double(side.area_m2) * double(volume.irradiance(level).indirect[i].x);
      area += double(side.area_m2);
    }
  }
  for (double& m : mean) m /= area;
  return mean;
}

// The grid of all, its cells four times as coarse, is off by a fifth of the light that walls send to the ground.
TEST(CascadeVolume, IsNearOneFineGridWhereItIsFine) {
  Scene scene = street();
  scene.sky = std::make_shared<Sky>(glm::vec3(1.0f));
  VolumeOptions options;
  options.grid_cells = 128;
  options.scheme.directions = 128;
  options.scheme.ordinates = Ordinates::characteristic;
  VolumeCpu fine(scene, options);
  run_with_direct_light(fine, scene);
  options.grid_cells = 32;
  options.cascade.levels = 3;
  VolumeCpu nested(scene, options);
  run_with_direct_light(nested, scene);
  ASSERT_EQ(nested.levels().size(), 3u);
  EXPECT_FLOAT_EQ(nested.levels()[2].grid().cell_size_m, fine.grid().cell_size_m);
  const std::vector<double> truth = mean_of_ground(fine, 4.0f), found = mean_of_ground(nested, 4.0f);
  EXPECT_NEAR(found[0] / truth[0], 1.0, 0.02);
  EXPECT_NEAR(found[1] / truth[1], 1.0, 0.03);
  EXPECT_LT(nested.bytes(), fine.bytes());
}

Scene street_under_sky() {
  Scene scene = street();
  scene.sky = std::make_shared<Sky>(glm::vec3(1.0f));
  return scene;
}

VolumeOptions three_grids() {
  VolumeOptions options;
  options.grid_cells = 32;
  options.cascade.levels = 3;
  return options;
}

float ground_at(const VolumeCpu& volume, float x, float& weight) {
  const PixelIrradiance e = irradiance_at_pixel(volume.sides(), volume.irradiance_of_levels(), {x, 0.0f, 0.31f},
                                                {0.0f, 1.0f, 0.0f}, {0.0f, 2.0f, 0.0f, 1.0f});
  weight = e.weight;
  return e.direct.x + e.indirect.x;
}

// All along the street, through every rim: no dark line, and no step where cells become larger.
TEST(CascadeVolume, PixelsShowNoRims) {
  const Scene scene = street_under_sky();
  VolumeCpu volume(scene, three_grids());
  run_with_direct_light(volume, scene);
  float before = 0.0f, largest = 0.0f;
  for (float x = -17.0f; x <= 17.0f; x += 0.05f) {
    float weight = 0.0f;
    const float here = ground_at(volume, x, weight);
    ASSERT_GT(weight, 0.0f) << x;
    if (before > 0.0f) largest = std::max(largest, std::abs(here / before - 1.0f));
    before = here;
  }
  EXPECT_LT(largest, 0.03f);
}

// A step within a block of the grids around changes no bit; where the grids move on, what is near keeps its light.
TEST(CascadeVolume, MovesWithoutFlicker) {
  const Scene scene = street_under_sky();
  VolumeCpu volume(scene, three_grids());
  const auto look = [&](float x) {
    volume.move_cascade({x, 1.5f, 0.0f});
    run_with_direct_light(volume, scene);
    std::vector<float> seen;
    float weight = 0.0f;
    for (float at = -2.0f; at <= 2.0f; at += 0.1f) seen.push_back(ground_at(volume, at, weight));
    return seen;
  };
  const std::vector<float> first = look(0.0f);
  const Cascade cascade = volume.cascade();
  EXPECT_EQ(look(0.3f), first);
  EXPECT_TRUE(same_cascade(volume.cascade(), cascade));
  const std::vector<float> moved = look(3.0f);
  EXPECT_FALSE(same_cascade(volume.cascade(), cascade));
  float largest = 0.0f;
  for (size_t i = 0; i < first.size(); ++i) largest = std::max(largest, std::abs(moved[i] / first[i] - 1.0f));
  EXPECT_LT(largest, 0.02f);
}

TEST(CascadeVolume, IsRefusedWhereThereIsNone) {
  VolumeOptions options = three_grids();
  EXPECT_NO_THROW(refuse_on_cpu(options));
  try {
    refuse_on_gpu(options);
    FAIL();
  } catch (const Error& e) {
    EXPECT_EQ(e.code(), ExitCode::usage);
  }
  options.scheme.scheme = Scheme::conservative;
  EXPECT_THROW(refuse_on_cpu(options), Error);
}

TEST(CascadeVolume, BytesAreWhatIsExpected) {
  const Scene scene = street();
  VolumeOptions options;
  options.grid_cells = 32;
  options.cascade.levels = 3;
  VolumeCpu volume(scene, options);
  run_with_direct_light(volume, scene);
  EXPECT_NEAR(double(volume.bytes()) / double(bytes_expected_cpu(scene, volume.cascade(), options)), 1.0, 0.15);
}

}  // namespace
}  // namespace volgi::test
