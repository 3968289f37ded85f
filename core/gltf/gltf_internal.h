#pragma once
// Private to core: how a glTF file becomes a Scene. Steps in the order in which scene.cpp calls them; each file checks
// what it reads, because tinygltf checks little.

#include <array>
#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/gtc/type_precision.hpp>
#include <map>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "core/gltf/tinygltf_internal.h"
#include "core/scene.h"

namespace volgi::gltf {

/// A parsed file. Its JSON has passed check_json; images hold their encoded bytes when they come from a URI. What is
/// compressed has been decompressed.
struct Document {
  std::filesystem::path path;
  SceneReading reading;
  tinygltf::Model model;
  std::set<int> missing_images;  // whose file is not there
};

// --- error.cpp
/// @throws Error(bad_input) "FILE: WHAT", on one line of bounded length whatever the file's names contain.
[[noreturn]] void refuse(const std::filesystem::path& file, std::string_view what);
void warn(const std::filesystem::path& file, std::string_view what);
/// A fault that the caller repairs: warned about, or refused where reading is strict.
void repair(const std::filesystem::path& file, const SceneReading& reading, std::string_view what);
inline void repair(const Document& document, std::string_view what) { repair(document.path, document.reading, what); }
/// "mesh 3 'wall'".
std::string element(std::string_view kind, size_t index, const std::string& name);
/// Refuses unless 0 <= index < size; WHO is the element that refers, KIND what it refers to.
void check_index(const Document& document, int index, size_t size, const std::string& who, std::string_view kind);

// --- json.cpp: before tinygltf sees the text
/// What the JSON refers to, under the names that check_json has given it.
struct External {
  std::filesystem::path path;        // empty: `bytes` has it
  std::vector<unsigned char> bytes;  // of a data URI
  std::optional<size_t> size;        // of a buffer: the first so many bytes of it
  std::string shown;                 // in messages
};
using Externals = std::map<std::string, External>;
struct CheckedJson {
  std::string text;  // as tinygltf takes it
  Externals externals;
  std::set<int> missing_images;
};
/// Refuses nesting deeper than any scene needs, properties of a wrong type (tinygltf would use their defaults),
/// unsupported required extensions, and URIs that are missing or leave the root folder. Repairs whole numbers that are
/// written as others (36.0), and gives every buffer and image a name that tinygltf does not decode.
CheckedJson check_json(const std::filesystem::path& file, const SceneReading& reading, std::string_view text);

// --- external.cpp
void take_externals(const std::filesystem::path& file, const SceneReading& reading, nlohmann::json& root,
                    CheckedJson& out);

// --- uri.cpp
/// Path of a relative URI. Refuses what is absolute, leaves the root folder (also through a link) or is no regular
/// file. Nothing where there is no such file.
std::optional<std::filesystem::path> resolve_uri(const std::filesystem::path& file, const SceneReading& reading,
                                                 const std::string& who, const std::string& uri);
/// A URI with a scheme, such as https: or a drive's letter, an absolute one, or none at all: of no file beside this
/// one.
bool is_elsewhere(const std::string& uri);
/// Bytes that a text with %XX stands for; nothing when an escape is malformed.
std::optional<std::string> percent_decoded(const std::string& uri);

// --- document.cpp
Document read_document(const std::filesystem::path& path, const SceneReading& reading);

// --- meshopt.cpp, draco.cpp: give compressed data buffers, views and accessors of its own
void decompress_meshopt(Document& document);
void decompress_draco(Document& document);
/// A new buffer view on bytes. @throws Error(over_limit) when all of them together are more than a scene may have.
int add_view(Document& document, std::vector<unsigned char> bytes, const std::string& who);

// --- accessor.cpp
/// Elements of an accessor as floats; normalized integers already in [-1,1] or [0,1].
struct Elements {
  size_t components = 0;  // per element
  std::vector<float> values;
  size_t count() const { return components == 0 ? 0 : values.size() / components; }
};

struct Expected {
  std::set<size_t> components;       // 1 scalar ... 4
  bool normalized_integers = false;  // besides floats
  bool plain_integers = false;       // KHR_mesh_quantization
  bool repair = false;               // what is no finite number becomes 0
};

/// The bytes of a buffer view, checked against its buffer.
struct Bytes {
  const unsigned char* data = nullptr;
  size_t size = 0;
};
Bytes view_bytes(const Document& document, int buffer_view, const std::string& who);
/// Refuses an accessor that lies outside its buffer view, has a wrong type, or holds NaN or infinity that are not to be
/// repaired.
Elements read_elements(const Document& document, int accessor, const Expected& expected, const std::string& who);
std::vector<std::uint32_t> read_indices(const Document& document, int accessor, const std::string& who);
/// Refuses any accessor of the file that lies outside its data, used or not, before anything is allocated for it.
void check_accessors(const Document& document);

// --- material.cpp, texture.cpp
struct Materials {
  std::vector<Material> materials;          // those of the file, then the default material if a primitive needs it
  std::vector<std::array<int, 2>> uv_sets;  // by material: which TEXCOORD_n are its texture coordinates 0 and 1
  std::vector<TextureImage> images;
  std::vector<Texture> textures;
};
Materials read_materials(const Document& document);

/// Scene textures made of a file's: what no supported property uses is never decoded.
class TextureTable {
 public:
  TextureTable(const Document& document, Materials& out);
  TextureUse use(const tinygltf::TextureInfo& info, const std::string& who);
  const TextureImage& image_of(int texture);
  /// Decodes what has been used, on all threads. Nothing is looked at before, but by image_of().
  void decode();
  /// A texture of another image with the sampler of `like`.
  int add(TextureImage image, int like);

 private:
  int texture(int file_texture, const std::string& who);
  int image(int file_image, const std::string& who);
  const Document& document_;
  Materials& out_;
  std::vector<int> texture_of_file_, image_of_file_;
  std::vector<int> encoded_;  // of out_.images: the file's, -1 where it is decoded
};
/// PNG or JPEG.
TextureImage decode_image(const Document& document, size_t index);

// --- image_light.cpp
/// EXT_lights_image_based of the scene that is read; null where it has none. Irradiance of an unobstructed surface is
/// what its coefficients say, to the bands they have; what is seen, and what casts shadows, are its sharpest pictures,
/// turned over as those of most agreement with the coefficients.
std::shared_ptr<const Sky> read_image_light(const Document& document);

// --- transmission.cpp
/// KHR_materials_transmission on a material that is otherwise read: AlphaMode::glass. Of light the transmission's share
/// passes straight on in the base colour, as through a coloured hole; the rest is reflected.
void apply_transmission(const Document& document, const tinygltf::Material& in, const std::string& who,
                        TextureTable& textures, Material& material);

// --- mesh.cpp
/// A primitive in the frame of the nodes that show it. Without normals its corners are unshared.
struct Primitive {
  int material = 0;
  std::vector<glm::vec3> positions;
  std::vector<glm::vec3> normals;  // as in the file; empty when it has none
  std::array<std::vector<glm::vec2>, 2> uv;
  std::vector<glm::vec4> colors;
  std::vector<glm::uvec3> triangles;
  /// What a morph target adds, at full weight; without normals where it has none.
  struct Target {
    std::vector<glm::vec3> positions, normals;
  };
  std::vector<Target> targets;
  /// Of a skin: four joints (indices into its list) and weights for each vertex, in sets; weights sum to 1.
  struct Influences {
    std::vector<glm::u16vec4> joints;
    std::vector<glm::vec4> weights;
  };
  std::vector<Influences> influences;
};
/// Primitives with triangles; the material of those without one is the last of `materials`.
std::vector<Primitive> read_mesh(const Document& document, size_t mesh, const Materials& materials);
/// Targets added by their weights; those without a weight are left out.
Primitive morphed(const Primitive& primitive, const std::vector<double>& weights);

// --- skin.cpp
struct Node;
struct Skin {
  std::vector<int> joints;                  // nodes
  std::vector<glm::dmat4> joint_from_bind;  // inverseBindMatrices
};
std::vector<Skin> read_skins(const Document& document);
/// Refuses vertices that name a joint that the node's skin does not have.
void check_joints(const Document& document, const Node& node, const std::vector<Skin>& skins,
                  const std::vector<Primitive>& primitives);

// --- node.cpp
struct Node {
  std::string name;
  int parent = -1;
  int mesh = -1, camera = -1, light = -1, skin = -1;
  glm::dvec3 translation{0.0};
  glm::dquat rotation{1.0, 0.0, 0.0, 0.0};
  glm::dvec3 scale{1.0};
  std::optional<glm::dmat4> matrix;   // instead of the three
  std::vector<double> morph_weights;  // empty: the mesh's own
  std::vector<glm::dmat4> instances;  // EXT_mesh_gpu_instancing: the mesh is shown in each of these frames; else empty
};
std::vector<Node> read_nodes(const Document& document);
/// Nodes of the scene that is read (or the first, or all roots), every parent before its children.
std::vector<int> scene_nodes(const Document& document, const std::vector<Node>& nodes);
/// World transforms of all nodes; refuses infinite ones among those that `order` names.
std::vector<glm::dmat4> world_from_nodes(const std::filesystem::path& file, const std::vector<Node>& nodes,
                                         const std::vector<int>& order);

// --- animation.cpp
struct Channel {
  enum class Path { translation, rotation, scale, weights };
  enum class Interpolation { linear, step, cubic };
  int node = 0;
  Path path = Path::translation;
  Interpolation interpolation = Interpolation::linear;
  std::vector<float> times_s;
  size_t components = 3;
  std::vector<float> values;  // per key: the value, or in-tangent, value, out-tangent
};
std::vector<Channel> read_channels(const Document& document, const std::vector<Node>& nodes);
void animate(std::vector<Node>& nodes, const std::vector<Channel>& channels, double time_s);

// --- light_camera.cpp: as in the file, in the node's frame
std::vector<Light> read_lights(const Document& document);
std::vector<Camera> read_cameras(const Document& document);
Light place_light(Light light, const glm::dmat4& world_from_node, const glm::dvec3& world_origin);
/// @throws Error(bad_input) when the node's axes vanish. A far plane of 0 stays: infinite, for finite_far_plane().
Camera place_camera(const std::filesystem::path& file, Camera camera, const glm::dmat4& world_from_node,
                    const glm::dvec3& world_origin);
void finite_far_plane(Camera& camera, glm::vec3 bounds_min, glm::vec3 bounds_max);

// --- place.cpp
struct PlacedMesh {
  Mesh mesh;                          // without positions until the origin is known
  std::vector<glm::dvec3> positions;  // world
};
/// Counter-clockwise fronts, unit normals, no triangle without area (`dropped` counts those).
PlacedMesh place_primitive(const Primitive& primitive, const glm::dmat4& world_from_node, size_t& dropped);
/// The same by a skin, of whatever node shows it: each vertex where its joints carry it (glTF 2.0, 3.7.3.3).
/// @param world_from_bind  of each joint.
PlacedMesh place_skinned(const Primitive& primitive, const std::vector<glm::dmat4>& world_from_bind, size_t& dropped);
/// Positions relative to the origin; normals for what has none.
Mesh centred(PlacedMesh placed, const glm::dvec3& world_origin, size_t& dropped);

}  // namespace volgi::gltf
