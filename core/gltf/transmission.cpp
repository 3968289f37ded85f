#include <fmt/format.h>

#include <algorithm>

#include "core/gltf/gltf_internal.h"
#include "core/image.h"

namespace volgi::gltf {
namespace {

constexpr const char* EXTENSION = "KHR_materials_transmission";

float luminance(glm::vec3 c) { return glm::dot(c, glm::vec3(0.2126f, 0.7152f, 0.0722f)); }

/// AlphaMode::glass of one colour: that of the base, and the share that passes.
glm::vec4 glass_of(float coverage, float passes, glm::vec3 base) {
  if (coverage >= 1.0f) return {base, passes};
  // What is not covered passes without colour: a paler glass that reflects as much, and passes it in the mean.
  const glm::vec3 uncovered(1.0f - coverage);
  const glm::vec3 both = uncovered + coverage * base, through = uncovered + coverage * passes * base;
  return {both, luminance(through) / std::max(luminance(both), 1e-6f)};
}

/// Texel of RGBA at the place of another image's texel.
const std::uint8_t* texel_at(const TextureImage& image, int x, int y, const TextureImage& like) {
  const auto column = std::int64_t(x) * image.width / like.width, row = std::int64_t(y) * image.height / like.height;
  return &image.rgba[4 * size_t(row * image.width + column)];
}

/// Of a channel, where a texture may lie otherwise than the base colour's.
float mean_of(const TextureImage& image, size_t channel) {
  double sum = 0.0;
  for (size_t i = channel; i < image.rgba.size(); i += 4) sum += image.rgba[i];
  return float(sum / (255.0 * double(image.rgba.size()) / 4.0));
}

bool lie_alike(const TextureUse& a, const TextureUse& b) {
  return a.texcoord == b.texcoord && a.uv_from_texcoord == b.uv_from_texcoord;
}

/// glass_of() texel by texel, times the base colour's factor where that cannot stay one: `base` may be null (white),
/// `passes_texture`, too (1).
TextureImage glass_image(const TextureImage* base, const TextureImage* passes_texture, const Material& material,
                         float passes) {
  const TextureImage& like = base != nullptr ? *base : *passes_texture;
  TextureImage glass{like.width, like.height, std::vector<std::uint8_t>(like.rgba.size())};
  const auto byte = [](float v) { return std::uint8_t(std::clamp(v * 255.0f + 0.5f, 0.0f, 255.0f)); };
  std::vector<std::uint8_t>& texels = glass.rgba.edit();
  constexpr std::uint8_t white[4] = {255, 255, 255, 255};
  const bool blended = material.alpha_mode == AlphaMode::blend;
  for (int y = 0; y < like.height; ++y) {
    for (int x = 0; x < like.width; ++x) {
      const std::uint8_t* in = base != nullptr ? texel_at(*base, x, y, like) : white;
      const float red = passes_texture != nullptr ? float(*texel_at(*passes_texture, x, y, like)) / 255.0f : 1.0f;
      glm::vec3 color;
      for (int c = 0; c < 3; ++c) color[c] = srgb_decode(float(in[c]) / 255.0f);
      const float coverage = blended ? material.base_color_factor.a * float(in[3]) / 255.0f : 1.0f;
      if (blended) color *= glm::vec3(material.base_color_factor);
      const glm::vec4 mixed = glass_of(coverage, passes * red, color);
      std::uint8_t* out = &texels[4 * (size_t(y) * size_t(like.width) + size_t(x))];
      for (int c = 0; c < 3; ++c) out[c] = byte(srgb_encode(mixed[c]));
      out[3] = byte(mixed.a);
    }
  }
  return glass;
}

/// transmissionTexture, if the extension has one that is an object with an index.
TextureUse transmission_texture(const tinygltf::Value& extension, const std::string& who, TextureTable& textures) {
  if (!extension.Has("transmissionTexture")) return {};
  const tinygltf::Value& value = extension.Get("transmissionTexture");
  tinygltf::TextureInfo info;
  if (value.IsObject() && value.Get("index").IsInt()) info.index = value.Get("index").GetNumberAsInt();
  if (value.IsObject() && value.Get("texCoord").IsInt()) info.texCoord = value.Get("texCoord").GetNumberAsInt();
  if (value.IsObject() && value.Get("extensions").Has("KHR_texture_transform"))
    info.extensions["KHR_texture_transform"] = value.Get("extensions").Get("KHR_texture_transform");
  return textures.use(info, who + " transmissionTexture");
}

}  // namespace

void apply_transmission(const Document& document, const tinygltf::Material& in, const std::string& who,
                        TextureTable& textures, Material& material) {
  const auto extension = in.extensions.find(EXTENSION);
  if (extension == in.extensions.end() || !extension->second.Has("transmissionFactor")) return;
  const tinygltf::Value& factor = extension->second.Get("transmissionFactor");
  const double given = factor.IsNumber() ? factor.GetNumberAsDouble() : -1.0;
  if (!(given >= 0.0 && given <= 1.0))
    refuse(document.path, fmt::format("{}: its transmissionFactor is not a number of 0 ... 1", who));
  constexpr size_t red = 0, blue = 2;
  const int metal = material.metallic.texture;
  const float metallic = material.metallic_factor * (metal < 0 ? 1.0f : mean_of(textures.image_of(metal), blue));
  float passes = float(given) * (1.0f - metallic);  // no light passes a metal
  if (passes == 0.0f || material.alpha_mode == AlphaMode::mask) return;

  TextureUse tells = transmission_texture(extension->second, who, textures);
  const bool base_textured = material.base_color.texture >= 0;
  if (tells.texture >= 0 && base_textured && !lie_alike(tells, material.base_color)) {
    warn(document.path, "a transmission texture that lies otherwise than the base colour's counts with its mean");
    passes *= mean_of(textures.image_of(tells.texture), red);
    tells = {};
  }
  if (tells.texture < 0 && !base_textured) {
    const float coverage = material.alpha_mode == AlphaMode::opaque ? 1.0f : material.base_color_factor.a;
    material.base_color_factor = glass_of(coverage, passes, glm::vec3(material.base_color_factor));
  } else {
    const TextureUse& like = base_textured ? material.base_color : tells;
    const TextureImage* base = base_textured ? &textures.image_of(material.base_color.texture) : nullptr;
    const TextureImage* passing = tells.texture >= 0 ? &textures.image_of(tells.texture) : nullptr;
    TextureUse glass = like;
    glass.texture = textures.add(glass_image(base, passing, material, passes), like.texture);
    material.base_color = glass;
    material.base_color_factor = material.alpha_mode == AlphaMode::blend
                                     ? glm::vec4(1.0f)
                                     : glm::vec4(glm::vec3(material.base_color_factor), 1.0f);
  }
  material.alpha_mode = AlphaMode::glass;
}

}  // namespace volgi::gltf
