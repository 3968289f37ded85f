#pragma once
#include <glm/glm.hpp>
#include <vector>

#include "core/camera.h"
#include "core/scene.h"

/// Small scenes built in code, for tests that know the answer.
namespace volgi::test {

inline int add_material(Scene& scene, glm::vec3 albedo, glm::vec3 emission = glm::vec3(0.0f)) {
  Material material;
  material.base_color_factor = glm::vec4(albedo, 1.0f);
  material.metallic_factor = 0.0f;
  material.emissive_radiance = emission;
  scene.materials.push_back(material);
  return static_cast<int>(scene.materials.size()) - 1;
}

/// Parallelogram centre ± a ± b; its front is a x b.
inline Mesh& add_quad(Scene& scene, int material, glm::vec3 centre, glm::vec3 a, glm::vec3 b) {
  Mesh mesh;
  mesh.material = material;
  mesh.object_id = static_cast<std::uint32_t>(scene.meshes.size()) + 1;
  mesh.positions = {centre - a - b, centre + a - b, centre + a + b, centre - a + b};
  mesh.normals.assign(4, glm::normalize(glm::cross(a, b)));
  mesh.uv[0] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  scene.meshes.push_back(mesh);
  return scene.meshes.back();
}

/// Six quads whose fronts look inwards.
inline void add_box_inside(Scene& scene, int material, glm::vec3 centre, glm::vec3 half) {
  for (int axis = 0; axis < 3; ++axis)
    for (float side : {-1.0f, 1.0f}) {
      glm::vec3 normal(0.0f), a(0.0f), b(0.0f);
      normal[axis] = side * half[axis];
      a[(axis + 1) % 3] = half[(axis + 1) % 3];
      b[(axis + 2) % 3] = -side * half[(axis + 2) % 3];
      add_quad(scene, material, centre + normal, a, b);
    }
}

/// Latitude-longitude sphere around the origin, smooth normals, front inwards.
inline void add_sphere_inside(Scene& scene, int material, float radius, int rings) {
  Mesh mesh;
  mesh.material = material;
  mesh.object_id = static_cast<std::uint32_t>(scene.meshes.size()) + 1;
  const int segments = 2 * rings;
  for (int i = 0; i <= rings; ++i)
    for (int j = 0; j <= segments; ++j) {
      const float theta = 3.14159265f * static_cast<float>(i) / static_cast<float>(rings);
      const float phi = 2 * 3.14159265f * static_cast<float>(j) / static_cast<float>(segments);
      const glm::vec3 n(std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi));
      mesh.positions.push_back(radius * n);
      mesh.normals.push_back(-n);
    }
  const auto row = static_cast<std::uint32_t>(segments) + 1;
  for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(rings); ++i)
    for (std::uint32_t j = 0; j + 1 < row; ++j) {
      const std::uint32_t k = i * row + j;
      mesh.triangles.push_back({k, k + row, k + 1});
      mesh.triangles.push_back({k + 1, k + row, k + row + 1});
    }
  scene.meshes.push_back(mesh);
}

inline Light point_light(glm::vec3 position, glm::vec3 intensity) {
  Light light;
  light.position = position;
  light.intensity = intensity;
  return light;
}

/// Looks from `eye` towards `target`; perspective, or orthographic with half height `ymag`.
inline Camera camera_at(glm::vec3 eye, glm::vec3 target, float yfov_rad = 0.5f, float ymag = 0.0f) {
  const glm::vec3 back = glm::normalize(eye - target);
  const glm::vec3 helper = std::abs(back.y) < 0.9f ? glm::vec3(0, 1, 0) : glm::vec3(1, 0, 0);
  const glm::vec3 right = glm::normalize(glm::cross(helper, back));
  Camera camera;
  camera.kind = ymag > 0 ? Camera::Kind::orthographic : Camera::Kind::perspective;
  camera.yfov_rad = yfov_rad;
  camera.ymag = ymag;
  camera.world_from_camera =
      glm::mat4(glm::vec4(right, 0), glm::vec4(glm::cross(back, right), 0), glm::vec4(back, 0), glm::vec4(eye, 1));
  return camera;
}

}  // namespace volgi::test
