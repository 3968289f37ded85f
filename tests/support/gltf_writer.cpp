#include "tests/support/gltf_writer.h"

#include <stb/stb_image_write.h>
#include <unistd.h>

#include <atomic>

namespace volgi::test {
namespace fs = std::filesystem;

TemporaryFolder::TemporaryFolder() {
  static std::atomic<int> counter{0};
  path_ = fs::temp_directory_path() / ("volgi-test-" + std::to_string(getpid()) + "-" + std::to_string(counter++));
  fs::create_directories(path_);
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

void write_bytes(const fs::path& path, const std::string& bytes) {
  std::ofstream stream(path, std::ios::binary);
  stream.write(bytes.data(), std::streamsize(bytes.size()));
}

std::string base64(const std::string& bytes) {
  constexpr const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t triple = 0;
    for (size_t k = 0; k < 3; ++k) triple = triple << 8 | (i + k < bytes.size() ? std::uint8_t(bytes[i + k]) : 0u);
    for (size_t k = 0; k < 4; ++k) out += i + k > bytes.size() ? '=' : digits[triple >> (18 - 6 * k) & 63];
  }
  return out;
}

std::string png(int width, int height, const std::vector<std::uint8_t>& rgba) {
  std::string out;
  const auto append = [](void* to, void* data, int size) {
    static_cast<std::string*>(to)->append(static_cast<const char*>(data), size_t(size));
  };
  stbi_write_png_to_func(append, &out, width, height, 4, rgba.data(), 4 * width);
  return out;
}

GltfWriter::GltfWriter() { root["asset"] = {{"version", "2.0"}}; }

int GltfWriter::push(const std::string& list, const Json& element) {
  root[list].push_back(element);
  return int(root[list].size()) - 1;
}

int GltfWriter::mesh_node(const Json& primitive, Json node) {
  node["mesh"] = push("meshes", {{"primitives", Json::array({primitive})}});
  return push("nodes", node);
}

int GltfWriter::triangle(Json node) {
  const int positions = floats({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3");
  return mesh_node({{"attributes", {{"POSITION", positions}}}}, std::move(node));
}

Json GltfWriter::finished(const std::string& uri) const {
  Json json = root;
  if (json.contains("buffers") || bin.empty()) return json;
  Json buffer = {{"byteLength", bin.size()}};
  if (!uri.empty()) buffer["uri"] = uri;
  json["buffers"] = Json::array({buffer});
  return json;
}

std::string GltfWriter::glb() const {
  const auto word = [](size_t value) {
    std::string bytes(4, '\0');
    for (size_t i = 0; i < 4; ++i) bytes[i] = char(value >> (8 * i) & 255);
    return bytes;
  };
  std::string json = finished("").dump();
  json.resize((json.size() + 3) / 4 * 4, ' ');
  std::string data = bin;
  data.resize((data.size() + 3) / 4 * 4);
  std::string chunks = word(json.size()) + "JSON" + json;
  if (!data.empty()) chunks += word(data.size()) + std::string("BIN\0", 4) + data;
  return "glTF" + word(2) + word(12 + chunks.size()) + chunks;
}

fs::path GltfWriter::save_glb(const fs::path& path) const {
  write_bytes(path, glb());
  return path;
}

fs::path GltfWriter::save_gltf(const fs::path& path, const std::string& buffer_name) const {
  write_bytes(path.parent_path() / buffer_name, bin);
  write_bytes(path, finished(buffer_name).dump());
  return path;
}

fs::path GltfWriter::save_embedded(const fs::path& path) const {
  write_bytes(path, finished("data:application/octet-stream;base64," + base64(bin)).dump());
  return path;
}

}  // namespace volgi::test
