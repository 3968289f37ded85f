#pragma once
#include <glm/glm.hpp>

#include "core/scene.h"

namespace volgi::test {

/// A scene with all that is in it, turned about the world's origin.
inline Scene turned(Scene scene, const glm::mat3& turn) {
  for (Mesh& mesh : scene.meshes) {
    for (glm::vec3& p : mesh.positions) p = turn * p;
    for (glm::vec3& n : mesh.normals) n = turn * n;
  }
  for (Light& light : scene.lights) {
    light.position = turn * light.position;
    light.direction = turn * light.direction;
  }
  for (Camera& camera : scene.cameras) camera.world_from_camera = glm::mat4(turn) * camera.world_from_camera;
  update_bounds(scene);
  return scene;
}

}  // namespace volgi::test
