#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <limits>

#include "core/gltf/gltf_internal.h"

namespace volgi::gltf {
namespace fs = std::filesystem;
namespace {

constexpr std::uint64_t largest_file = std::numeric_limits<std::int32_t>::max();  // tinygltf counts in int
constexpr std::string_view glb_magic = "glTF";

std::vector<unsigned char> read_file(const fs::path& file, const fs::path& path) {
  const std::uint64_t size = fs::file_size(path);
  if (size > largest_file) refuse(file, fmt::format("{} is larger than 2 GiB", path.filename().string()));
  std::ifstream stream(path, std::ios::binary);
  std::vector<unsigned char> bytes(size);
  stream.read(reinterpret_cast<char*>(bytes.data()), std::streamsize(size));
  if (!stream) refuse(file, fmt::format("{} cannot be read", path.filename().string()));
  return bytes;
}

std::string_view text_of(const std::vector<unsigned char>& bytes, size_t begin, size_t size) {
  return std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()).substr(begin, size);
}

std::uint64_t word_at(const std::vector<unsigned char>& bytes, size_t offset) {
  std::uint32_t word = 0;
  for (size_t i = 4; i-- > 0;) word = word << 8 | bytes[offset + i];  // little-endian
  return word;
}

/// JSON of a .glb, whose every chunk lies inside the file. (tinygltf forgets the second chunk's header.)
std::string_view glb_json(const fs::path& file, const std::vector<unsigned char>& bytes) {
  constexpr size_t header_size = 12, chunk_header_size = 8;
  constexpr std::uint64_t json_type = 0x4E4F534A;
  if (bytes.size() < header_size + chunk_header_size) refuse(file, "the .glb file is truncated in its header");
  if (word_at(bytes, 4) != 2) refuse(file, fmt::format("glTF version {} is not supported", word_at(bytes, 4)));
  const std::uint64_t length = word_at(bytes, 8);
  if (length > bytes.size()) {
    refuse(file, fmt::format("the .glb file is truncated: {} of {} bytes", bytes.size(), length));
  }
  for (std::uint64_t chunk = header_size; chunk < length;) {
    const bool has_header = length - chunk >= chunk_header_size;
    if (!has_header || word_at(bytes, chunk) > length - chunk - chunk_header_size) {
      refuse(file, fmt::format("the .glb chunk at byte {} is longer than the file", chunk));
    }
    chunk += chunk_header_size + word_at(bytes, chunk);
  }
  if (length < header_size + chunk_header_size || word_at(bytes, 16) != json_type) {
    refuse(file, "the .glb file does not begin with a JSON chunk");
  }
  return text_of(bytes, header_size + chunk_header_size, word_at(bytes, header_size));
}

/// tinygltf gets at the files that check_json resolved and at no other.
struct Files {
  const fs::path& document;
  ExternalFiles paths;

  static bool exists(const std::string& name, void* self) { return static_cast<Files*>(self)->paths.contains(name); }
  static std::string same(const std::string& name, void*) { return name; }
  static bool write(std::string*, const std::string&, const std::vector<unsigned char>&, void*) { return false; }
  static bool read(std::vector<unsigned char>* out, std::string*, const std::string& name, void* self) {
    const Files& files = *static_cast<Files*>(self);
    *out = read_file(files.document, files.paths.at(name));
    return true;
  }
};

/// Images are decoded later, if used; those in a buffer view are not looked at here because nothing has checked it yet.
bool keep_encoded(tinygltf::Image* image, int, std::string*, std::string*, int, int, const unsigned char* bytes,
                  int size, void*) {
  if (image->bufferView < 0) image->image.assign(bytes, bytes + std::max(size, 0));
  return true;
}

}  // namespace

Document read_document(const fs::path& path) {
  std::error_code error;
  if (!fs::exists(path, error)) refuse(path, "there is no such file");
  if (!fs::is_regular_file(path, error)) refuse(path, "not a file");
  const std::vector<unsigned char> bytes = read_file(path, path);
  const bool binary = text_of(bytes, 0, 4) == glb_magic;
  const std::string_view json = binary ? glb_json(path, bytes) : text_of(bytes, 0, bytes.size());

  Files files{path, check_json(path, json)};
  tinygltf::TinyGLTF parser;
  parser.SetFsCallbacks({Files::exists, Files::same, Files::read, Files::write, &files});
  parser.SetImageLoader(keep_encoded, nullptr);
  Document document{path, {}};
  std::string problems, warnings;
  bool parsed = false;
  const auto size = unsigned(bytes.size());
  try {
    parsed = binary ? parser.LoadBinaryFromMemory(&document.model, &problems, &warnings, bytes.data(), size, "")
                    : parser.LoadASCIIFromString(&document.model, &problems, &warnings, json.data(), size, "");
  } catch (const std::out_of_range& e) {  // an empty buffer
    problems = e.what();
  }
  if (!parsed) refuse(path, fmt::format("not a valid glTF file: {}", problems));
  if (!warnings.empty()) warn(path, warnings);
  return document;
}

}  // namespace volgi::gltf
