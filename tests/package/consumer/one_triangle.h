#pragma once
#include <core/camera.h>
#include <core/scene.h>

// A light of pi W/sr one metre above a triangle of albedo 1/2: the spot under it has the radiance 1/2.
inline volgi::Scene one_triangle() {
  volgi::Scene scene;
  volgi::Material material;
  material.base_color_factor = glm::vec4(0.5f, 0.5f, 0.5f, 1.0f);
  material.metallic_factor = 0.0f;
  scene.materials = {material};

  volgi::Mesh mesh;
  mesh.object_id = 1;
  mesh.positions = {{-2.0f, 0.0f, 2.0f}, {2.0f, 0.0f, 2.0f}, {0.0f, 0.0f, -2.0f}};
  mesh.normals.assign(3, glm::vec3(0.0f, 1.0f, 0.0f));
  mesh.triangles = {{0, 1, 2}};
  scene.meshes = {mesh};

  volgi::Light light;
  light.position = {0.0f, 1.0f, 0.0f};
  light.intensity = glm::vec3(3.14159265f);
  scene.lights = {light};
  volgi::update_bounds(scene);
  return scene;
}

// The spot is in the middle of the picture.
inline volgi::Camera camera_at_spot(const volgi::Scene& scene) {
  return volgi::look_at_camera({0.0f, 2.0f, 1.0f}, glm::vec3(0.0f), 0.5f, scene.bounds_min, scene.bounds_max);
}
