#include <gtest/gtest.h>

#include <memory>

#include "core/scene.h"
#include "core/sky.h"

namespace volgi {
namespace {

/// A triangle at the world's (1, 0, 0) from an origin elsewhere, with a texture, a light and a camera.
Scene some_scene(const glm::dvec3& origin) {
  Scene scene;
  scene.world_origin = origin;
  scene.images.resize(1);
  scene.textures = {{0, {}}};
  scene.materials.resize(2);
  scene.materials[1].base_color.texture = 0;
  Mesh mesh;
  mesh.material = 1;
  mesh.object_id = 3;
  const glm::vec3 at(glm::dvec3(1.0, 0.0, 0.0) - origin);
  mesh.positions = {at, at + glm::vec3(1.0f, 0.0f, 0.0f), at + glm::vec3(0.0f, 1.0f, 0.0f)};
  mesh.normals.assign(3, glm::vec3(0.0f, 0.0f, 1.0f));
  mesh.triangles = {{0, 1, 2}};
  scene.meshes = {mesh};
  scene.lights.resize(1);
  scene.lights[0].position = at;
  scene.cameras.resize(1);
  scene.cameras[0].world_from_camera[3] = glm::vec4(at, 1.0f);
  update_bounds(scene);
  return scene;
}

TEST(AppendScene, PutsThingsWhereTheyAreInTheWorld) {
  Scene scene = some_scene({10.0, 0.0, 0.0});
  const Scene other = some_scene({-5.0, 2.0, 0.0});
  append_scene(scene, other);
  ASSERT_EQ(scene.meshes.size(), 2u);
  EXPECT_EQ(scene.meshes[0].positions[0], scene.meshes[1].positions[0]);  // both at the world's (1, 0, 0)
  EXPECT_EQ(scene.lights[0].position, scene.lights[1].position);
  EXPECT_EQ(scene.cameras[0].world_from_camera[3], scene.cameras[1].world_from_camera[3]);
  EXPECT_EQ(scene.meshes[1].material, 3);
  EXPECT_EQ(scene.materials[3].base_color.texture, 1);
  EXPECT_EQ(scene.textures[1].image, 1);
  EXPECT_GT(scene.meshes[1].object_id, scene.meshes[0].object_id);
  EXPECT_EQ(scene.bounds_min, scene.meshes[0].positions[0]);
}

TEST(AppendScene, BoundsGrowAndASkyIsTaken) {
  Scene scene = some_scene(glm::dvec3(0.0));
  Scene other = some_scene(glm::dvec3(0.0));
  for (glm::vec3& p : other.meshes[0].positions) p.x += 7.0f;
  update_bounds(other);
  other.sky = std::make_shared<Sky>(glm::vec3(1.0f));
  append_scene(scene, other);
  EXPECT_EQ(scene.bounds_min.x, 1.0f);
  EXPECT_EQ(scene.bounds_max.x, 9.0f);
  EXPECT_EQ(scene.sky, other.sky);
  Scene nothing;
  append_scene(nothing, other);
  EXPECT_EQ(nothing.bounds_min, other.bounds_min);
}

}  // namespace
}  // namespace volgi
