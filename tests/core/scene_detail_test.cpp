// Where the detail of a scene on a large ground is.
#include "core/scene_detail.h"

#include <gtest/gtest.h>

namespace volgi {
namespace {

void add_quad(Scene& scene, glm::vec3 corner, glm::vec3 u, glm::vec3 v) {
  if (scene.meshes.empty()) scene.meshes.emplace_back();
  Mesh& mesh = scene.meshes[0];
  const auto first = glm::uint(mesh.positions.size());
  for (const glm::vec3& p : {corner, corner + u, corner + u + v, corner + v}) mesh.positions.push_back(p);
  mesh.triangles.push_back({first, first + 1, first + 2});
  mesh.triangles.push_back({first, first + 2, first + 3});
}

/// A room of 4 x 3 x 5 m, off the middle of its ground.
Scene room_on(float ground_m, int pieces) {
  Scene scene;
  for (const float x : {10.0f, 14.0f}) add_quad(scene, {x, 0, -8}, {0, 3, 0}, {0, 0, 5});
  add_quad(scene, {10, 0, -8}, {4, 0, 0}, {0, 3, 0});
  add_quad(scene, {10, 3, -8}, {4, 0, 0}, {0, 0, 5});
  add_quad(scene, {10, 0.001f, -8}, {4, 0, 0}, {0, 0, 5});
  const float piece = ground_m / float(pieces);
  for (int i = 0; i < pieces * pieces; ++i)
    add_quad(scene, {piece * float(i % pieces) - 0.5f * ground_m, -0.01f, piece * float(i / pieces) - 0.5f * ground_m},
             {0, 0, piece}, {piece, 0, 0});
  update_bounds(scene);
  return scene;
}

TEST(DetailBox, IsTheRoomOnItsGround) {
  for (const int pieces : {1, 40}) {
    const auto box = detail_box(room_on(200.0f, pieces));
    ASSERT_TRUE(box) << pieces;
    for (const auto& [point, inside] :
         {std::pair(glm::vec3(10, 0, -8), true), {{14, 3, -3}, true}, {{18, 0, -8}, false}}) {
      const bool in = glm::all(glm::lessThan(box->min, point)) && glm::all(glm::greaterThan(box->max, point));
      EXPECT_EQ(in, inside) << pieces << ' ' << point.x;
    }
  }
}

TEST(DetailBox, NoneWhereAllIsAlike) {
  EXPECT_FALSE(detail_box(Scene()));
  Scene town = room_on(40.0f, 1);
  for (const float x : {-18.0f, 18.0f}) add_quad(town, {x, 0, 15}, {1, 0, 0}, {0, 6, 0});
  update_bounds(town);
  EXPECT_FALSE(detail_box(town));
  Scene ground;
  add_quad(ground, {0, 0, 0}, {0, 0, 5}, {5, 0, 0});
  update_bounds(ground);
  EXPECT_FALSE(detail_box(ground));
}

}  // namespace
}  // namespace volgi
