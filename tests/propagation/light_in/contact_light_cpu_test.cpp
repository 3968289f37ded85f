// Light between surfaces that are nearer to each other than cells are large.
#include "propagation/light_in/contact_light_cpu.h"

#include <gtest/gtest.h>

#include <cmath>

#include "propagation/light_in/direct_light_cpu.h"
#include "propagation/light_in/final_gather_cpu.h"
#include "propagation/volume_cpu.h"
#include "tests/support/volume_scenes.h"

namespace volgi::test {
namespace {

constexpr float PI = glm::pi<float>();

/// Of points that a viewer sees straight on, near and far together.
std::vector<glm::vec3> irradiance_at(const VoxelGrid& voxels, const EmbreeScene& embree, const ContactSides& sides,
                                     std::vector<ContactPoint> points, int paths) {
  for (size_t i = 0; i < points.size(); ++i) {
    points[i].way = -points[i].normal;
    points[i].distance_m = 0.1f;
    points[i].seed = std::uint32_t(i);
  }
  std::vector<glm::vec3> found;
  for (const ContactLight& light : contact_light(voxels, embree, sides, points, paths))
    found.push_back(light.near.irradiance + light.far.irradiance);
  return found;
}

/// A volume that starts from what sides reflect of emission, as after a first bounce on the screen.
struct AfterFirstBounce {
  AfterFirstBounce(const Scene& of, int cells) : scene(of), embree(scene), volume(scene, options(cells)) {
    run_with_direct_light(volume, scene);
  }
  static VolumeOptions options(int cells) {
    VolumeOptions o;
    o.grid_cells = cells;
    return o;
  }
  /// @param arrival  of emission on all sides alike [W m^-2].
  void gather(float arrival) {
    FinalGatherCpu::Sent sent;
    for (const shared::Side& side : volume.voxels().sides())
      sent.reflected.push_back(side.area_m2 * side.albedo * arrival);
    rays.run(volume.voxels(), embree, volume.passages(), sent, volume.irradiance().indirect,
             std::vector<bool>(cell_count(volume.grid()), true), 64);
  }

  Scene scene;
  EmbreeScene embree;
  VolumeCpu volume;
  FinalGatherCpu rays;
};

// rho pi L / (1 - rho) of what comes after the first arrival (docs/theory.md#sources: the furnace), in corners as on
// walls: what is near and what is far make a whole, and emission counts where it has been reflected.
TEST(ContactLight, AFurnaceIsEven) {
  Scene scene;
  const float albedo = 0.6f, radiance = 1.5f;
  add_box_inside(scene, add_material(scene, glm::vec3(albedo), glm::vec3(radiance)), glm::vec3(0.0f),
                 glm::vec3(1.0f, 0.8f, 0.9f));
  AfterFirstBounce v(scene, 12);
  v.gather(PI * radiance);
  const FinalGatherCpu::Near near = v.rays.near_light(v.volume.voxels(), v.embree);
  const float right = albedo * PI * radiance / (1.0f - albedo);
  EXPECT_NEAR(near.mean / right, 1.0f, 0.02f);
  const auto found = irradiance_at(v.volume.voxels(), v.embree, {v.rays.radiosity(), near.from_far},
                                   {{{0.0f, -0.8f, 0.0f}, {0, 1, 0}},
                                    {{0.97f, -0.8f, 0.0f}, {0, 1, 0}},
                                    {{-0.98f, -0.8f, -0.89f}, {0, 1, 0}},
                                    {{1.0f, 0.7f, 0.5f}, {-1, 0, 0}}},
                                   2048);
  for (const size_t wall : {0, 1, 3}) EXPECT_NEAR(found[wall].y / right, 1.0f, 0.03f) << wall;
  // 1.06: right at an edge less comes from afar than the middle of a side says.
  EXPECT_NEAR(found[2].y / right, 1.0f, 0.08f);
}

// Between two large plates a hundredth of a cell apart, one of which glows, all light comes from that hundredth:
// arrival pi L on the upper one, and what goes to and fro is rho_u rho_l pi L / (1 - rho_u rho_l), which the volume, to
// which both plates are one face, cannot know. What sides say counts for nothing here.
TEST(ContactLight, GoesToAndFroInASlotOfNoCell) {
  Scene scene;
  const float upper = 0.8f, lower = 0.5f, radiance = 2.0f;
  const int dark = add_material(scene, glm::vec3(upper)), lamp = add_material(scene, glm::vec3(lower));
  scene.materials[size_t(lamp)].emissive_radiance = glm::vec3(radiance);
  add_quad(scene, dark, {-1, 0.001f, -1}, {2, 0, 0}, {0, 0, 2});  // looks down
  add_quad(scene, lamp, {-1, 0, 1}, {2, 0, 0}, {0, 0, -2});       // and up
  add_quad(scene, dark, {-1, -0.8f, 1}, {2, 0, 0}, {0, 0, -2});
  AfterFirstBounce v(scene, 16);
  const std::vector<glm::vec3> none(v.volume.voxels().side_count(), glm::vec3(0.0f));
  const auto found =
      irradiance_at(v.volume.voxels(), v.embree, {none, none}, {{{0.1f, 0.001f, 0.2f}, {0, -1, 0}}}, 8192);
  const float right = upper * lower * PI * radiance / (1.0f - upper * lower);
  EXPECT_NEAR(found[0].x / right, 1.0f, 0.03f);
}

// Several lamps: one is asked for all, each as often as it counts; what stands before one holds back its light alone.
TEST(ContactLight, OneLampStandsForAllInTheMean) {
  Scene scene;
  const int grey = add_material(scene, glm::vec3(0.5f));
  add_quad(scene, grey, {-2, 0, 2}, {4, 0, 0}, {0, 0, -4});
  add_quad(scene, grey, {0.5f, 1.0f, 0.5f}, {1, 0, 0}, {0, 0, -1});
  const auto lamp = [](glm::vec3 at, float intensity) {
    Light light;
    light.type = Light::Type::point;
    light.position = at;
    light.intensity = glm::vec3(intensity);
    return light;
  };
  scene.lights = {lamp({0, 2, 0}, 4.0f), lamp({-1, 1, 0}, 1.0f), lamp({2, 2, 0}, 50.0f)};  // the last one hidden
  update_bounds(scene);
  const EmbreeScene embree(scene);
  double sum = 0.0;
  constexpr int SEEDS = 40000;
  for (int seed = 0; seed < SEEDS; ++seed) {
    sum += double(radiosity_by_lamps(embree, {0, 1e-4f, 0}, {0, 1, 0}, glm::vec3(0.5f), std::uint32_t(seed)).y);
  }
  const double right = 0.5 * (4.0 / 4.0 + 1.0 / 2.0 / std::sqrt(2.0));
  EXPECT_NEAR(sum / SEEDS / right, 1.0, 0.05);
}

}  // namespace
}  // namespace volgi::test
