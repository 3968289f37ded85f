// EXT_meshopt_compression.
#include <fmt/format.h>
#include <meshoptimizer.h>

#include <algorithm>
#include <limits>

#include "core/error.h"
#include "core/gltf/gltf_internal.h"

namespace volgi::gltf {
namespace {

/// What a view of the extension says about its data.
struct Compressed {
  int buffer = -1;
  size_t offset = 0, length = 0, stride = 0, count = 0;
  std::string mode, filter;
};

size_t number_of(const tinygltf::Value& value, const char* name) {
  if (!value.Has(name) || !value.Get(name).IsNumber()) return 0;
  const double number = value.Get(name).GetNumberAsDouble();
  return number > 0.0 && number < 9e15 ? size_t(number) : 0;
}

std::string text_of(const tinygltf::Value& value, const char* name) {
  return value.Has(name) && value.Get(name).IsString() ? value.Get(name).Get<std::string>() : std::string();
}

Compressed read_extension(const tinygltf::Value& in) {
  Compressed c;
  if (in.Has("buffer") && in.Get("buffer").IsNumber()) c.buffer = in.Get("buffer").GetNumberAsInt();
  c.offset = number_of(in, "byteOffset");
  c.length = number_of(in, "byteLength");
  c.stride = number_of(in, "byteStride");
  c.count = number_of(in, "count");
  c.mode = text_of(in, "mode");
  c.filter = text_of(in, "filter");
  return c;
}

/// What the decoders take for granted.
void check(const Document& document, const Compressed& c, const std::string& who) {
  const bool vertices = c.mode == "ATTRIBUTES";
  const bool good_stride = vertices ? c.stride % 4 == 0 && c.stride >= 4 && c.stride <= 256  //
                                    : c.stride == 2 || c.stride == 4;
  if (!good_stride || (!vertices && c.mode != "TRIANGLES" && c.mode != "INDICES") ||
      (c.mode == "TRIANGLES" && c.count % 3 != 0)) {
    refuse(document.path, fmt::format("{}: mode '{}', {} elements, byteStride {} make no sense together", who, c.mode,
                                      c.count, c.stride));
  }
  const bool good_filter = c.filter.empty() || c.filter == "NONE" ||
                           (vertices && ((c.filter == "OCTAHEDRAL" && (c.stride == 4 || c.stride == 8)) ||
                                         (c.filter == "QUATERNION" && c.stride == 8) || c.filter == "EXPONENTIAL"));
  if (!good_filter)
    refuse(document.path, fmt::format("{}: the filter '{}' does not go with byteStride {}", who, c.filter, c.stride));
  // Of codes that say the same again and again a byte stands for some hundred elements.
  constexpr size_t most_per_byte = 4096;
  if (c.count > std::numeric_limits<std::uint32_t>::max() / 256 || c.count > most_per_byte * (c.length + 1))
    refuse(document.path, fmt::format("{}: {} elements in {} bytes", who, c.count, c.length));
}

void unfilter(const Compressed& c, std::vector<unsigned char>& out) {
  if (c.filter == "OCTAHEDRAL") meshopt_decodeFilterOct(out.data(), c.count, c.stride);
  if (c.filter == "QUATERNION") meshopt_decodeFilterQuat(out.data(), c.count, c.stride);
  if (c.filter == "EXPONENTIAL") meshopt_decodeFilterExp(out.data(), c.count, c.stride);
}

std::vector<unsigned char> decoded(const Document& document, const Compressed& c, const std::string& who) {
  check_index(document, c.buffer, document.model.buffers.size(), who, "buffer");
  const std::vector<unsigned char>& data = document.model.buffers[size_t(c.buffer)].data;
  if (c.offset > data.size() || c.length > data.size() - c.offset) {
    refuse(document.path, fmt::format("{}: bytes {} + {} lie outside buffer {} ({} bytes)", who, c.offset, c.length,
                                      c.buffer, data.size()));
  }
  check(document, c, who);
  std::vector<unsigned char> out(c.count * c.stride);
  const unsigned char* in = data.data() + c.offset;
  int failed = 0;
  if (c.count > 0 && c.mode == "ATTRIBUTES") {
    failed = meshopt_decodeVertexBuffer(out.data(), c.count, c.stride, in, c.length);
  } else if (c.count > 0 && c.mode == "TRIANGLES") {
    failed = meshopt_decodeIndexBuffer(out.data(), c.count, c.stride, in, c.length);
  } else if (c.count > 0) {
    failed = meshopt_decodeIndexSequence(out.data(), c.count, c.stride, in, c.length);
  }
  if (failed != 0) refuse(document.path, fmt::format("{}: the compressed data are damaged", who));
  unfilter(c, out);
  return out;
}

}  // namespace

void decompress_meshopt(Document& document) {
  for (size_t i = 0; i < document.model.bufferViews.size(); ++i) {
    const auto extension = document.model.bufferViews[i].extensions.find("EXT_meshopt_compression");
    if (extension == document.model.bufferViews[i].extensions.end()) continue;
    const std::string who = fmt::format("buffer view {} (EXT_meshopt_compression)", i);
    const Compressed c = read_extension(extension->second);
    const int made = add_view(document, decoded(document, c, who), who);
    tinygltf::BufferView& view = document.model.bufferViews[i];
    view.buffer = document.model.bufferViews[size_t(made)].buffer;
    view.byteOffset = 0;
    view.byteLength = c.count * c.stride;
    view.byteStride = c.mode == "ATTRIBUTES" ? c.stride : 0;
  }
}

int add_view(Document& document, std::vector<unsigned char> bytes, const std::string& who) {
  // Small files may unfold to much: as much as 2 GiB of them, which is what a file may have itself.
  constexpr size_t most = size_t(1) << 31;
  size_t all = bytes.size();
  for (const tinygltf::Buffer& buffer : document.model.buffers) all += buffer.data.size();
  if (all > 2 * most)
    throw Error(ExitCode::over_limit,
                fmt::format("{}: {}: decompressed, the file is larger than 4 GiB", document.path.string(), who));
  tinygltf::BufferView view;
  view.buffer = int(document.model.buffers.size());
  view.byteLength = bytes.size();
  document.model.buffers.emplace_back().data = std::move(bytes);
  document.model.bufferViews.push_back(std::move(view));
  return int(document.model.bufferViews.size()) - 1;
}

}  // namespace volgi::gltf
