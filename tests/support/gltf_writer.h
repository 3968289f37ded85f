#pragma once
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <glm/glm.hpp>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace volgi::test {

using Json = nlohmann::json;

/// A folder that goes with its owner.
class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

void write_bytes(const std::filesystem::path& path, const std::string& bytes);
std::string base64(const std::string& bytes);
/// A PNG of RGBA texels, row by row.
std::string png(int width, int height, const std::vector<std::uint8_t>& rgba);

constexpr int type_byte = 5120, type_ubyte = 5121, type_short = 5122, type_ushort = 5123, type_uint = 5125,
              type_float = 5126;

/// Writes glTF files from code: `root` is the JSON, which tests change at will.
class GltfWriter {
 public:
  Json root;
  std::string bin;

  GltfWriter();
  /// Index of a new buffer view on a copy of the values.
  template <typename T>
  int view(const std::vector<T>& values, int stride = 0) {
    bin.resize((bin.size() + 3) / 4 * 4);
    Json v = {{"buffer", 0}, {"byteOffset", bin.size()}, {"byteLength", values.size() * sizeof(T)}};
    if (stride != 0) v["byteStride"] = stride;
    bin.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
    return push("bufferViews", v);
  }
  template <typename T>
  int accessor(const std::vector<T>& values, const std::string& type, int component_type, bool normalized = false) {
    const int components = type == "SCALAR" ? 1 : type.back() - '0';
    Json a = {{"bufferView", view(values)},
              {"componentType", component_type},
              {"count", values.size() / size_t(components)},
              {"type", type}};
    if (normalized) a["normalized"] = true;
    return push("accessors", a);
  }
  int floats(const std::vector<float>& values, const std::string& type) { return accessor(values, type, type_float); }
  int push(const std::string& list, const Json& element);
  /// A mesh of one primitive, and a root node that shows it.
  int mesh_node(const Json& primitive, Json node = Json::object());
  /// One triangle (0,0,0) (1,0,0) (0,1,0) with front +Z, as a root node.
  int triangle(Json node = Json::object());

  /// JSON with the buffer's length filled in; `uri` empty for a .glb.
  Json finished(const std::string& uri) const;
  std::string glb() const;
  std::filesystem::path save_glb(const std::filesystem::path& path) const;
  /// With the buffer beside it.
  std::filesystem::path save_gltf(const std::filesystem::path& path, const std::string& buffer_name = "data.bin") const;
  std::filesystem::path save_embedded(const std::filesystem::path& path) const;
};

}  // namespace volgi::test
