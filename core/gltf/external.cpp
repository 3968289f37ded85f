#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <nlohmann/json.hpp>
#include <string>

#include "core/gltf/gltf_internal.h"

namespace volgi::gltf {
namespace {

using Json = nlohmann::json;

/// A picture of one white texel, for tinygltf, which refuses images that are nowhere. It is never looked at.
constexpr std::string_view PLACEHOLDER = "missing";

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return char(std::tolower(c)); });
  return text;
}

bool is_data(const std::string& uri) { return lower(uri.substr(0, 5)) == "data:"; }

/// Bytes of a data URI of any media type (RFC 2397); the type is a hint, the bytes say what they are. As browsers read
/// them: escapes and white space in base64, any case.
std::vector<unsigned char> data_of(const std::filesystem::path& file, const std::string& who, const std::string& uri) {
  const size_t comma = uri.find(',');
  if (comma == std::string::npos) refuse(file, fmt::format("{} has a data URI without data", who));
  if (!lower(uri.substr(0, comma)).ends_with("base64")) {
    const std::optional<std::string> plain = percent_decoded(uri.substr(comma + 1));
    if (!plain) refuse(file, fmt::format("{} has a malformed data URI", who));
    return {plain->begin(), plain->end()};
  }
  std::vector<unsigned char> bytes;
  std::string mime_type;
  // Of an empty one tinygltf says that it failed.
  std::string encoded = uri.substr(comma + 1);
  if (encoded.find('%') != std::string::npos) encoded = percent_decoded(encoded).value_or(encoded);
  std::erase_if(encoded, [](unsigned char c) { return std::isspace(c) != 0; });
  const std::string known = "data:application/octet-stream;base64," + encoded;
  if (!encoded.empty() && !tinygltf::DecodeDataURI(&bytes, mime_type, known, 0, false))
    refuse(file, fmt::format("{} has a malformed data URI", who));
  return bytes;
}

class ExternalTaker {
 public:
  ExternalTaker(const std::filesystem::path& file, const SceneReading& reading, CheckedJson& out)
      : file_(file), reading_(reading), out_(out) {}

  void buffers(Json& list) {
    for (size_t i = 0; i < list.size(); ++i) {
      Json& buffer = list[i];
      const std::string who = fmt::format("buffers[{}]", i);
      if (!buffer.is_object()) continue;
      const bool fallback = meshopt_fallback(buffer);
      if (!buffer.contains("uri") && !fallback) continue;
      External external;
      if (fallback) {  // what its views hold is compressed elsewhere
        buffer["byteLength"] = 1;
        external.bytes = {0};
      } else {
        external = *taken(buffer["uri"].get<std::string>(), who, true);
      }
      if (buffer.contains("byteLength")) external.size = buffer["byteLength"].get<size_t>();
      name(buffer, fmt::format("buffer-{}", i), std::move(external));
    }
  }

  void images(Json& list) {
    for (size_t i = 0; i < list.size(); ++i) {
      Json& image = list[i];
      if (!image.is_object() || !image.contains("uri")) continue;
      const std::string uri = image["uri"].get<std::string>();
      if (!image.contains("name") && !is_data(uri)) image["name"] = uri;  // for messages
      std::optional<External> external = taken(uri, fmt::format("images[{}]", i), false);
      if (!external) {
        out_.missing_images.insert(int(i));
        external.emplace().bytes.assign(PLACEHOLDER.begin(), PLACEHOLDER.end());
      }
      name(image, fmt::format("image-{}", i), std::move(*external));
    }
  }

 private:
  static bool meshopt_fallback(const Json& buffer) {
    const auto extensions = buffer.find("extensions");
    if (extensions == buffer.end() || !extensions->is_object()) return false;
    const auto meshopt = extensions->find("EXT_meshopt_compression");
    return meshopt != extensions->end() && meshopt->is_object() && meshopt->value("fallback", false);
  }

  /// Nothing where it is not there and need not be.
  std::optional<External> taken(const std::string& uri, const std::string& who, bool needed) const {
    if (is_data(uri)) return External{{}, data_of(file_, who, uri), {}, who};
    if (!needed && !reading_.strict && is_elsewhere(uri)) return std::nullopt;  // a picture: it counts as white
    const std::optional<std::filesystem::path> path = resolve_uri(file_, reading_, who, uri);
    if (path) return External{*path, {}, {}, uri};
    if (needed) refuse(file_, fmt::format("{}: missing file '{}'", who, uri));
    return std::nullopt;
  }

  void name(Json& holder, const std::string& name, External external) {
    holder["uri"] = name;
    out_.externals.emplace(name, std::move(external));
  }

  const std::filesystem::path& file_;
  const SceneReading& reading_;
  CheckedJson& out_;
};

/// tinygltf refuses indices that lie in no buffer view; those of compressed primitives are decoded later.
void drop_compressed_indices(Json& meshes) {
  for (Json& mesh : meshes) {
    if (!mesh.is_object() || !mesh.contains("primitives")) continue;
    for (Json& primitive : mesh["primitives"]) {
      const auto extensions = primitive.find("extensions");
      if (extensions != primitive.end() && extensions->contains("KHR_draco_mesh_compression"))
        primitive.erase("indices");
    }
  }
}

}  // namespace

void take_externals(const std::filesystem::path& file, const SceneReading& reading, Json& root, CheckedJson& out) {
  ExternalTaker taker(file, reading, out);
  if (root.contains("buffers")) taker.buffers(root["buffers"]);
  if (root.contains("images")) taker.images(root["images"]);
  if (root.contains("meshes")) drop_compressed_indices(root["meshes"]);
}

}  // namespace volgi::gltf
