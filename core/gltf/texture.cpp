#include <fmt/format.h>
#include <stb/stb_image.h>
#include <tbb/parallel_for.h>
#include <webp/decode.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <memory>
#include <utility>

#include "core/encoded_picture_internal.h"
#include "core/gltf/gltf_internal.h"
#include "core/progress.h"

namespace volgi::gltf {
namespace {

constexpr int largest_edge = 32768;
constexpr std::int64_t max_pixels = std::int64_t(1) << 28;  // 1 GiB of RGBA

bool is_webp(Bytes bytes) {
  return bytes.size >= 12 && std::equal(bytes.data, bytes.data + 4, "RIFF") &&
         std::equal(bytes.data + 8, bytes.data + 12, "WEBP");
}

/// glTF allows PNG and JPEG; stb's decoders of other formats are never let near a file.
bool is_png_or_jpeg(Bytes bytes) {
  const auto begins_with = [&](std::initializer_list<unsigned char> magic) {
    return bytes.size >= magic.size() && std::equal(magic.begin(), magic.end(), bytes.data);
  };
  const EncodedPicture picture(bytes.data, bytes.size);
  if (begins_with({0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'})) return png_chunks_fit(picture);
  return begins_with({0xff, 0xd8, 0xff}) && jpeg_tables_fit(picture);
}

constexpr int gl_clamp = 0x2900;  // of OpenGL before 3.1; never glTF's

Wrap wrap_of(const Document& document, int mode, const std::string& who) {
  switch (mode) {
    case TINYGLTF_TEXTURE_WRAP_REPEAT:
      return Wrap::repeat;
    case TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT:
      return Wrap::mirrored_repeat;
    case TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE:
      return Wrap::clamp_to_edge;
    case gl_clamp:
      repair(document, fmt::format("{}: wrap mode GL_CLAMP counts as CLAMP_TO_EDGE", who));
      return Wrap::clamp_to_edge;
    default:
      refuse(document.path, fmt::format("{} has the unknown wrap mode {}", who, mode));
  }
}

Sampler read_sampler(const Document& document, int index, const std::string& who) {
  Sampler sampler;
  if (index < 0) return sampler;
  check_index(document, index, document.model.samplers.size(), who, "sampler");
  const tinygltf::Sampler& in = document.model.samplers[size_t(index)];
  const std::string name = element("sampler", size_t(index), in.name);
  sampler.wrap_s = wrap_of(document, in.wrapS, name);
  sampler.wrap_t = wrap_of(document, in.wrapT, name);
  sampler.magnify_nearest = in.magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST;
  const int minify = in.minFilter;
  const bool known = minify == -1 || minify == TINYGLTF_TEXTURE_FILTER_NEAREST ||
                     minify == TINYGLTF_TEXTURE_FILTER_LINEAR ||
                     (minify >= TINYGLTF_TEXTURE_FILTER_NEAREST_MIPMAP_NEAREST &&
                      minify <= TINYGLTF_TEXTURE_FILTER_LINEAR_MIPMAP_LINEAR);
  if (!known) refuse(document.path, fmt::format("{} has the unknown minFilter {}", name, minify));
  sampler.minify_nearest = minify == TINYGLTF_TEXTURE_FILTER_NEAREST ||
                           minify == TINYGLTF_TEXTURE_FILTER_NEAREST_MIPMAP_NEAREST ||
                           minify == TINYGLTF_TEXTURE_FILTER_NEAREST_MIPMAP_LINEAR;
  sampler.mipmap = minify != TINYGLTF_TEXTURE_FILTER_NEAREST && minify != TINYGLTF_TEXTURE_FILTER_LINEAR;
  sampler.mipmap_nearest = minify == TINYGLTF_TEXTURE_FILTER_NEAREST_MIPMAP_NEAREST ||
                           minify == TINYGLTF_TEXTURE_FILTER_LINEAR_MIPMAP_NEAREST;
  return sampler;
}

glm::vec2 pair(const Document& document, const tinygltf::Value& value, glm::vec2 otherwise, const std::string& who) {
  if (!value.IsArray()) return otherwise;
  const glm::vec2 read = value.ArrayLen() == 2
                             ? glm::vec2(value.Get(0).GetNumberAsDouble(), value.Get(1).GetNumberAsDouble())
                             : glm::vec2(std::numeric_limits<float>::infinity());
  if (!std::isfinite(read.x) || !std::isfinite(read.y)) {
    refuse(document.path, fmt::format("{}: KHR_texture_transform needs two numbers for offset and scale", who));
  }
  return read;
}

/// Applies KHR_texture_transform. Rotation by the extension's example (the lower left quadrant with offset (0,1),
/// rotation 90 degrees, scale 0.5): u' = u cos + v sin, v' = -u sin + v cos.
void apply_transform(const Document& document, const tinygltf::Value& transform, TextureUse& use,
                     const std::string& who) {
  const glm::vec2 offset = pair(document, transform.Get("offset"), glm::vec2(0.0f), who);
  const glm::vec2 scale = pair(document, transform.Get("scale"), glm::vec2(1.0f), who);
  const double angle_rad = transform.Has("rotation") ? transform.Get("rotation").GetNumberAsDouble() : 0.0;
  const auto c = float(std::cos(angle_rad));
  const auto s = float(std::sin(angle_rad));
  use.uv_from_texcoord = glm::mat3(glm::vec3(c * scale.x, -s * scale.x, 0.0f),
                                   glm::vec3(s * scale.y, c * scale.y, 0.0f), glm::vec3(offset, 1.0f));
  if (transform.Has("texCoord")) use.texcoord = transform.Get("texCoord").GetNumberAsInt();
}

}  // namespace

namespace {

void check_size(const Document& document, int width, int height, Bytes bytes, const std::string& name) {
  if (width >= 1 && height >= 1 && width <= largest_edge && height <= largest_edge &&
      std::int64_t(width) * height <= max_pixels && pixels_fit(std::int64_t(width) * height, bytes.size))
    return;
  refuse(document.path, fmt::format("{} has {}x{} pixels, which is too large", name, width, height));
}

TextureImage decode_webp(const Document& document, Bytes bytes, const std::string& name) {
  int width = 0, height = 0;
  if (WebPGetInfo(bytes.data, bytes.size, &width, &height) == 0)
    refuse(document.path, fmt::format("{} is no WebP that can be read", name));
  check_size(document, width, height, bytes, name);
  TextureImage image{width, height, std::vector<std::uint8_t>(size_t(width) * size_t(height) * 4)};
  if (WebPDecodeRGBAInto(bytes.data, bytes.size, image.rgba.edit().data(), image.rgba.size(), 4 * width) == nullptr)
    refuse(document.path, fmt::format("{} cannot be decoded", name));
  return image;
}

}  // namespace

TextureImage decode_image(const Document& document, size_t index) {
  const tinygltf::Image& in = document.model.images[index];
  const std::string name = element("image", index, in.name.empty() ? in.uri : in.name);
  const Bytes bytes =
      in.bufferView >= 0 ? view_bytes(document, in.bufferView, name) : Bytes{in.image.data(), in.image.size()};
  int width = 0, height = 0, channels = 0;
  if (is_webp(bytes)) return decode_webp(document, bytes, name);
  const bool known = is_png_or_jpeg(bytes) && bytes.size <= size_t(std::numeric_limits<int>::max()) &&
                     stbi_info_from_memory(bytes.data, int(bytes.size), &width, &height, &channels) != 0;
  if (!known) refuse(document.path, fmt::format("{} is no PNG, JPEG or WebP that can be read", name));
  check_size(document, width, height, bytes, name);
  const std::unique_ptr<stbi_uc, void (*)(void*)> pixels(
      stbi_load_from_memory(bytes.data, int(bytes.size), &width, &height, &channels, 4), stbi_image_free);
  if (!pixels) refuse(document.path, fmt::format("{} cannot be decoded: {}", name, stbi_failure_reason()));
  return {width, height, SharedBytes::Bytes(pixels.get(), pixels.get() + size_t(width) * size_t(height) * 4)};
}

TextureTable::TextureTable(const Document& document, Materials& out)
    : document_(document),
      out_(out),
      texture_of_file_(document.model.textures.size(), -1),
      image_of_file_(document.model.images.size(), -1) {}

int TextureTable::image(int file_image, const std::string& who) {
  check_index(document_, file_image, document_.model.images.size(), who, "image");
  int& known = image_of_file_[size_t(file_image)];
  if (known < 0) {
    out_.images.emplace_back();
    encoded_.push_back(file_image);
    known = int(out_.images.size()) - 1;
  }
  return known;
}

namespace {

/// The image of a texture: WebP where the file has it, else the one that every reader knows; -1: none that is read.
int source_of(const Document& document, const tinygltf::Texture& in, const std::string& name) {
  int source = in.source;
  const auto webp = in.extensions.find("EXT_texture_webp");
  if (webp != in.extensions.end() && webp->second.Has("source")) source = webp->second.Get("source").GetNumberAsInt();
  if (source < 0) {
    repair(document, fmt::format("{}: no image that can be read{}; it counts as white", name,
                                 in.extensions.contains("KHR_texture_basisu") ? " (KTX2 is not)" : ""));
    return -1;
  }
  check_index(document, source, document.model.images.size(), name, "image");
  if (!document.missing_images.contains(source)) return source;
  const tinygltf::Image& image = document.model.images[size_t(source)];
  repair(document, fmt::format("{}: missing file '{}'; the texture counts as white", name, image.name));
  return -1;
}

}  // namespace

int TextureTable::texture(int file_texture, const std::string& who) {
  check_index(document_, file_texture, document_.model.textures.size(), who, "texture");
  int& known = texture_of_file_[size_t(file_texture)];
  if (known < 0) {
    const tinygltf::Texture& in = document_.model.textures[size_t(file_texture)];
    const std::string name = element("texture", size_t(file_texture), in.name);
    const int source = source_of(document_, in, name);
    if (source < 0) return -1;
    const Sampler sampler = read_sampler(document_, in.sampler, name);
    out_.textures.push_back({image(source, name), sampler});
    known = int(out_.textures.size()) - 1;
  }
  return known;
}

TextureUse TextureTable::use(const tinygltf::TextureInfo& info, const std::string& who) {
  TextureUse use;
  if (info.index < 0) return use;
  use.texture = texture(info.index, who);
  if (use.texture < 0) return {};
  use.texcoord = info.texCoord;
  const auto transform = info.extensions.find("KHR_texture_transform");
  if (transform != info.extensions.end() && transform->second.IsObject()) {
    apply_transform(document_, transform->second, use, who);
  }
  if (use.texcoord < 0) refuse(document_.path, fmt::format("{} uses TEXCOORD_{}", who, use.texcoord));
  return use;
}

const TextureImage& TextureTable::image_of(int texture) {
  const auto image = size_t(out_.textures[size_t(texture)].image);
  if (encoded_[image] >= 0) out_.images[image] = decode_image(document_, size_t(std::exchange(encoded_[image], -1)));
  return out_.images[image];
}

void TextureTable::decode() {
  std::vector<std::exception_ptr> refused(out_.images.size());
  Progress progress("textures", out_.images.size());
  tbb::parallel_for(size_t(0), out_.images.size(), [&](size_t i) {
    if (encoded_[i] < 0) return;
    try {
      out_.images[i] = decode_image(document_, size_t(encoded_[i]));
    } catch (...) {
      refused[i] = std::current_exception();
    }
    progress.advance();
  });
  std::fill(encoded_.begin(), encoded_.end(), -1);
  for (const std::exception_ptr& e : refused) {  // the first of the file, whichever came first
    if (e) std::rethrow_exception(e);
  }
}

int TextureTable::add(TextureImage image, int like) {
  out_.images.push_back(std::move(image));
  encoded_.push_back(-1);
  out_.textures.push_back({int(out_.images.size()) - 1, out_.textures[size_t(like)].sampler});
  return int(out_.textures.size()) - 1;
}

}  // namespace volgi::gltf
