#pragma once
// Small scenes built in code, and their direct light through the screen passes.
#include <cmath>
#include <glm/glm.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "core/gl/context.h"
#include "core/image.h"
#include "core/scene.h"
#include "screen/base/direct.h"
#include "screen/base/gbuffer.h"
#include "screen/base/image_from_texture.h"
#include "screen/base/reflective_shadow_map.h"

namespace volgi::test {

inline int add_material(Scene& scene, glm::vec3 albedo) {
  Material material;
  material.base_color_factor = glm::vec4(albedo, 1.0f);
  material.metallic_factor = 0.0f;
  scene.materials.push_back(material);
  return int(scene.materials.size()) - 1;
}

inline Mesh& add_mesh(Scene& scene, int material) {
  Mesh mesh;
  mesh.material = material;
  mesh.object_id = std::uint32_t(scene.meshes.size() + 1);
  scene.meshes.push_back(mesh);
  return scene.meshes.back();
}

/// Quad corner, corner + u, corner + u + v, corner + v; front side along cross(u, v); uv set 0 from (0,0) to (1,1).
inline void append_quad(Mesh& mesh, glm::vec3 corner, glm::vec3 u, glm::vec3 v) {
  const auto first = glm::uint(mesh.positions.size());
  const glm::vec3 normal = glm::normalize(glm::cross(u, v));
  for (const glm::vec2 at : {glm::vec2(0, 0), glm::vec2(1, 0), glm::vec2(1, 1), glm::vec2(0, 1)}) {
    mesh.positions.push_back(corner + at.x * u + at.y * v);
    mesh.normals.push_back(normal);
    mesh.uv[0].push_back(at);
  }
  mesh.triangles.push_back({first, first + 1, first + 2});
  mesh.triangles.push_back({first, first + 2, first + 3});
}

inline Mesh& add_quad(Scene& scene, int material, glm::vec3 corner, glm::vec3 u, glm::vec3 v) {
  Mesh& mesh = add_mesh(scene, material);
  append_quad(mesh, corner, u, v);
  return mesh;
}

/// Box of the given size on the plane y = middle.y, turned about Y.
inline void add_box(Scene& scene, int material, glm::vec3 bottom_middle, glm::vec3 size, float turn_rad) {
  const glm::vec3 x = size.x * glm::vec3(std::cos(turn_rad), 0.0f, -std::sin(turn_rad));
  const glm::vec3 z = size.z * glm::vec3(std::sin(turn_rad), 0.0f, std::cos(turn_rad));
  const glm::vec3 y(0.0f, size.y, 0.0f);
  const glm::vec3 o = bottom_middle - 0.5f * (x + z);
  Mesh& mesh = add_mesh(scene, material);
  append_quad(mesh, o + y, z, x);
  append_quad(mesh, o, x, z);
  append_quad(mesh, o, z, y);
  append_quad(mesh, o + x, y, z);
  append_quad(mesh, o, y, x);
  append_quad(mesh, o + z, x, y);
}

/// Sphere of 2 n² triangles with interpolated normals.
inline void add_sphere(Scene& scene, int material, glm::vec3 middle, float radius, int n) {
  Mesh& mesh = add_mesh(scene, material);
  for (int j = 0; j <= n; ++j) {
    for (int i = 0; i <= n; ++i) {
      const float theta = glm::pi<float>() * float(j) / float(n);
      const float phi = glm::two_pi<float>() * float(i) / float(n);
      const glm::vec3 d(std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi));
      mesh.positions.push_back(middle + radius * d);
      mesh.normals.push_back(d);
    }
  }
  for (glm::uint j = 0; j < glm::uint(n); ++j) {
    for (glm::uint i = 0; i < glm::uint(n); ++i) {
      const glm::uint k = j * glm::uint(n + 1) + i;
      const glm::uint below = k + glm::uint(n + 1);
      mesh.triangles.push_back({k, k + 1, below});
      mesh.triangles.push_back({k + 1, below + 1, below});
    }
  }
}

inline Light point_light(glm::vec3 position, float intensity) {
  Light light;
  light.type = Light::Type::point;
  light.position = position;
  light.intensity = intensity * glm::vec3(1.0f, 0.8f, 0.6f);
  return light;
}

inline Light spot_light(glm::vec3 position, glm::vec3 direction, float inner_deg, float outer_deg, float intensity) {
  Light light = point_light(position, intensity);
  light.type = Light::Type::spot;
  light.direction = glm::normalize(direction);
  light.inner_cone_rad = glm::radians(inner_deg);
  light.outer_cone_rad = glm::radians(outer_deg);
  return light;
}

inline Light sun_light(glm::vec3 direction, float irradiance) {
  Light light = point_light(glm::vec3(0.0f), irradiance);
  light.type = Light::Type::directional;
  light.direction = glm::normalize(direction);
  return light;
}

/// Floor, back wall, a box that stands on the floor, a plate in the air. About 4 m.
inline Scene stage() {
  Scene scene;
  const int grey = add_material(scene, glm::vec3(0.7f));
  const int red = add_material(scene, glm::vec3(0.8f, 0.2f, 0.1f));
  add_quad(scene, grey, {-2, 0, -2}, {0, 0, 4}, {4, 0, 0});
  add_quad(scene, grey, {-2, 0, -2}, {4, 0, 0}, {0, 3, 0});
  add_box(scene, red, {0.3f, 0.0f, 0.2f}, {0.9f, 0.8f, 0.7f}, 0.5f);
  add_quad(scene, red, {-1.5f, 0.9f, -0.6f}, {0.0f, 0.2f, 0.9f}, {0.8f, 0.0f, 0.1f});
  update_bounds(scene);
  return scene;
}

inline Camera stage_camera(const Scene& scene) {
  return look_at_camera({0.8f, 2.2f, 4.5f}, {0.0f, 0.6f, 0.0f}, 0.75f, scene.bounds_min, scene.bounds_max);
}

struct DirectPicture {
  Image radiance, albedo, emission;
  std::vector<float> object_id;  // row 0 at the top
};

inline DirectPicture render_direct(const gl::Context& context, const Scene& scene, const Camera& camera,
                                   glm::ivec2 size, screen::ReflectiveShadowMap::Resolution resolution = {}) {
  gl::PassTimer timer(context.software(), false);
  const gl::SceneBuffers buffers(scene);
  screen::GBuffer gbuffer(size);
  screen::ReflectiveShadowMap maps(resolution);
  screen::Direct direct(size);
  gbuffer.run(buffers, camera, timer);
  maps.run(buffers, scene, timer);
  direct.run(gbuffer, camera, maps, timer);
  DirectPicture picture{screen::image_from_texture(direct.radiance()),
                        screen::image_from_texture(gbuffer.albedo()),
                        screen::image_from_texture(gbuffer.emission()),
                        {}};
  const std::vector<float> ids = gbuffer.object_id().download(1);
  for (int y = size.y - 1; y >= 0; --y) {
    const auto row = ids.begin() + std::ptrdiff_t(y) * size.x;
    picture.object_id.insert(picture.object_id.end(), row, row + size.x);
  }
  return picture;
}

}  // namespace volgi::test
