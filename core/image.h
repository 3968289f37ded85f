#pragma once
#include <filesystem>
#include <glm/glm.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace volgi {

/// Linear RGB, row 0 at the top, scene-referred.
struct Image {
  int width = 0;
  int height = 0;
  std::vector<glm::vec3> pixels;  // width * height, x fastest

  Image() = default;
  Image(int w, int h, glm::vec3 fill = glm::vec3(0.0f)) : width(w), height(h), pixels(size_t(w) * size_t(h), fill) {}
  glm::vec3& at(int x, int y) { return pixels[size_t(y) * size_t(width) + size_t(x)]; }
  const glm::vec3& at(int x, int y) const { return pixels[size_t(y) * size_t(width) + size_t(x)]; }
};

/// One named float plane of an EXR file ("R", "direct.G", "position.X" ...).
struct Channel {
  std::string name;
  std::vector<float> values;  // width * height
};

/// All channels of an EXR file; of several parts those of the first one's size, the others' channels named
/// PART.CHANNEL.
struct ChannelImage {
  int width = 0;
  int height = 0;
  std::vector<Channel> channels;
  glm::ivec2 origin{0};  // of the upper left pixel on the picture (data window against display window)

  const Channel* find(std::string_view name) const;
  /// Three channels PREFIX + "R","G","B" (or "X","Y","Z"), e.g. prefix "" or "direct." or "noise.".
  /// @returns false (and leaves `out` alone) when one is missing.
  bool rgb(std::string_view prefix, Image& out) const;
  void add_rgb(std::string_view prefix, const Image& image);  // PREFIX.R, .G, .B
  void add_xyz(std::string_view prefix, const Image& image);  // PREFIX.X, .Y, .Z
};

/// @throws Error(bad_input) with the path when the file is missing or not an EXR.
ChannelImage read_exr(const std::filesystem::path& path);
/// Colour of an EXR: R,G,B, or a layer that ends in "Combined.R" etc. (Blender's multilayer files).
Image read_exr_rgb(const std::filesystem::path& path);
Image colors_of(const ChannelImage& channels, const std::filesystem::path& path);  // as read_exr_rgb()

/// A PNG's colours in linear light, as if its bytes were sRGB's. @throws Error(bad_input) naming the file.
Image read_png(const std::filesystem::path& path);

/// Writes float channels, or half with `half`, ZIP compressed, atomically.
/// @throws Error(over_limit) when `half` and a finite value exceeds half's range (65504); Error(cannot_write).
void write_exr(const std::filesystem::path& path, const ChannelImage& image, bool half = false);
void write_exr(const std::filesystem::path& path, const Image& image, bool half = false);

/// 8-bit sRGB PNG of `image · 2^exposure_ev` through tone_map(), atomically.
void write_png(const std::filesystem::path& path, const Image& image, float exposure_ev = 0.0f);
/// 8-bit PNG of display values in [0,1], written as they are (error maps, slices).
void write_png_display(const std::filesystem::path& path, const Image& display);

/// Khronos PBR Neutral: identity (less a Fresnel offset of at most 0.04) up to 0.8 - 0.04, then a smooth shoulder that
/// desaturates towards white. Linear in, linear display out in [0,1]. Source: KhronosGroup/ToneMapping specification.
glm::vec3 tone_map(glm::vec3 linear);
float srgb_encode(float linear);
float srgb_decode(float encoded);

}  // namespace volgi
