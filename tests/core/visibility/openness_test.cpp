// Whether a scene is open to a sky that is not there.
#include "core/visibility/openness.h"

#include <gtest/gtest.h>

#include "tests/support/paths.h"

namespace volgi::test {
namespace {

double from_camera(const char* name) {
  const Scene scene = load_scene(source_dir() / "data" / (std::string(name) + ".glb"));
  const glm::vec3 eye(scene.cameras.at(0).world_from_camera[3]);
  return openness(scene, std::span(&eye, 1));
}

TEST(Openness, OfClosedAndOpenScenes) {
  for (const char* closed : {"closed_box", "furnace"}) EXPECT_EQ(from_camera(closed), 0.0) << closed;
  for (const char* open : {"cornell", "corridor"}) RecordProperty(open, std::to_string(from_camera(open)));
}

TEST(Openness, OfAPlaneIsWhatLiesAbove) {
  Scene scene;
  scene.materials.emplace_back();
  Mesh mesh;
  mesh.positions = {{-1e4f, 0, -1e4f}, {-1e4f, 0, 1e4f}, {1e4f, 0, 1e4f}, {1e4f, 0, -1e4f}};
  mesh.normals.assign(4, {0, 1, 0});
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  scene.meshes = {mesh};
  update_bounds(scene);
  const glm::vec3 above(0, 1, 0);
  EXPECT_NEAR(openness(scene, std::span(&above, 1)), 1.0, 0.01);  // down, then up
  EXPECT_EQ(openness(Scene(), std::span(&above, 1)), 0.0);
}

}  // namespace
}  // namespace volgi::test
