#include "core/visibility/room_camera.h"

#include <gtest/gtest.h>

#include <array>

#include "core/visibility/openness.h"
#include "tests/support/volume_scenes.h"

namespace volgi::test {
namespace {

bool inside(const Camera& camera, glm::vec3 low, glm::vec3 high) {
  const glm::vec3 eye(camera.world_from_camera[3]);
  return glm::all(glm::greaterThan(eye, low)) && glm::all(glm::lessThan(eye, high));
}

/// A room whose front faces look in, and a box in it whose front faces look out.
Scene furnished_room() {
  Scene scene;
  const int grey = add_material(scene, glm::vec3(0.5f));
  add_box_inside(scene, grey, glm::vec3(0.0f), {2.0f, 1.0f, 1.5f});
  add_quad(scene, grey, {-0.5f, -0.6f, -0.4f}, {0, 0, 0.8f}, {1.0f, 0, 0});
  update_bounds(scene);
  return scene;
}

TEST(RoomCamera, StandsInside) {
  const Scene scene = furnished_room();
  const auto camera = room_camera(scene);
  ASSERT_TRUE(camera);
  EXPECT_TRUE(inside(*camera, {-2, -1, -1.5f}, {2, 1, 1.5f}));
  const std::array from{glm::vec3(camera->world_from_camera[3])};
  EXPECT_LT(openness(scene, from), LEAST_OPENNESS);
  // The longest level way is nearly the diagonal.
  EXPECT_GT(std::abs(camera->world_from_camera[2].x), 0.7f);
}

TEST(RoomCamera, NotInsideABody) {
  Scene scene = furnished_room();
  for (Mesh& mesh : scene.meshes) {
    for (glm::uvec3& t : mesh.triangles) std::swap(t.y, t.z);
  }
  EXPECT_FALSE(room_camera(scene));
}

TEST(RoomCamera, NotInTheOpen) {
  Scene scene;
  add_quad(scene, add_material(scene, glm::vec3(0.5f)), {-5, 0, -5}, {0, 0, 10}, {10, 0, 0});
  update_bounds(scene);
  EXPECT_FALSE(room_camera(scene));
  EXPECT_FALSE(room_camera(Scene{}));
}

TEST(RoomCamera, WhereTheLampIs) {
  Scene scene;
  const int grey = add_material(scene, glm::vec3(0.5f));
  add_box_inside(scene, grey, {-3, 0, 0}, {2.5f, 1, 1.5f});
  add_box_inside(scene, grey, {2, 0, 0}, {1.5f, 1, 1.5f});
  scene.lights = {point_light({2.2f, 0.3f, 0.1f}, glm::vec3(1.0f))};
  update_bounds(scene);
  const auto camera = room_camera(scene);
  ASSERT_TRUE(camera);
  EXPECT_TRUE(inside(*camera, {0.5f, -1, -1.5f}, {3.5f, 1, 1.5f}));
}

}  // namespace
}  // namespace volgi::test
