#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "core/gltf/gltf_internal.h"

namespace volgi::gltf {
namespace {

constexpr double largest_entry = 1e15;  // of a world transform: its square is still a float

void check_length(const Document& document, const std::vector<double>& values, size_t length, const std::string& who,
                  std::string_view property) {
  if (values.empty() || values.size() == length) return;
  refuse(document.path, fmt::format("{}: {} has {} numbers instead of {}", who, property, values.size(), length));
}

void read_transform(const Document& document, const tinygltf::Node& in, const std::string& who, Node& out) {
  check_length(document, in.matrix, 16, who, "matrix");
  check_length(document, in.translation, 3, who, "translation");
  check_length(document, in.rotation, 4, who, "rotation");
  check_length(document, in.scale, 3, who, "scale");
  if (!in.matrix.empty()) {
    glm::dmat4& m = out.matrix.emplace();
    for (int i = 0; i < 16; ++i) m[i / 4][i % 4] = in.matrix[size_t(i)];
    if (m[0][3] != 0.0 || m[1][3] != 0.0 || m[2][3] != 0.0 || m[3][3] != 1.0) {
      refuse(document.path, fmt::format("{}: the last row of its matrix is not 0 0 0 1", who));
    }
  }
  if (!in.translation.empty()) out.translation = {in.translation[0], in.translation[1], in.translation[2]};
  if (!in.scale.empty()) out.scale = {in.scale[0], in.scale[1], in.scale[2]};
  if (!in.rotation.empty()) {
    const auto& r = in.rotation;
    out.rotation = glm::dquat(r[3], r[0], r[1], r[2]);  // glTF stores x y z w
    const double length = glm::length(out.rotation);
    if (!(length > 1e-6) || !std::isfinite(length)) {
      refuse(document.path, fmt::format("{}: its rotation is not a unit quaternion", who));
    }
    out.rotation /= length;
  }
}

int light_of(const Document& document, const tinygltf::Node& in, const std::string& who) {
  const auto extension = in.extensions.find("KHR_lights_punctual");
  if (extension == in.extensions.end() || !extension->second.Has("light")) return -1;
  const int light = extension->second.Get("light").GetNumberAsInt();
  check_index(document, light, document.model.lights.size(), who, "light");
  return light;
}

void link_children(const Document& document, std::vector<Node>& nodes, size_t index, const std::string& who) {
  for (const int child : document.model.nodes[index].children) {
    check_index(document, child, nodes.size(), who, "child node");
    int& parent = nodes[size_t(child)].parent;
    if (parent >= 0) {
      refuse(document.path, fmt::format("node {} is a child of both node {} and node {}", child, parent, index));
    }
    parent = int(index);
  }
}

/// With at most one parent each, a node that is below no root is on a cycle or below one.
void refuse_cycles(const Document& document, const std::vector<Node>& nodes) {
  enum class Mark : std::uint8_t { unseen, on_path, rooted };
  std::vector<Mark> marks(nodes.size(), Mark::unseen);
  std::vector<size_t> path;
  for (size_t start = 0; start < nodes.size(); ++start) {
    path.clear();
    int n = int(start);
    for (; n >= 0 && marks[size_t(n)] == Mark::unseen; n = nodes[size_t(n)].parent) {
      marks[size_t(n)] = Mark::on_path;
      path.push_back(size_t(n));
    }
    if (n >= 0 && marks[size_t(n)] == Mark::on_path) {
      refuse(document.path, fmt::format("node {} is its own ancestor: the node hierarchy has a cycle", n));
    }
    for (const size_t p : path) marks[p] = Mark::rooted;
  }
}

glm::dmat4 parent_from_node(const Node& node) {
  if (node.matrix) return *node.matrix;
  glm::dmat4 m = glm::mat4_cast(node.rotation);
  for (int c = 0; c < 3; ++c) m[c] *= node.scale[c];
  m[3] = glm::dvec4(node.translation, 1.0);
  return m;
}

}  // namespace

std::vector<Node> read_nodes(const Document& document) {
  std::vector<Node> nodes(document.model.nodes.size());
  for (size_t i = 0; i < nodes.size(); ++i) {
    const tinygltf::Node& in = document.model.nodes[i];
    const std::string who = element("node", i, in.name);
    Node& out = nodes[i];
    out.name = in.name;
    if (in.mesh >= 0) check_index(document, in.mesh, document.model.meshes.size(), who, "mesh");
    if (in.camera >= 0) check_index(document, in.camera, document.model.cameras.size(), who, "camera");
    out.mesh = in.mesh;
    out.camera = in.camera;
    out.light = light_of(document, in, who);
    if (in.skin >= 0) warn(document.path, "skins are ignored: meshes keep their bind pose");
    read_transform(document, in, who, out);
    link_children(document, nodes, i, who);
  }
  refuse_cycles(document, nodes);
  return nodes;
}

std::vector<int> scene_nodes(const Document& document, const std::vector<Node>& nodes) {
  std::vector<int> order;
  const tinygltf::Model& model = document.model;
  if (model.scenes.empty()) {
    for (size_t i = 0; i < nodes.size(); ++i) {
      if (nodes[i].parent < 0) order.push_back(int(i));
    }
  } else {
    const int scene = std::max(model.defaultScene, 0);
    check_index(document, scene, model.scenes.size(), "the default scene", "scene");
    order = model.scenes[size_t(scene)].nodes;
    std::set<int> seen;
    for (const int root : order) {
      check_index(document, root, nodes.size(), fmt::format("scene {}", scene), "node");
      if (nodes[size_t(root)].parent >= 0 || !seen.insert(root).second) {
        refuse(document.path, fmt::format("scene {} lists node {}, which is no root or is listed twice", scene, root));
      }
    }
  }
  for (size_t i = 0; i < order.size(); ++i) {  // grows while it is walked: breadth first
    const auto& children = model.nodes[size_t(order[i])].children;
    order.insert(order.end(), children.begin(), children.end());
  }
  return order;
}

std::vector<glm::dmat4> world_from_nodes(const std::filesystem::path& file, const std::vector<Node>& nodes,
                                         const std::vector<int>& order) {
  std::vector<glm::dmat4> world(nodes.size(), glm::dmat4(1.0));
  for (const int index : order) {
    const Node& node = nodes[size_t(index)];
    glm::dmat4& m = world[size_t(index)];
    m = parent_from_node(node);
    if (node.parent >= 0) m = world[size_t(node.parent)] * m;
    for (int i = 0; i < 16; ++i) {
      if (std::abs(m[i / 4][i % 4]) <= largest_entry) continue;  // false for NaN
      refuse(file, fmt::format("{}: its transform is not finite or beyond {}",
                               element("node", size_t(index), node.name), largest_entry));
    }
  }
  return world;
}

}  // namespace volgi::gltf
