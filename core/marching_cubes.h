#pragma once
#include <functional>
#include <glm/glm.hpp>
#include <vector>

namespace volgi {

/// A scalar field at the nodes of a lattice: inside where it is above zero. x fastest.
struct FieldSamples {
  glm::ivec3 nodes{0};  // on each axis, at least 2
  glm::vec3 origin{0.0f};
  float spacing_m = 1.0f;
  std::vector<float> values;  // nodes.x * nodes.y * nodes.z

  size_t index(glm::ivec3 node) const {
    return size_t(node.x) + size_t(nodes.x) * (size_t(node.y) + size_t(nodes.y) * size_t(node.z));
  }
  glm::vec3 position(glm::ivec3 node) const { return origin + spacing_m * glm::vec3(node); }
};

/// Indexed triangles, front side outwards (towards lower values).
struct Isosurface {
  std::vector<glm::vec3> positions;
  std::vector<glm::uvec3> triangles;
};

/// The surface on which the field is zero: one vertex on every lattice edge whose ends differ in sign, at most five
/// triangles a cell. Closed where the field is not above zero on the lattice's outer nodes: every edge belongs to
/// exactly two triangles, in opposite directions. Inside corners that meet on a face's diagonal alone stay apart.
/// @param value_at  the field between nodes; places the vertices on it to a thousandth of the spacing, but never within
///                  a hundredth of the spacing from a node, so that all triangles have area.
/// Deterministic. Cost: a visit of each cell; four values a vertex.
/// Source: Lorensen and Cline 1987; triangles by tracing loops around the faces of a cell instead of their table, whose
/// complements leave holes.
Isosurface marching_cubes(const FieldSamples& samples, const std::function<float(glm::vec3)>& value_at);

}  // namespace volgi
