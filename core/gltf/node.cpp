#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "core/error.h"
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
    constexpr double rounding = 1e-5;  // of exporters that multiply matrices in float
    const glm::dvec4 last_row(m[0][3], m[1][3], m[2][3], m[3][3]);
    if (!glm::all(glm::lessThanEqual(glm::abs(last_row - glm::dvec4(0.0, 0.0, 0.0, 1.0)), glm::dvec4(rounding))))
      refuse(document.path, fmt::format("{}: the last row of its matrix is not 0 0 0 1", who));
    for (int c = 0; c < 4; ++c) m[c][3] = c == 3 ? 1.0 : 0.0;
  }
  if (!in.translation.empty()) out.translation = {in.translation[0], in.translation[1], in.translation[2]};
  if (!in.scale.empty()) out.scale = {in.scale[0], in.scale[1], in.scale[2]};
  if (!in.rotation.empty()) {
    const auto& r = in.rotation;
    out.rotation = glm::dquat(r[3], r[0], r[1], r[2]);  // glTF stores x y z w
    const double length = glm::length(out.rotation);
    if (length > 1e-6 && std::isfinite(length)) {
      out.rotation /= length;
    } else {
      repair(document, fmt::format("{}: its rotation is no unit quaternion; it counts as none", who));
      out.rotation = glm::dquat(1.0, 0.0, 0.0, 0.0);
    }
  }
}

int light_of(const Document& document, const tinygltf::Node& in, const std::string& who) {
  const auto extension = in.extensions.find("KHR_lights_punctual");
  if (extension == in.extensions.end() || !extension->second.Has("light")) return -1;
  const int light = extension->second.Get("light").GetNumberAsInt();
  check_index(document, light, document.model.lights.size(), who, "light");
  return light;
}

glm::dmat4 parent_from_node(const Node& node) {
  if (node.matrix) return *node.matrix;
  glm::dmat4 m = glm::mat4_cast(node.rotation);
  for (int c = 0; c < 3; ++c) m[c] *= node.scale[c];
  m[3] = glm::dvec4(node.translation, 1.0);
  return m;
}

/// EXT_mesh_gpu_instancing: rows of any of three attributes, one an instance.
void read_instances(const Document& document, const tinygltf::Node& in, const std::string& who, Node& out) {
  const auto extension = in.extensions.find("EXT_mesh_gpu_instancing");
  if (extension == in.extensions.end() || !extension->second.Has("attributes")) return;
  constexpr size_t most = size_t(1) << 20;
  const tinygltf::Value& attributes = extension->second.Get("attributes");
  size_t count = 0;
  const auto rows = [&](const char* name, const Expected& expected) {
    if (!attributes.Has(name)) return Elements{};
    Elements e = read_elements(document, attributes.Get(name).GetNumberAsInt(), expected, who + " instances' " + name);
    if (e.count() > most || (count != 0 && e.count() != count))
      refuse(document.path, fmt::format("{}: {} instances in {}, {} before", who, e.count(), name, count));
    count = e.count();
    return e;
  };
  const Elements translation = rows("TRANSLATION", {{3}, false, false});
  const Elements rotation = rows("ROTATION", {{4}, true, false});
  const Elements scale = rows("SCALE", {{3}, false, false});
  for (size_t i = 0; i < count; ++i) {
    const auto at = [i](const Elements& e, size_t c) { return double(e.values[i * e.components + c]); };
    Node instance;
    if (translation.components > 0) instance.translation = {at(translation, 0), at(translation, 1), at(translation, 2)};
    if (scale.components > 0) instance.scale = {at(scale, 0), at(scale, 1), at(scale, 2)};
    if (rotation.components > 0) {
      const glm::dquat q(at(rotation, 3), at(rotation, 0), at(rotation, 1), at(rotation, 2));
      if (!(glm::length(q) > 1e-6)) refuse(document.path, fmt::format("{}: the rotation of instance {} is 0", who, i));
      instance.rotation = glm::normalize(q);
    }
    out.instances.push_back(parent_from_node(instance));
  }
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
    if (in.skin >= 0) check_index(document, in.skin, document.model.skins.size(), who, "skin");
    out.skin = in.skin;
    out.morph_weights = in.weights;
    read_instances(document, in, who, out);
    read_transform(document, in, who, out);
    link_children(document, nodes, i, who);
  }
  refuse_cycles(document, nodes);
  return nodes;
}

namespace {

/// What a scene lists, once each. A node that has a parent is shown where that puts it.
std::vector<int> roots_of(const Document& document, int scene, const std::vector<Node>& nodes) {
  std::vector<int> roots;
  std::set<int> seen;
  for (const int root : document.model.scenes[size_t(scene)].nodes) {
    check_index(document, root, nodes.size(), fmt::format("scene {}", scene), "node");
    const bool first = seen.insert(root).second;
    if (!first || nodes[size_t(root)].parent >= 0)
      repair(document, fmt::format("scene {} lists node {}, which is no root or is listed twice", scene, root));
    if (first) roots.push_back(root);
  }
  // Below another one that is listed, it comes with that.
  std::erase_if(roots, [&](int root) {
    for (int n = nodes[size_t(root)].parent; n >= 0; n = nodes[size_t(n)].parent) {
      if (seen.contains(n)) return true;
    }
    return false;
  });
  return roots;
}

}  // namespace

std::vector<int> scene_nodes(const Document& document, const std::vector<Node>& nodes) {
  std::vector<int> order;
  const tinygltf::Model& model = document.model;
  if (model.scenes.empty()) {
    for (size_t i = 0; i < nodes.size(); ++i) {
      if (nodes[i].parent < 0) order.push_back(int(i));
    }
  } else {
    if (document.reading.scene && size_t(*document.reading.scene) >= model.scenes.size()) {
      throw Error(ExitCode::usage, fmt::format("--scene {}: {} has {}", *document.reading.scene, document.path.string(),
                                               model.scenes.size()));
    }
    const int scene = document.reading.scene.value_or(std::max(model.defaultScene, 0));
    check_index(document, scene, model.scenes.size(), "the default scene", "scene");
    order = roots_of(document, scene, nodes);
  }
  std::vector<bool> seen(nodes.size(), false);
  for (const int root : order) seen[size_t(root)] = true;
  for (size_t i = 0; i < order.size(); ++i) {  // grows while it is walked: breadth first
    for (const int child : model.nodes[size_t(order[i])].children) {
      if (!seen[size_t(child)]) order.push_back(child);
      seen[size_t(child)] = true;
    }
  }
  // Parents that the scene does not list carry what it lists all the same.
  return order;
}

std::vector<glm::dmat4> world_from_nodes(const std::filesystem::path& file, const std::vector<Node>& nodes,
                                         const std::vector<int>& order) {
  std::vector<glm::dmat4> world(nodes.size(), glm::dmat4(1.0));
  std::vector<bool> known(nodes.size(), false);
  std::vector<size_t> above;
  for (size_t start = 0; start < nodes.size(); ++start) {  // parents first; there are no cycles
    for (int n = int(start); n >= 0 && !known[size_t(n)]; n = nodes[size_t(n)].parent) above.push_back(size_t(n));
    for (; !above.empty(); above.pop_back()) {
      const Node& node = nodes[above.back()];
      world[above.back()] = parent_from_node(node);
      if (node.parent >= 0) world[above.back()] = world[size_t(node.parent)] * world[above.back()];
      known[above.back()] = true;
    }
  }
  for (const int index : order) {
    const glm::dmat4& m = world[size_t(index)];
    for (int i = 0; i < 16; ++i) {
      if (std::abs(m[i / 4][i % 4]) <= largest_entry) continue;  // false for NaN
      refuse(file, fmt::format("{}: its transform is not finite or beyond {}",
                               element("node", size_t(index), nodes[size_t(index)].name), largest_entry));
    }
  }
  return world;
}

}  // namespace volgi::gltf
