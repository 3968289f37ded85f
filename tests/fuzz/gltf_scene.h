#pragma once
// What a scene is that was read: whatever its file said, nobody who uses it looks at its indices again.
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>
#include <string>

#include "core/scene.h"
#include "tests/fuzz/input.h"

namespace volgi::fuzz {

inline void must(bool holds, const char* what) {
  if (!holds) wrong(what);
}

inline void check_scene(const Scene& scene) {
  must(!scene.materials.empty(), "a scene without materials");
  for (const Mesh& mesh : scene.meshes) {
    const size_t vertices = mesh.positions.size();
    must(mesh.material >= 0 && size_t(mesh.material) < scene.materials.size(), "a material that is not there");
    must(mesh.normals.size() == vertices, "another number of normals");
    for (const auto& uv : mesh.uv) must(uv.empty() || uv.size() == vertices, "another number of texture coordinates");
    must(mesh.colors.empty() || mesh.colors.size() == vertices, "another number of colours");
    for (const glm::uvec3& t : mesh.triangles)
      must(t.x < vertices && t.y < vertices && t.z < vertices, "a vertex that is not there");
    for (const glm::vec3& p : mesh.positions)
      must(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z), "a place that is no number");
    for (const glm::vec3& n : mesh.normals)
      must(std::isfinite(n.x) && std::isfinite(n.y) && std::isfinite(n.z), "a normal that is no number");
  }
  for (const Texture& texture : scene.textures)
    must(texture.image >= 0 && size_t(texture.image) < scene.images.size(), "an image that is not there");
  for (const TextureImage& image : scene.images)
    must(image.rgba.size() == size_t(image.width) * size_t(image.height) * 4, "another number of texels");
}

/// A .glb of a JSON and a buffer.
inline std::string glb(const nlohmann::json& root, std::string binary) {
  std::string text = root.dump();
  text.resize((text.size() + 3) / 4 * 4, ' ');
  binary.resize((binary.size() + 3) / 4 * 4);
  std::string out;
  const auto number = [&](size_t value) {
    const auto word = std::uint32_t(value);
    out.append(reinterpret_cast<const char*>(&word), sizeof word);
  };
  for (const size_t value : {size_t(0x46546C67), size_t(2), 28 + text.size() + binary.size(), text.size()})
    number(value);
  number(0x4E4F534A);
  out += text;
  number(binary.size());
  number(0x004E4942);
  return out + binary;
}

/// Reads a .glb or .gltf as programs do: its bounds at all times, and the scene at some time of its animations.
inline void read_scene(const std::filesystem::path& file) {
  read_or_refuse([&] {
    constexpr double time_s = 0.4;
    check_scene(load_scene(file, time_s));
  });
}

}  // namespace volgi::fuzz
