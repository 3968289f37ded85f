#include "core/scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <functional>
#include <limits>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <unordered_map>

#include "core/error.h"
#include "core/gltf/gltf_internal.h"

namespace volgi {
namespace {

constexpr double farthest_m = 1e12;                 // squares and cubes of it are still floats
constexpr size_t max_vertices = size_t(100) << 20;  // of all nodes together

WorldBox triangle_bounds(const std::vector<gltf::PlacedMesh>& meshes) {
  WorldBox box;
  for (const gltf::PlacedMesh& placed : meshes) {
    for (const glm::uvec3& t : placed.mesh.triangles) {
      for (int c = 0; c < 3; ++c) {
        box.min = glm::min(box.min, placed.positions[t[c]]);
        box.max = glm::max(box.max, placed.positions[t[c]]);
      }
    }
  }
  return box;
}

}  // namespace

/// What of a file does not change with time.
struct SceneFile::Data {
  std::filesystem::path path;
  gltf::Materials materials;
  std::vector<std::vector<gltf::Primitive>> meshes;  // decoded where a node of the scene shows them
  std::vector<std::vector<double>> morph_weights;    // of meshes, where a node has none of its own
  std::vector<gltf::Skin> skins;
  std::vector<gltf::Node> nodes;
  std::vector<int> order;
  std::vector<gltf::Channel> channels;
  std::vector<Light> lights;
  std::vector<Camera> cameras;
  std::shared_ptr<const Sky> sky;

  explicit Data(const gltf::Document& document);
  Scene still() const;
  void place(Scene& scene, double time_s, const WorldBox* given_box) const;
  std::vector<gltf::Node> nodes_at(double time_s) const;
  std::vector<gltf::PlacedMesh> place_meshes(const std::vector<gltf::Node>& moved, size_t& dropped) const;
  void place_node(const std::vector<gltf::Node>& moved, const std::vector<glm::dmat4>& world, size_t index,
                  std::vector<gltf::PlacedMesh>& placed, size_t& dropped) const;
  void check_positions(const gltf::PlacedMesh& placed, const gltf::Node& node) const;
  void add_lights_and_cameras(const std::vector<glm::dmat4>& world, Scene& scene) const;
};

SceneFile::Data::Data(const gltf::Document& document) : path(document.path) {
  gltf::check_accessors(document);
  nodes = gltf::read_nodes(document);
  order = gltf::scene_nodes(document, nodes);
  materials = gltf::read_materials(document);
  lights = gltf::read_lights(document);
  cameras = gltf::read_cameras(document);
  sky = gltf::read_image_light(document);
  channels = gltf::read_channels(document, nodes);
  skins = gltf::read_skins(document);
  for (const tinygltf::Mesh& mesh : document.model.meshes) morph_weights.push_back(mesh.weights);

  meshes.resize(document.model.meshes.size());
  std::vector<bool> decoded(meshes.size(), false);
  size_t vertices = 0;
  for (const int index : order) {
    const int mesh = nodes[size_t(index)].mesh;
    if (mesh < 0) continue;
    auto& primitives = meshes[size_t(mesh)];
    if (!decoded[size_t(mesh)]) {
      primitives = gltf::read_mesh(document, size_t(mesh), materials);
      decoded[size_t(mesh)] = true;
    }
    gltf::check_joints(document, nodes[size_t(index)], skins, primitives);
    const size_t times = std::max(nodes[size_t(index)].instances.size(), size_t(1));
    for (const gltf::Primitive& p : primitives) vertices += times * (p.positions.size() + p.triangles.size());
    if (vertices > max_vertices) {
      throw Error(ExitCode::over_limit, fmt::format("{}: more than {} vertices and triangles in all nodes together",
                                                    path.string(), max_vertices));
    }
  }
}

void SceneFile::Data::check_positions(const gltf::PlacedMesh& placed, const gltf::Node& node) const {
  for (const glm::dvec3& p : placed.positions) {
    if (std::abs(p.x) <= farthest_m && std::abs(p.y) <= farthest_m && std::abs(p.z) <= farthest_m) continue;
    gltf::refuse(path, fmt::format("node '{}': a vertex lies at ({}, {}, {}), beyond {} m", node.name, p.x, p.y, p.z,
                                   farthest_m));
  }
}

/// What a node shows: morphed, then by its skin, or in the node's frame, once or in each of its instances.
void SceneFile::Data::place_node(const std::vector<gltf::Node>& moved, const std::vector<glm::dmat4>& world,
                                 size_t index, std::vector<gltf::PlacedMesh>& placed, size_t& dropped) const {
  const gltf::Node& node = moved[index];
  const std::vector<double>& weights =
      node.morph_weights.empty() ? morph_weights[size_t(node.mesh)] : node.morph_weights;
  std::vector<glm::dmat4> world_from_bind;
  if (node.skin >= 0) {
    const gltf::Skin& skin = skins[size_t(node.skin)];
    for (size_t j = 0; j < skin.joints.size(); ++j)
      world_from_bind.push_back(world[size_t(skin.joints[j])] * skin.joint_from_bind[j]);
  }
  const auto add = [&](gltf::PlacedMesh mesh) {
    check_positions(mesh, node);
    mesh.mesh.name = node.name;
    mesh.mesh.object_id = std::uint32_t(index) + 1;
    placed.push_back(std::move(mesh));
  };
  for (const gltf::Primitive& still : meshes[size_t(node.mesh)]) {
    const bool morphs =
        !still.targets.empty() && std::any_of(weights.begin(), weights.end(), [](double w) { return w != 0.0; });
    const gltf::Primitive moving = morphs ? gltf::morphed(still, weights) : gltf::Primitive();
    const gltf::Primitive& primitive = morphs ? moving : still;
    if (node.skin >= 0 && !primitive.influences.empty()) {
      add(gltf::place_skinned(primitive, world_from_bind, dropped));
    } else if (node.instances.empty()) {
      add(gltf::place_primitive(primitive, world[index], dropped));
    } else {
      for (const glm::dmat4& instance : node.instances)
        add(gltf::place_primitive(primitive, world[index] * instance, dropped));
    }
  }
}

std::vector<gltf::PlacedMesh> SceneFile::Data::place_meshes(const std::vector<gltf::Node>& moved,
                                                            size_t& dropped) const {
  const std::vector<glm::dmat4> world = gltf::world_from_nodes(path, moved, order);
  std::vector<gltf::PlacedMesh> placed;
  for (const int index : order) {
    if (moved[size_t(index)].mesh >= 0) place_node(moved, world, size_t(index), placed, dropped);
  }
  return placed;
}

void SceneFile::Data::add_lights_and_cameras(const std::vector<glm::dmat4>& world, Scene& scene) const {
  for (const int index : order) {
    const gltf::Node& node = nodes[size_t(index)];
    const glm::dmat4& world_from_node = world[size_t(index)];
    if (node.light >= 0) {
      scene.lights.push_back(gltf::place_light(lights[size_t(node.light)], world_from_node, scene.world_origin));
      if (scene.lights.back().name.empty()) scene.lights.back().name = node.name;
    }
    if (node.camera >= 0) {
      Camera camera = cameras[size_t(node.camera)];
      if (camera.name.empty()) camera.name = node.name;
      camera = gltf::place_camera(path, camera, world_from_node, scene.world_origin);
      gltf::finite_far_plane(camera, scene.bounds_min, scene.bounds_max);
      scene.cameras.push_back(camera);
    }
  }
}

SceneFile::SceneFile(const std::filesystem::path& path, const SceneReading& reading) {
  try {
    data_ = std::make_unique<Data>(gltf::read_document(path, reading));
  } catch (const std::bad_alloc&) {
    throw Error(ExitCode::over_limit, fmt::format("{}: not enough memory to read it", path.string()));
  }
}

SceneFile::~SceneFile() = default;
SceneFile::SceneFile(SceneFile&&) noexcept = default;
SceneFile& SceneFile::operator=(SceneFile&&) noexcept = default;

bool SceneFile::animated() const { return !data_->channels.empty(); }

double SceneFile::last_key_s() const {
  double last = 0.0;
  for (const gltf::Channel& channel : data_->channels) {
    if (!channel.times_s.empty()) last = std::max(last, double(channel.times_s.back()));
  }
  return last;
}

/// What does not move.
Scene SceneFile::Data::still() const {
  Scene scene;
  scene.path = path;
  scene.name = path.stem().string();
  scene.materials = materials.materials;
  scene.images = materials.images;
  scene.textures = materials.textures;
  scene.sky = sky;
  return scene;
}

std::vector<gltf::Node> SceneFile::Data::nodes_at(double time_s) const {
  assert(std::isfinite(time_s));
  std::vector<gltf::Node> moved = nodes;
  gltf::animate(moved, channels, time_s);
  return moved;
}

/// Puts what moves into the scene: all but what still() makes.
void SceneFile::Data::place(Scene& scene, double time_s, const WorldBox* given_box) const {
  const std::vector<gltf::Node> moved = nodes_at(time_s);
  size_t dropped = 0;
  std::vector<gltf::PlacedMesh> placed = place_meshes(moved, dropped);
  const WorldBox box = given_box != nullptr ? *given_box : triangle_bounds(placed);
  scene.world_origin = box.empty() ? glm::dvec3(0.0) : box.centre();
  scene.meshes.clear();
  for (gltf::PlacedMesh& mesh : placed) {
    Mesh done = gltf::centred(std::move(mesh), scene.world_origin, dropped);
    if (!done.triangles.empty()) scene.meshes.push_back(std::move(done));
  }
  if (dropped > 0) gltf::warn(path, fmt::format("{} triangles without area are left out", dropped));
  const size_t duplicates = drop_duplicate_triangles(scene);
  if (duplicates > 0) gltf::warn(path, fmt::format("{} triangles lie exactly on others and are left out", duplicates));
  update_bounds(scene);
  if (given_box != nullptr && !box.empty()) {
    scene.bounds_min = glm::vec3(box.min - scene.world_origin);
    scene.bounds_max = glm::vec3(box.max - scene.world_origin);
  }
  scene.lights.clear();
  scene.cameras.clear();
  add_lights_and_cameras(gltf::world_from_nodes(path, moved, order), scene);
}

Scene SceneFile::at(double time_s) const {
  Scene scene = data_->still();
  data_->place(scene, time_s, nullptr);
  return scene;
}

Scene SceneFile::at(double time_s, const WorldBox& box) const {
  Scene scene = data_->still();
  data_->place(scene, time_s, &box);
  return scene;
}

void SceneFile::move(Scene& scene, double time_s, const WorldBox& box) const { data_->place(scene, time_s, &box); }

WorldBox SceneFile::bounds(double time_s) const {
  size_t dropped = 0;
  return triangle_bounds(data_->place_meshes(data_->nodes_at(time_s), dropped));
}

namespace {

/// A layer that can be seen through, on a surface: a little in front of it.
void lift(Scene& scene, const std::vector<std::pair<size_t, size_t>>& layers) {
  if (layers.empty()) return;
  constexpr float share = 2e-5f;  // of the scene's diagonal: more than positions round by, less than anybody sees
  update_bounds(scene);
  const float height = share * glm::length(scene.bounds_max - scene.bounds_min);
  for (const auto& [m, triangle] : layers) {
    Mesh& mesh = scene.meshes[m];
    glm::uvec3& t = mesh.triangles[triangle];
    const glm::vec3 a = mesh.positions[t.x];
    const glm::vec3 up = height * glm::normalize(glm::cross(mesh.positions[t.y] - a, mesh.positions[t.z] - a));
    for (int c = 0; c < 3; ++c) {
      const std::uint32_t from = t[c];
      t[c] = std::uint32_t(mesh.positions.size());
      mesh.positions.push_back(mesh.positions[from] + up);
      const auto copy = [&](auto& values) {
        if (!values.empty())
          values.push_back(typename std::remove_reference_t<decltype(values)>::value_type(values[from]));
      };
      copy(mesh.normals);
      copy(mesh.uv[0]);
      copy(mesh.uv[1]);
      copy(mesh.colors);
    }
  }
}

}  // namespace

size_t drop_duplicate_triangles(Scene& scene) {
  // Corners from the smallest on, in their order: the same for the same triangle whichever corner its list begins with.
  using Key = std::array<float, 9>;
  struct Hash {
    size_t operator()(const Key& key) const {
      return std::hash<std::string_view>{}({reinterpret_cast<const char*>(key.data()), sizeof key});
    }
  };
  const auto less = [](glm::vec3 a, glm::vec3 b) { return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z); };
  const auto key_of = [&](const Mesh& mesh, glm::uvec3 t) {
    std::array<glm::vec3, 3> p{mesh.positions[t.x], mesh.positions[t.y], mesh.positions[t.z]};
    std::rotate(p.begin(), std::min_element(p.begin(), p.end(), less), p.end());
    Key key{};
    for (size_t i = 0; i < 9; ++i) key[i] = p[i / 3][int(i % 3)] + 0.0f;  // -0 is 0
    return key;
  };
  const auto opaque = [&](size_t mesh) {
    return scene.materials[size_t(scene.meshes[mesh].material)].alpha_mode == AlphaMode::opaque;
  };
  using Place = std::pair<size_t, size_t>;  // mesh, triangle
  std::unordered_map<Key, Place, Hash> lowest;
  std::unordered_multimap<Key, Place, Hash> above;  // layers, of which there are few
  lowest.reserve(scene.triangle_count());
  const auto hides = [&](size_t below, size_t m) {
    return scene.meshes[below].material == scene.meshes[m].material || (opaque(below) && opaque(m));
  };
  std::vector<Place> layers;
  size_t dropped = 0;
  for (size_t m = 0; m < scene.meshes.size(); ++m) {
    Mesh& mesh = scene.meshes[m];
    size_t kept = 0;
    for (const glm::uvec3 t : mesh.triangles) {
      const Key key = key_of(mesh, t);
      const auto [first, is_new] = lowest.try_emplace(key, m, kept);
      if (!is_new) {
        const auto [begin, end] = above.equal_range(key);
        if (hides(first->second.first, m) ||
            std::any_of(begin, end, [&](const auto& layer) { return hides(layer.second.first, m); }))
          continue;
        above.emplace(key, Place(m, kept));
        layers.push_back(opaque(m) ? first->second : Place(m, kept));
      }
      mesh.triangles[kept++] = t;
    }
    dropped += mesh.triangles.size() - kept;
    mesh.triangles.resize(kept);
  }
  lift(scene, layers);
  std::erase_if(scene.meshes, [](const Mesh& mesh) { return mesh.triangles.empty(); });
  return dropped;
}

size_t Scene::triangle_count() const {
  size_t count = 0;
  for (const Mesh& mesh : meshes) count += mesh.triangles.size();
  return count;
}

void update_bounds(Scene& scene) {
  glm::vec3 low(std::numeric_limits<float>::infinity());
  glm::vec3 high = -low;
  for (const Mesh& mesh : scene.meshes) {
    for (const glm::uvec3& t : mesh.triangles) {
      for (int c = 0; c < 3; ++c) {
        low = glm::min(low, mesh.positions[t[c]]);
        high = glm::max(high, mesh.positions[t[c]]);
      }
    }
  }
  const bool empty = low.x > high.x;
  scene.bounds_min = empty ? glm::vec3(0.0f) : low;
  scene.bounds_max = empty ? glm::vec3(0.0f) : high;
}

}  // namespace volgi
