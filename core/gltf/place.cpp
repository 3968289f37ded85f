#include <algorithm>
#include <cmath>
#include <limits>

#include "core/gltf/gltf_internal.h"

namespace volgi::gltf {
namespace {

/// A triangle whose height is this share of its longest edge is below what float positions resolve.
constexpr double thinnest = 1e-7;
/// Normals shorter than this have no direction.
constexpr float shortest_normal = 1e-6f;

glm::dvec3 cross_of(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) { return glm::cross(b - a, c - a); }

bool has_area(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
  const double longest = std::sqrt(std::max({glm::dot(b - a, b - a), glm::dot(c - b, c - b), glm::dot(a - c, a - c)}));
  const double twice_area = glm::length(cross_of(a, b, c));
  return twice_area > thinnest * longest * longest && twice_area > std::numeric_limits<float>::min();
}

template <typename Positions>
size_t drop_without_area(std::vector<glm::uvec3>& triangles, const Positions& positions) {
  return std::erase_if(triangles, [&](const glm::uvec3& t) {
    return !has_area(glm::dvec3(positions[t.x]), glm::dvec3(positions[t.y]), glm::dvec3(positions[t.z]));
  });
}

/// Inverse transpose times the determinant: right up to length for every matrix, singular ones included. Its sign is
/// that of the inverse transpose.
glm::dmat3 normal_matrix(const glm::dmat3& m) {
  const glm::dmat3 cofactors(glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1]));
  return glm::determinant(m) < 0.0 ? -cofactors : cofactors;
}

/// Zero where a normal is missing or its direction is lost.
std::vector<glm::vec3> world_normals(const std::vector<glm::vec3>& normals, const glm::dmat3& world_from_node) {
  const glm::dmat3 matrix = normal_matrix(world_from_node);
  std::vector<glm::vec3> out(normals.size(), glm::vec3(0.0f));
  for (size_t i = 0; i < normals.size(); ++i) {
    if (!(glm::length(normals[i]) >= shortest_normal)) continue;
    const glm::dvec3 turned = matrix * glm::dvec3(normals[i]);
    const double length = glm::length(turned);
    if (length > 0.0) out[i] = glm::vec3(turned / length);
  }
  return out;
}

/// A corner without a normal gets a vertex of its own with its triangle's.
void fill_normals(Mesh& mesh) {
  mesh.normals.resize(mesh.positions.size(), glm::vec3(0.0f));
  const size_t original = mesh.positions.size();
  std::vector<bool> taken(original, false);
  for (glm::uvec3& t : mesh.triangles) {
    const glm::vec3 flat(glm::normalize(
        cross_of(glm::dvec3(mesh.positions[t.x]), glm::dvec3(mesh.positions[t.y]), glm::dvec3(mesh.positions[t.z]))));
    for (int c = 0; c < 3; ++c) {
      const std::uint32_t v = t[c];
      if (!taken[v] && mesh.normals[v] != glm::vec3(0.0f)) continue;
      if (!taken[v]) {  // the first triangle keeps the vertex
        taken[v] = true;
        mesh.normals[v] = flat;
        continue;
      }
      t[c] = std::uint32_t(mesh.positions.size());
      mesh.positions.push_back(mesh.positions[v]);
      mesh.normals.push_back(flat);
      for (auto& uv : mesh.uv) {
        if (!uv.empty()) uv.push_back(uv[v]);
      }
      if (!mesh.colors.empty()) mesh.colors.push_back(mesh.colors[v]);
    }
  }
  for (glm::vec3& normal : mesh.normals) {  // vertices of no triangle
    if (normal == glm::vec3(0.0f)) normal = glm::vec3(0.0f, 1.0f, 0.0f);
  }
}

}  // namespace

PlacedMesh place_primitive(const Primitive& primitive, const glm::dmat4& world_from_node, size_t& dropped) {
  PlacedMesh placed;
  placed.positions.reserve(primitive.positions.size());
  for (const glm::vec3& p : primitive.positions) {
    placed.positions.emplace_back(world_from_node * glm::dvec4(glm::dvec3(p), 1.0));
  }
  const glm::dmat3 linear(world_from_node);
  Mesh& mesh = placed.mesh;
  mesh.material = primitive.material;
  mesh.normals = world_normals(primitive.normals, linear);
  mesh.uv = primitive.uv;
  mesh.colors = primitive.colors;
  mesh.triangles = primitive.triangles;
  if (glm::determinant(linear) < 0.0) {
    for (glm::uvec3& t : mesh.triangles) std::swap(t.y, t.z);
  }
  dropped += drop_without_area(mesh.triangles, placed.positions);
  return placed;
}

PlacedMesh place_skinned(const Primitive& primitive, const std::vector<glm::dmat4>& world_from_bind, size_t& dropped) {
  PlacedMesh placed;
  Mesh& mesh = placed.mesh;
  mesh.material = primitive.material;
  mesh.uv = primitive.uv;
  mesh.colors = primitive.colors;
  mesh.triangles = primitive.triangles;
  mesh.normals.assign(primitive.normals.size(), glm::vec3(0.0f));
  std::vector<bool> mirrored(primitive.positions.size(), false);
  for (size_t i = 0; i < primitive.positions.size(); ++i) {
    glm::dmat4 m(0.0);
    for (const Primitive::Influences& set : primitive.influences) {
      for (int k = 0; k < 4; ++k) {
        if (set.weights[i][k] > 0.0f) m += double(set.weights[i][k]) * world_from_bind[set.joints[i][k]];
      }
    }
    placed.positions.emplace_back(m * glm::dvec4(glm::dvec3(primitive.positions[i]), 1.0));
    const glm::dmat3 linear(m);
    mirrored[i] = glm::determinant(linear) < 0.0;
    if (i < primitive.normals.size()) mesh.normals[i] = world_normals({primitive.normals[i]}, linear)[0];
  }
  for (glm::uvec3& t : mesh.triangles) {
    if (mirrored[t.x]) std::swap(t.y, t.z);
  }
  dropped += drop_without_area(mesh.triangles, placed.positions);
  return placed;
}

Mesh centred(PlacedMesh placed, const glm::dvec3& world_origin, size_t& dropped) {
  Mesh mesh = std::move(placed.mesh);
  mesh.positions.reserve(placed.positions.size());
  for (const glm::dvec3& p : placed.positions) mesh.positions.emplace_back(p - world_origin);
  dropped += drop_without_area(mesh.triangles, mesh.positions);  // rounding may have closed some
  fill_normals(mesh);
  return mesh;
}

}  // namespace volgi::gltf
