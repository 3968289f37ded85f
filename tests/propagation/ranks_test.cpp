// A volume that ranks hold together is that of one rank alone, bit for bit: sides, light, bounces, radiance.
#include <gtest/gtest.h>
#include <openvdb/openvdb.h>

#include <filesystem>
#include <map>
#include <mutex>

#include "core/error.h"
#include "core/ranks_in_threads.h"
#include "core/scene.h"
#include "core/sky.h"
#include "propagation/bounce_checkpoint.h"
#include "propagation/light_in/direct_light_cpu.h"
#include "propagation/volume_cpu.h"
#include "tests/support/paths.h"
#include "tests/support/volume_scenes.h"
#include "tests/voxel/white_pocket_scenes.h"
#include "voxel/voxelize_cpu.h"

namespace volgi::test {
namespace {

struct SideValues {
  shared::Side side;
  glm::vec4 direct, indirect, emitted, punctual;
};

/// What a volume has at its sides, by cell and face, and its radiance.
struct Answer {
  std::map<std::pair<int, int>, SideValues> sides;
  std::map<std::array<int, 3>, std::array<glm::vec3, 4>> radiance;
  glm::vec3 lost{0.0f};
  BounceReport report;

  void take(VolumeCpu& volume) {
    for (size_t i = 0; i < volume.voxels().side_count(); ++i) {
      const shared::Side& side = volume.voxels().sides()[i];
      const bool fresh = sides
                             .insert({{side.cell, side.face},
                                      {side, volume.irradiance().direct[i], volume.irradiance().indirect[i],
                                       volume.flux().emitted[i], volume.flux().punctual[i]}})
                             .second;
      EXPECT_TRUE(fresh) << "two ranks have the same side";
    }
    lost = volume.flux().lost;
    report = volume.report();
  }
  void take(const RadianceVolume& volume) {
    for (size_t k = 0; k < volume.sh.size(); ++k) {
      for (auto v = volume.sh[k]->cbeginValueOn(); v; ++v)
        radiance[{v.getCoord().x(), v.getCoord().y(), v.getCoord().z()}][k] = {(*v)[0], (*v)[1], (*v)[2]};
    }
  }
};

Answer answer_of(const Scene& scene, const VolumeOptions& options, int ranks,
                 const std::filesystem::path& checkpoint = {}) {
  Answer answer;
  std::mutex mutex;
  const auto work = [&](const Ranks* of) {
    VolumeCpu volume(scene, options, of);
    std::optional<BounceCheckpoint> kept;
    if (!checkpoint.empty()) volume.set_checkpoint(&kept.emplace(checkpoint, 1, of));
    run_with_direct_light(volume, scene);
    const RadianceVolume radiance = volume.radiance();
    const std::lock_guard lock(mutex);
    answer.take(volume);
    answer.take(radiance);
  };
  if (ranks == 1) {
    work(nullptr);
  } else {
    run_ranks_in_threads(ranks, [&](const Ranks& of) { work(&of); });
  }
  return answer;
}

template <class T>
bool same_bits(const T& a, const T& b) {
  return std::memcmp(&a, &b, sizeof(T)) == 0;
}

void expect_same(const Answer& one, const Answer& many, const std::string& what) {
  ASSERT_EQ(one.sides.size(), many.sides.size()) << what;
  size_t geometry = 0, flux = 0, irradiance = 0;
  for (auto a = one.sides.begin(), b = many.sides.begin(); a != one.sides.end(); ++a, ++b) {
    ASSERT_EQ(a->first, b->first) << what;
    geometry += !same_bits(a->second.side, b->second.side);
    flux += !same_bits(a->second.emitted, b->second.emitted) || !same_bits(a->second.punctual, b->second.punctual);
    irradiance += !same_bits(a->second.direct, b->second.direct) || !same_bits(a->second.indirect, b->second.indirect);
  }
  EXPECT_EQ(geometry, 0u) << what;
  EXPECT_EQ(flux, 0u) << what;
  EXPECT_EQ(irradiance, 0u) << what;
  EXPECT_TRUE(same_bits(one.lost, many.lost)) << what;
  EXPECT_TRUE(same_bits(one.report.sent, many.report.sent) && same_bits(one.report.left, many.report.left)) << what;
  EXPECT_EQ(one.report.passes, many.report.passes) << what;
  EXPECT_EQ(one.radiance == many.radiance, true) << what;
}

Scene data_scene(const char* name) { return load_scene(source_dir() / "data" / (std::string(name) + ".glb")); }

TEST(Ranks, OrdinatesBitEqualToOne) {
  for (const char* name : {"cornell", "room"}) {
    const Scene scene = data_scene(name);
    VolumeOptions options;
    options.grid_cells = name == std::string("cornell") ? 64 : 40;
    const Answer one = answer_of(scene, options, 1);
    EXPECT_GT(one.sides.size(), 5000u);
    EXPECT_TRUE(one.report.conjugate_gradients);
    for (int ranks : {2, 3, 4, 8})
      expect_same(one, answer_of(scene, options, ranks), fmt::format("{}, {}", name, ranks));
  }
}

// Without any tree of triangles: light meets faces of parts that are on other ranks.
TEST(Ranks, FirstLightByFacesBitEqualToOne) {
  const Scene scene = data_scene("cornell");
  VolumeOptions options;
  options.grid_cells = 40;
  options.bounces = 2;
  options.first_light = VolumeOptions::FirstLight::faces;
  const Answer one = answer_of(scene, options, 1);
  for (int ranks : {2, 3, 8}) expect_same(one, answer_of(scene, options, ranks), fmt::format("{}", ranks));
  options.first_light = VolumeOptions::FirstLight::rays;
  const Answer rays = answer_of(scene, options, 1);
  EXPECT_NEAR(double(rays.report.sent.y) / double(one.report.sent.y), 1.0, 0.02);
}

// More ranks than blocks along an axis, cells that fill no last block, and a sky that streams in at the rim.
TEST(Ranks, OddShapesUnderASky) {
  Scene scene;
  const int grey = add_material(scene, glm::vec3(0.6f)), lamp = add_material(scene, glm::vec3(0.2f), glm::vec3(3.0f));
  add_box_inside(scene, grey, glm::vec3(0.0f), {1.0f, 0.31f, 0.52f},
                 glm::mat3(glm::rotate(glm::mat4(1.0f), 0.3f, glm::vec3(1.0f, 2.0f, 3.0f))));
  scene.meshes.erase(scene.meshes.begin() + 3);  // open on one side
  add_square(scene, lamp, {0.2f, 0.1f, 0.0f}, {0.3f, 1.0f, 0.2f}, 0.1f);
  update_bounds(scene);
  scene.sky = std::make_shared<Sky>(glm::vec3(0.5f, 0.7f, 1.0f));
  for (const int cells : {7, 30, 45}) {
    VolumeOptions options;
    options.grid_cells = cells;
    const Answer one = answer_of(scene, options, 1);
    for (const int ranks : {2, 5, 8})
      expect_same(one, answer_of(scene, options, ranks), fmt::format("{} cells, {}", cells, ranks));
  }
}

// Places that no light leaves go on from part to part; orders one by one, and sweeps of few directions.
TEST(Ranks, WhiteMazesAndPlainOrders) {
  for (const PocketScene& pocket : pocket_scenes()) {
    Scene scene = pocket.scene;
    const int lamp = add_material(scene, glm::vec3(0.0f), glm::vec3(1.0f));
    add_square(scene, lamp, {-0.85f, 0.0f, 0.0f}, {1.0f, 0.0f, 0.0f}, 0.05f);
    VolumeOptions options;
    options.grid_cells = 40;
    options.bounces = 3;
    options.scheme.directions = 24;
    expect_same(answer_of(scene, options, 1), answer_of(scene, options, 4), pocket.name);
  }
}

// One rank has more cells than are searched by columns of bits, each of four has fewer.
TEST(Ranks, AreasOfSidesInALargeGrid) {
  Scene scene;
  add_box_inside(scene, add_material(scene, glm::vec3(0.6f)), glm::vec3(0.0f), glm::vec3(1.0f));
  scene.meshes.erase(scene.meshes.begin() + 1, scene.meshes.end());
  add_square(scene, 0, glm::vec3(0.1f), glm::vec3(0.5f, 0.7f, 0.6f), 0.3f);
  update_bounds(scene);
  const Grid grid = make_grid(scene, 264, glm::vec3(0.0f), GridBox{glm::vec3(-1.0f), glm::vec3(1.0f)});
  const Mipmaps mipmaps = voxelization_mipmaps(scene);
  std::map<std::pair<int, int>, shared::Side> one, many;
  std::mutex mutex;
  const auto take = [&mutex](const VoxelGrid& voxels, auto& into) {
    const std::lock_guard lock(mutex);
    for (size_t i = 0; i < voxels.side_count(); ++i)
      into.insert({{voxels.sides()[i].cell, voxels.sides()[i].face}, voxels.sides()[i]});
  };
  take(voxelize_cpu(scene, grid, mipmaps), one);
  run_ranks_in_threads(4, [&](const Ranks& ranks) {
    take(voxelize_cpu(scene, grid, mipmaps, {ranks, Decomposition(leaf_blocks(grid), 4)}), many);
  });
  EXPECT_GT(cell_count(grid), size_t(1) << 24);
  EXPECT_GT(one.size(), 70000u);
  const auto same = [](const auto& a, const auto& b) { return a.first == b.first && same_bits(a.second, b.second); };
  EXPECT_TRUE(std::equal(one.begin(), one.end(), many.begin(), many.end(), same));
}

// Passes over a volume whose parts show each other their outermost cells after each.
TEST(Ranks, ConservativeBitEqualToOne) {
  for (const char* name : {"cornell", "room"}) {
    const Scene scene = data_scene(name);
    VolumeOptions options;
    options.scheme.scheme = Scheme::conservative;
    options.scheme.coarse_start = false;
    options.grid_cells = 28;
    options.bounces = 1;
    const Answer one = answer_of(scene, options, 1);
    EXPECT_GT(one.report.passes, 50);
    for (const int ranks : {3, 8})
      expect_same(one, answer_of(scene, options, ranks), fmt::format("{}, {}", name, ranks));
  }
}

// What is left of a pulse ends on the coarse grid, whose leaves are one rank's with their fine ones; in odd shapes, and
// with half steps, which orders one by one begin with.
TEST(Ranks, ConservativeCoarseGridBitEqualToOne) {
  for (const int cells : {28, 45}) {
    const Scene scene = data_scene(cells == 28 ? "cornell" : "room");
    VolumeOptions options;
    options.scheme.scheme = Scheme::conservative;
    options.grid_cells = cells;
    options.bounces = 1;
    const Answer one = answer_of(scene, options, 1);
    EXPECT_GT(one.report.passes, 30);
    for (const int ranks : {2, 3, 4}) expect_same(one, answer_of(scene, options, ranks), fmt::format("{}", ranks));
    options.iterations = 6;  // most of the light goes on coarsely
    expect_same(answer_of(scene, options, 1), answer_of(scene, options, 4), "half steps");
  }
}

// A run that has ended early goes on as another number of ranks, to what one rank has without any stop.
TEST(Ranks, GoOnFromACheckpoint) {
  const std::filesystem::path folder = std::filesystem::temp_directory_path() / "volgi_ranks_checkpoint";
  for (const std::optional<int> bounces : {std::optional<int>(), std::optional(6)}) {
    std::filesystem::remove_all(folder);
    const Scene scene = data_scene("cornell");
    VolumeOptions options;
    options.grid_cells = 24;
    options.bounces = bounces;
    const Answer whole = answer_of(scene, options, 1);
    VolumeOptions shorter = options;
    shorter.iterations = 3;
    if (!bounces) shorter.solver = BounceRules::Solver::conjugate_gradients;
    const Answer stopped = answer_of(scene, shorter, 3, folder);
    EXPECT_LT(stopped.report.passes, whole.report.passes);
    expect_same(whole, answer_of(scene, options, 2, folder), "two ranks go on");
    expect_same(whole, answer_of(scene, options, 1, folder), "one rank repeats the last pass");
  }
  VolumeOptions other;
  other.grid_cells = 25;
  EXPECT_THROW(answer_of(data_scene("cornell"), other, 2, folder), Error);
  for (const auto& file : std::filesystem::directory_iterator(folder)) {
    if (file.path().extension() == ".part") std::filesystem::resize_file(file.path(), 1000);
  }
  other.grid_cells = 24;
  other.bounces = 6;
  EXPECT_THROW(answer_of(data_scene("cornell"), other, 2, folder), Error);
  std::filesystem::remove_all(folder);
}

// What a rank takes follows its part, and is known before.
TEST(Ranks, MemoryOfARank) {
  const Scene scene = data_scene("cornell");
  VolumeOptions options;
  options.grid_cells = 128;
  options.bounces = 0;
  std::mutex mutex;
  size_t largest = 0;
  const auto bytes_of = [&](const Ranks* of) {
    VolumeCpu volume(scene, options, of);
    run_with_direct_light(volume, scene);
    const size_t expected =
        of != nullptr ? bytes_expected_cpu(scene, volume.grid(), options, *volume.ranks())
                      : bytes_expected_cpu(scene, volume.grid(), options, expected_sides(scene, volume.grid()));
    const std::lock_guard lock(mutex);
    EXPECT_NEAR(double(expected), double(volume.bytes()), 0.1 * double(volume.bytes()));
    largest = std::max(largest, volume.bytes());
  };
  bytes_of(nullptr);
  const size_t one = std::exchange(largest, 0);
  run_ranks_in_threads(8, [&](const Ranks& of) { bytes_of(&of); });
  EXPECT_LE(double(largest), double(one) / 6.0) << one;
  RecordProperty("one_over_largest_of_8", std::to_string(double(one) / double(largest)));
}

// Under a limit that even parts would exceed, ranks keep less at once, and then are cut by what they need: the same
// numbers, and a limit below that is refused.
TEST(Ranks, LeanUnderALimit) {
  const Scene scene = data_scene("cornell");
  VolumeOptions options;
  options.grid_cells = 64;
  const Answer one = answer_of(scene, options, 1);
  const auto largest_need = [&](VolumeOptions limited, bool& lean, bool& even) {
    std::mutex mutex;
    size_t largest = 0;
    run_ranks_in_threads(4, [&](const Ranks& ranks) {
      const VolumeCpu volume(scene, limited, &ranks);
      const size_t need = bytes_expected_cpu(scene, volume.grid(), options, *volume.ranks());
      const std::lock_guard lock(mutex);
      largest = std::max(largest, need);
      lean = volume.ranks()->lean;
      even = volume.ranks()->part() == Decomposition(leaf_blocks(volume.grid()), 4).part(ranks.rank());
    });
    return largest;
  };
  bool lean = true, even = false;
  size_t need = largest_need(options, lean, even);
  EXPECT_TRUE(!lean && even);
  for (const bool cut : {false, true}) {
    options.memory_limit = need - 1;
    const size_t less = largest_need(options, lean, even);
    EXPECT_LT(less, need);
    EXPECT_TRUE(lean);
    EXPECT_EQ(even, !cut);
    expect_same(one, answer_of(scene, options, 4), cut ? "cut by need" : "lean");
    need = less;
  }
  options.memory_limit = need - 1;
  EXPECT_THROW(answer_of(scene, options, 4), Error);
}

// One that throws does not leave the others waiting.
TEST(Ranks, OneThatFailsEndsAll) {
  EXPECT_THROW(run_ranks_in_threads(3,
                                    [](const Ranks& ranks) {
                                      if (ranks.rank() == 1) throw std::runtime_error("gone");
                                      std::array<std::int64_t, 1> one{1};
                                      ranks.add(one);
                                    }),
               std::runtime_error);
}

}  // namespace
}  // namespace volgi::test
