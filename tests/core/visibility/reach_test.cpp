// What the camera and the lamps reach (docs/hard-cases.md, "plane").
#include "core/visibility/reach.h"

#include <gtest/gtest.h>

#include "tests/support/volume_scenes.h"

namespace volgi::test {
namespace {

const glm::vec3 kMiddle(0.0f, 1.3f, 0.0f);

/// A closed room of 4 x 2.6 x 4 m, and a plane of 200 m below it.
Scene room_on_a_plane(float below) {
  Scene scene;
  const int white = add_material(scene, glm::vec3(0.7f));
  add_box_inside(scene, white, kMiddle, {2.0f, 1.3f, 2.0f});
  add_quad(scene, white, {-100.0f, -below, -100.0f}, {0.0f, 0.0f, 200.0f}, {200.0f, 0.0f, 0.0f});
  return scene;
}

void expect_room(const Scene& scene, glm::vec3 from, float tolerance_m) {
  const auto box = reached_box(scene, std::span(&from, 1));
  ASSERT_TRUE(box.has_value());
  for (int axis = 0; axis < 3; ++axis) {
    const float half = axis == 1 ? 1.3f : 2.0f;
    EXPECT_NEAR(box->min[axis], kMiddle[axis] - half, tolerance_m);
    EXPECT_NEAR(box->max[axis], kMiddle[axis] + half, tolerance_m);
  }
}

TEST(Reach, ARoomIsReachedWithoutThePlaneBelowIt) { expect_room(room_on_a_plane(0.02f), kMiddle, 1e-5f); }

// Where the plane is the room's floor it sticks out by what is given to large triangles, a twentieth of the box's
// diagonal.
TEST(Reach, AFloorThatGoesOnCountsAsFarAsTheRoomGoes) {
  Scene scene = room_on_a_plane(0.0f);
  scene.meshes.erase(scene.meshes.begin() + 2);  // the box's own floor
  update_bounds(scene);
  expect_room(scene, kMiddle, 0.05f * std::sqrt(2.0f * 16.0f + 2.6f * 2.6f) + 1e-3f);
}

TEST(Reach, FromOutsideThePlaneIsReachedAndEmissionAlwaysIs) {
  Scene scene = room_on_a_plane(0.02f);
  const glm::vec3 above(10.0f, 5.0f, 0.0f);
  EXPECT_GT(reached_box(scene, std::span(&above, 1))->max.x, 90.0f);
  add_square(scene, add_material(scene, glm::vec3(0.0f), glm::vec3(1.0f)), {50.0f, 3.0f, 0.0f}, {0.0f, -1.0f, 0.0f},
             0.5f);
  EXPECT_GE(reached_box(scene, std::span(&kMiddle, 1))->max.x, 50.5f);
}

TEST(Reach, NothingIsReachedWhereNothingIs) {
  EXPECT_FALSE(reached_box(Scene(), std::span(&kMiddle, 1)).has_value());
  EXPECT_FALSE(reached_box(room_on_a_plane(0.02f), {}).has_value());
}

}  // namespace
}  // namespace volgi::test
