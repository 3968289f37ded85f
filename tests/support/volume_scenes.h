#pragma once
// Small scenes built in code for the tests of the volume.
#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <string>

#include "core/scene.h"
#include "shaders/shared/grid.shared.h"

namespace volgi::test {

inline int add_material(Scene& scene, glm::vec3 albedo, glm::vec3 emission = glm::vec3(0.0f)) {
  Material material;
  material.base_color_factor = glm::vec4(albedo, 1.0f);
  material.metallic_factor = 0.0f;
  material.emissive_radiance = emission;
  scene.materials.push_back(material);
  return int(scene.materials.size()) - 1;
}

/// Quad corner, corner + u, corner + u + v, corner + v; front along cross(u, v); uv set 0 from (0,0) to (1,1).
inline Mesh& add_quad(Scene& scene, int material, glm::vec3 corner, glm::vec3 u, glm::vec3 v) {
  Mesh mesh;
  mesh.material = material;
  mesh.object_id = std::uint32_t(scene.meshes.size()) + 1;
  mesh.positions = {corner, corner + u, corner + u + v, corner + v};
  mesh.normals.assign(4, glm::normalize(glm::cross(u, v)));
  mesh.uv[0] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  scene.meshes.push_back(mesh);
  update_bounds(scene);
  return scene.meshes.back();
}

/// Square of edge 2 * half_edge around `centre`, front along `normal`.
inline Mesh& add_square(Scene& scene, int material, glm::vec3 centre, glm::vec3 normal, float half_edge) {
  const glm::vec3 n = glm::normalize(normal);
  const glm::vec3 a = glm::normalize(glm::cross(n, std::abs(n.x) < 0.9f ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0)));
  const glm::vec3 b = glm::cross(n, a);
  return add_quad(scene, material, centre - half_edge * (a + b), 2.0f * half_edge * a, 2.0f * half_edge * b);
}

/// Box of half edges `half` around `centre`, turned by `turn`, six quads whose fronts look inwards.
inline void add_box_inside(Scene& scene, int material, glm::vec3 centre, glm::vec3 half,
                           const glm::mat3& turn = glm::mat3(1.0f)) {
  for (int axis = 0; axis < 3; ++axis) {
    for (float side : {-1.0f, 1.0f}) {
      glm::vec3 n(0.0f), a(0.0f), b(0.0f);
      n[axis] = side * half[axis];
      a[(axis + 1) % 3] = half[(axis + 1) % 3];
      b[(axis + 2) % 3] = -side * half[(axis + 2) % 3];
      add_quad(scene, material, centre + turn * (n - a - b), turn * (2.0f * a), turn * (2.0f * b));
    }
  }
}

/// A body along the axes, seen from outside.
inline void add_box(Scene& scene, int material, glm::vec3 centre, glm::vec3 half) {
  for (int axis = 0; axis < 3; ++axis) {
    for (const float sign : {-1.0f, 1.0f}) {
      glm::vec3 n(0.0f), a(0.0f), b(0.0f);
      n[axis] = sign * half[axis];
      a[(axis + 1) % 3] = sign * half[(axis + 1) % 3];
      b[(axis + 2) % 3] = half[(axis + 2) % 3];
      add_quad(scene, material, centre + n - a - b, 2.0f * a, 2.0f * b);
    }
  }
}

/// Latitude-longitude sphere of 4 rings^2 triangles, fronts inwards, vertices at `radius`.
inline Mesh& add_sphere_inside(Scene& scene, int material, glm::vec3 centre, float radius, int rings) {
  Mesh mesh;
  mesh.material = material;
  mesh.object_id = std::uint32_t(scene.meshes.size()) + 1;
  const auto segments = std::uint32_t(2 * rings);
  for (int i = 0; i <= rings; ++i) {
    for (std::uint32_t j = 0; j <= segments; ++j) {
      const float theta = glm::pi<float>() * float(i) / float(rings);
      const float phi = glm::two_pi<float>() * float(j % segments) / float(segments);
      glm::vec3 n(std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi));
      if (i == 0 || i == rings) n = {0.0f, i == 0 ? 1.0f : -1.0f, 0.0f};  // one pole, whatever the rounding
      mesh.positions.push_back(centre + radius * n);
      mesh.normals.push_back(-n);
      mesh.uv[0].emplace_back(float(j) / float(segments), float(i) / float(rings));
    }
  }
  for (std::uint32_t i = 0; i < std::uint32_t(rings); ++i) {
    for (std::uint32_t j = 0; j < segments; ++j) {
      const std::uint32_t k = i * (segments + 1) + j;
      const std::uint32_t below = k + segments + 1;
      if (i + 1 < std::uint32_t(rings)) mesh.triangles.push_back({k, below, below + 1});
      if (i > 0) mesh.triangles.push_back({k, below + 1, k + 1});
    }
  }
  scene.meshes.push_back(mesh);
  update_bounds(scene);
  return scene.meshes.back();
}

inline double area(const Mesh& mesh) {
  double sum = 0.0;
  for (glm::uvec3 t : mesh.triangles) {
    const glm::dvec3 a(mesh.positions[t.x]), b(mesh.positions[t.y]), c(mesh.positions[t.z]);
    sum += 0.5 * glm::length(glm::cross(b - a, c - a));
  }
  return sum;
}

inline double area(const Scene& scene) {
  double sum = 0.0;
  for (const Mesh& mesh : scene.meshes) sum += area(mesh);
  return sum;
}

inline glm::mat3 rotation(glm::vec3 axis, float angle_deg) {
  return glm::mat3(glm::rotate(glm::mat4(1.0f), glm::radians(angle_deg), axis));
}

/// n cubic cells over [-1,1]^3.
inline shared::Grid unit_grid(int n) {
  shared::Grid grid{};
  grid.cells = glm::ivec3(n);
  grid.cell_size_m = 2.0f / float(n);
  grid.origin = glm::vec3(-1.0f);
  return grid;
}

inline Light point_light(glm::vec3 position, glm::vec3 intensity) {
  Light light;
  light.position = position;
  light.intensity = intensity;
  return light;
}

inline Light spot_light(glm::vec3 position, glm::vec3 direction, float inner_deg, float outer_deg,
                        glm::vec3 intensity) {
  Light light = point_light(position, intensity);
  light.type = Light::Type::spot;
  light.direction = glm::normalize(direction);
  light.inner_cone_rad = glm::radians(inner_deg);
  light.outer_cone_rad = glm::radians(outer_deg);
  return light;
}

inline Light sun_light(glm::vec3 direction, glm::vec3 irradiance) {
  Light light = point_light(glm::vec3(0.0f), irradiance);
  light.type = Light::Type::directional;
  light.direction = glm::normalize(direction);
  return light;
}

/// Closed boxes of sides upright, turned and of every height against cells, for grids of 16 cells from -1 to 1.
/// @param check  of (scene, a point inside, distance outside by position, what it is)
template <typename Check>
void for_closed_boxes(const Check& check) {
  const glm::mat3 turns[] = {glm::mat3(1.0f), rotation({0, 1, 0}, 45.0f), rotation({1, 0, 0}, 45.0f),
                             rotation({0, 0, 1}, 30.0f),
                             rotation({0, 1, 0}, 30.0f) * rotation({1, 0, 0}, 20.0f) * rotation({0, 0, 1}, 10.0f)};
  for (int t = 0; t < 5; ++t) {
    const glm::mat3& turn = turns[t];
    for (float half : {0.5f, 0.5625f, 0.51f, 0.4999f, 0.4375f}) {  // faces of cells, centres of cells, between
      for (glm::vec3 offset : {glm::vec3(0.0f), glm::vec3(0.0625f), glm::vec3(0.013f, -0.027f, 0.04f)}) {
        Scene scene;
        add_box_inside(scene, add_material(scene, glm::vec3(0.5f)), offset, glm::vec3(half), turn);
        const auto outside = [&](glm::vec3 p) {
          const glm::vec3 q = glm::abs(glm::transpose(turn) * (p - offset)) - half;
          return std::max({q.x, q.y, q.z});
        };
        check(scene, offset, outside,
              "turn " + std::to_string(t) + ", half edge " + std::to_string(half) + ", offset " +
                  std::to_string(offset.x));
      }
    }
  }
}

/// A square of 2 m across `axis` with a lamp 1 m beside it: bounds without extent along that axis.
inline Scene square_across(int axis) {
  Scene scene;
  glm::vec3 u(0.0f), v(0.0f);
  u[(axis + 1) % 3] = 2.0f;
  v[(axis + 2) % 3] = 2.0f;
  add_quad(scene, add_material(scene, glm::vec3(0.8f)), -0.5f * (u + v), u, v);
  scene.lights.push_back(point_light(glm::normalize(glm::cross(u, v)), glm::vec3(3.0f)));
  return scene;
}

}  // namespace volgi::test
