#pragma once
#include <array>
#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/camera.h"
#include "core/shared_bytes.h"

namespace volgi {

class Sky;

/// 8-bit RGBA as stored in the file (sRGB encoded where the use is colour), row 0 first as glTF has it (v = 0).
struct TextureImage {
  int width = 0;
  int height = 0;
  SharedBytes rgba;
};

enum class Wrap { repeat, mirrored_repeat, clamp_to_edge };

struct Sampler {
  Wrap wrap_s = Wrap::repeat;
  Wrap wrap_t = Wrap::repeat;
  bool magnify_nearest = false;
  bool minify_nearest = false;  // nearest within a level
  bool mipmap = true;           // any of the *_MIPMAP_* modes, or no mode given
  bool mipmap_nearest = false;
};

struct Texture {
  int image = -1;
  Sampler sampler;
};

/// Use of a texture by a material. uv = uv_from_texcoord * (texcoord, 1): KHR_texture_transform, identity without it.
struct TextureUse {
  int texture = -1;  // index into Scene::textures, -1 for none
  int texcoord = 0;  // 0 or 1
  glm::mat3 uv_from_texcoord{1.0f};
};

/// glass (KHR_materials_transmission): the base colour's alpha is the share of light that goes straight on, and the
/// base colour colours it; the rest is reflected as the base colour says (shared::pane_of).
enum class AlphaMode { opaque, mask, blend, glass };

struct Material {
  std::string name;
  glm::vec4 base_color_factor{1.0f};
  TextureUse base_color;          // sRGB
  float metallic_factor = 1.0f;   // glTF's default
  float roughness_factor = 1.0f;  // glTF's default
  TextureUse metallic;            // linear: blue metallic, green roughness
  // KHR_materials_specular and KHR_materials_ior. In files specularFactor is 1 unless they say so; 0 here is a surface
  // that is Lambertian but for its metal.
  float specular_factor = 0.0f;
  glm::vec3 specular_color_factor{1.0f};
  float ior = 1.5f;                   // index of refraction; 0: the mirror of an infinite one
  bool lambertian = false;            // nothing shines, not even metal (--materials lambert)
  bool phong = false;                 // mirrors are Phong lobes of that roughness (--materials phong)
  glm::vec3 emissive_radiance{0.0f};  // emissiveFactor · emissiveStrength [W m^-2 sr^-1]
  TextureUse emissive;                // sRGB
  AlphaMode alpha_mode = AlphaMode::opaque;
  float alpha_cutoff = 0.5f;
  TextureUse normal;  // linear, in tangent space; moves shading normals
  float normal_scale = 1.0f;
  bool unlit = false;         // KHR_materials_unlit: seen as its colour, stops light, sends none
  bool double_sided = false;  // matters for emission only: every triangle blocks and reflects on both sides

  /// Reflectance from in front of what is no metal; at grazing angles it is specular_factor.
  glm::vec3 dielectric_0() const {
    const float r = ior > 0.0f ? (ior - 1.0f) / (ior + 1.0f) : 1.0f;
    return specular_factor * glm::min(r * r * specular_color_factor, glm::vec3(1.0f));
  }
  bool passes_by_chance() const { return alpha_mode == AlphaMode::blend || alpha_mode == AlphaMode::glass; }
  bool is_emissive() const { return emissive_radiance != glm::vec3(0.0f); }
};

/// One glTF primitive of one node, already in the scene's centred world frame. Indexed triangle list.
/// normals has the size of positions; uv[0], uv[1], colors are empty when the file has none.
/// Winding: the front face is counter-clockwise seen from outside, also under mirroring node transforms.
struct Mesh {
  std::string name;
  int material = 0;
  std::uint32_t object_id = 0;  // 1 + index of the glTF node; pixels without geometry have id 0
  std::vector<glm::vec3> positions;
  std::vector<glm::vec3> normals;  // unit length
  std::array<std::vector<glm::vec2>, 2> uv;
  std::vector<glm::vec4> colors;  // linear COLOR_0
  std::vector<glm::uvec3> triangles;
};

/// Punctual light (KHR_lights_punctual), in the centred frame. Units: docs/conventions.md#radiometry.
struct Light {
  enum class Type { point, spot, directional };
  std::string name;
  Type type = Type::point;
  glm::vec3 position{0.0f};
  glm::vec3 direction{0.0f, 0.0f, -1.0f};  // unit, the way light travels
  glm::vec3 intensity{0.0f};               // color · intensity: radiant intensity [W/sr], or irradiance for a sun
  float inner_cone_rad = 0.0f;
  float outer_cone_rad = 0.785398163f;
  float range_m = 0.0f;  // 0: unlimited
};

/// A scene at one instant: world-space triangles, materials, lights, cameras. Everything in float is relative to
/// `world_origin`, which was subtracted in double.
struct Scene {
  std::string name;  // file stem
  std::filesystem::path path;
  glm::dvec3 world_origin{0.0};
  std::vector<Mesh> meshes;
  std::vector<Material> materials;  // never empty: meshes without one use a default material
  std::vector<TextureImage> images;
  std::vector<Texture> textures;
  std::vector<Light> lights;
  std::vector<Camera> cameras;
  std::shared_ptr<const Sky> sky;  // core/sky.h; none: black outside
  glm::vec3 bounds_min{0.0f};      // of all triangles; both zero when there are none
  glm::vec3 bounds_max{0.0f};

  size_t triangle_count() const;
};

/// A box in the file's world frame [m]; empty until something is in it.
struct WorldBox {
  glm::dvec3 min{std::numeric_limits<double>::infinity()};
  glm::dvec3 max{-std::numeric_limits<double>::infinity()};

  bool empty() const { return min.x > max.x; }
  glm::dvec3 centre() const { return 0.5 * (min + max); }
  void add(const WorldBox& other) {
    min = glm::min(min, other.min);
    max = glm::max(max, other.max);
  }
};

/// How a glTF file is read.
struct SceneReading {
  /// Of its scenes; none: the file's default, else the first.
  std::optional<int> scene;
  /// Of its animations: a number, a name, or "all"; empty: all, but of those that move the same node in the same way
  /// the first alone.
  std::string animation;
  /// Folder that the file's references may not leave; empty: the file's own.
  std::filesystem::path root;
  /// Faults that can be repaired are refused, not warned about.
  bool strict = false;
};

/// A glTF file in memory, from which the scene at any time is made.
/// @throws Error(bad_input) naming file and element: not glTF, truncated, missing buffer or image, an unknown required
///   extension, indices out of range, NaN or infinite vertices, cyclic nodes, a path that leaves the root folder;
///   Error(usage) for a scene or an animation that it has not.
/// What is ignored, and what is repaired, is warned about once.
class SceneFile {
 public:
  explicit SceneFile(const std::filesystem::path& path, const SceneReading& reading = {});
  ~SceneFile();
  SceneFile(SceneFile&&) noexcept;
  SceneFile& operator=(SceneFile&&) noexcept;

  /// The scene with the file's animations (SceneReading::animation) at `time_s`, held before their first and after
  /// their last key (none: the rest pose). Cost: copies geometry and images.
  /// @throws Error(bad_input) when the transforms of that time are not finite.
  Scene at(double time_s) const;
  /// The same, centred on `box` and with it as its bounds, instead of those of the triangles at that time: what follows
  /// from the bounds (the volume's grid, far planes, a sun's shadow map) then stands still while things move.
  /// @param box  around the triangles of all times that matter: the sum of bounds().
  Scene at(double time_s, const WorldBox& box) const;
  /// Makes at(time_s, box) of a scene that at() of this file made. Materials, textures and images stay where they are.
  /// @throws Error as at(); the scene is then as it was.
  void move(Scene& scene, double time_s, const WorldBox& box) const;
  /// Around all triangles at a time; empty when there are none.
  WorldBox bounds(double time_s) const;
  bool animated() const;
  /// Time of the last key of all animations [s]; 0 without any.
  double last_key_s() const;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

/// SceneSource(path).at(time_s) (core/scene_source.h): of a glTF file, or a scene that is called builtin:NAME.
Scene load_scene(const std::filesystem::path& path, double time_s = 0.0, const SceneReading& reading = {});

/// Removes triangles that lie exactly on an earlier one with the same front: one surface, not two, for everything that
/// counts area or emission. Triangles back to back stay; so do layers of another material that can be seen through,
/// lifted in front of the surface by 2e-5 of the scene's diagonal. @returns how many went. Cost: one hash a triangle.
size_t drop_duplicate_triangles(Scene& scene);

/// Puts what `other` has beside what `scene` has: geometry and lights where they are in the world, cameras behind
/// scene's; its sky where scene has none. Bounds and origin stay those of `scene` but for growing, so that what lies
/// far from its origin loses precision.
void append_scene(Scene& scene, const Scene& other);

/// Recomputes bounds_min and bounds_max from the meshes (for scenes built in code).
void update_bounds(Scene& scene);

}  // namespace volgi
