#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <limits>
#include <new>

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

struct Chunks {
  std::string_view json;
  std::string_view binary;
};

/// Of a .glb, whose every chunk lies inside the file; what is neither JSON nor BIN is passed over (glTF 2.0, 4.4).
Chunks glb_chunks(const fs::path& file, const std::vector<unsigned char>& bytes) {
  constexpr size_t header_size = 12, chunk_header_size = 8;
  constexpr std::uint64_t json_type = 0x4E4F534A, binary_type = 0x004E4942;
  if (bytes.size() < header_size + chunk_header_size) refuse(file, "the .glb file is truncated in its header");
  if (word_at(bytes, 4) != 2) refuse(file, fmt::format("glTF version {} is not supported", word_at(bytes, 4)));
  const std::uint64_t length = word_at(bytes, 8);
  if (length > bytes.size()) {
    refuse(file, fmt::format("the .glb file is truncated: {} of {} bytes", bytes.size(), length));
  }
  std::string_view binary;
  for (std::uint64_t chunk = header_size; chunk < length;) {
    const bool has_header = length - chunk >= chunk_header_size;
    if (!has_header || word_at(bytes, chunk) > length - chunk - chunk_header_size) {
      refuse(file, fmt::format("the .glb chunk at byte {} is longer than the file", chunk));
    }
    const std::uint64_t size = word_at(bytes, chunk);
    if (binary.empty() && word_at(bytes, chunk + 4) == binary_type)
      binary = text_of(bytes, chunk + chunk_header_size, size);
    chunk += chunk_header_size + size;
  }
  if (length < header_size + chunk_header_size || word_at(bytes, 16) != json_type) {
    refuse(file, "the .glb file does not begin with a JSON chunk");
  }
  return {text_of(bytes, header_size + chunk_header_size, word_at(bytes, header_size)), binary};
}

/// A .glb of these chunks.
std::string glb_of(std::string json, std::string_view binary) {
  const auto padded = [](size_t size) { return (size + 3) / 4 * 4; };
  json.resize(padded(json.size()), ' ');
  const auto word = [](size_t value) {
    std::string out;
    for (int byte = 0; byte < 4; ++byte) out += char(value >> (8 * byte) & 255u);
    return out;
  };
  constexpr size_t header_size = 12, chunk_header_size = 8;
  const size_t binary_size = padded(binary.size());
  const size_t size =
      header_size + chunk_header_size + json.size() + (binary.empty() ? 0 : chunk_header_size + binary_size);
  std::string out = std::string(glb_magic) + word(2) + word(size) + word(json.size()) + "JSON" + json;
  if (binary.empty()) return out;
  out.reserve(size);
  out.append(word(binary_size)).append("BIN\0", 4).append(binary).append(binary_size - binary.size(), '\0');
  return out;
}

/// tinygltf gets at what check_json has named and at nothing else.
struct Files {
  const fs::path& document;
  Externals externals;

  static bool exists(const std::string& name, void* self) {
    return static_cast<Files*>(self)->externals.contains(name);
  }
  static std::string same(const std::string& name, void*) { return name; }
  static bool write(std::string*, const std::string&, const std::vector<unsigned char>&, void*) { return false; }
  /// A buffer may be longer than the JSON says (glTF 2.0, 3.6.1).
  static bool read(std::vector<unsigned char>* out, std::string*, const std::string& name, void* self) {
    Files& files = *static_cast<Files*>(self);
    External& from = files.externals.at(name);
    *out = from.path.empty() ? std::move(from.bytes) : read_file(files.document, from.path);
    if (from.size && out->size() < *from.size) {
      refuse(files.document, fmt::format("{}: {} bytes instead of {}", from.shown, out->size(), *from.size));
    }
    if (from.size) out->resize(*from.size);
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

Document read_document(const fs::path& path, const SceneReading& reading) {
  std::error_code error;
  if (!fs::exists(path, error)) refuse(path, "there is no such file");
  if (!fs::is_regular_file(path, error)) refuse(path, "not a file");
  Document document{path, reading, {}, {}};
  std::string text;
  bool binary = false;
  Files files{path, {}};
  {
    const std::vector<unsigned char> bytes = read_file(path, path);
    binary = text_of(bytes, 0, 4) == glb_magic;
    const Chunks chunks = binary ? glb_chunks(path, bytes) : Chunks{text_of(bytes, 0, bytes.size()), {}};
    CheckedJson checked = check_json(path, reading, chunks.json);
    text = binary ? glb_of(std::move(checked.text), chunks.binary) : std::move(checked.text);
    files.externals = std::move(checked.externals);
    document.missing_images = std::move(checked.missing_images);
  }
  if (text.size() > largest_file) refuse(path, "its text is larger than 2 GiB");

  tinygltf::TinyGLTF parser;
  parser.SetFsCallbacks({Files::exists, Files::same, Files::read, Files::write, &files});
  parser.SetImageLoader(keep_encoded, nullptr);
  std::string problems, warnings;
  bool parsed = false;
  const auto size = unsigned(text.size());
  try {
    parsed = binary ? parser.LoadBinaryFromMemory(&document.model, &problems, &warnings,
                                                  reinterpret_cast<const unsigned char*>(text.data()), size, "")
                    : parser.LoadASCIIFromString(&document.model, &problems, &warnings, text.data(), size, "");
  } catch (const std::out_of_range& e) {  // an empty buffer
    problems = e.what();
  }
  if (problems.find(std::bad_alloc().what()) != std::string::npos) throw std::bad_alloc();  // which tinygltf catches
  if (!parsed) refuse(path, fmt::format("not a valid glTF file: {}", problems));
  if (!warnings.empty()) warn(path, warnings);
  decompress_meshopt(document);
  decompress_draco(document);
  return document;
}

}  // namespace volgi::gltf
