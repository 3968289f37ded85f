#include "reference/error_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "shaders/shared/color_maps.shared.h"

namespace volgi {
namespace {

constexpr float kSaturation = 0.5f;  // relative error of full red and full blue
constexpr float kOutside = 0.35f;
constexpr int kGlyphWidth = 5, kGlyphHeight = 7;
constexpr int kLegendHeight = 32;
constexpr glm::vec3 kNotFinite(1.0f, 0.0f, 1.0f);

struct Glyph {
  char character;
  std::array<unsigned char, kGlyphHeight> rows;  // 5 bits, left is the highest
};
constexpr std::array kFont{
    Glyph{'0', {14, 17, 19, 21, 25, 17, 14}}, Glyph{'5', {31, 16, 30, 1, 1, 17, 14}},
    Glyph{'+', {0, 4, 4, 31, 4, 4, 0}},       Glyph{'-', {0, 0, 0, 31, 0, 0, 0}},
    Glyph{'%', {24, 25, 2, 4, 8, 19, 3}},     Glyph{'a', {0, 0, 14, 1, 15, 17, 15}},
    Glyph{'b', {16, 16, 30, 17, 17, 17, 30}}, Glyph{'d', {1, 1, 15, 17, 17, 17, 15}},
    Glyph{'g', {0, 15, 17, 17, 15, 1, 14}},   Glyph{'h', {16, 16, 30, 17, 17, 17, 17}},
    Glyph{'i', {4, 0, 12, 4, 4, 4, 14}},      Glyph{'k', {16, 16, 18, 20, 24, 20, 18}},
    Glyph{'r', {0, 0, 22, 25, 16, 16, 16}},   Glyph{'t', {8, 8, 28, 8, 8, 9, 6}},
};

glm::vec3 error_color(float relative) { return shared::difference_color(relative / kSaturation); }

void draw_text(Image& image, int x, int y, std::string_view text) {
  for (const char character : text) {
    const auto* glyph =
        std::find_if(kFont.begin(), kFont.end(), [&](const Glyph& g) { return g.character == character; });
    if (glyph != kFont.end())
      for (int row = 0; row < kGlyphHeight; ++row)
        for (int column = 0; column < kGlyphWidth; ++column)
          if ((glyph->rows[static_cast<size_t>(row)] >> (kGlyphWidth - 1 - column) & 1) != 0)
            image.at(x + column, y + row) = glm::vec3(1.0f);
    x += kGlyphWidth + 1;
  }
}

int text_width(std::string_view text) { return static_cast<int>(text.size()) * (kGlyphWidth + 1); }

}  // namespace

Image error_colors(const Image& ref, const Image& test, const Mask& mask) {
  double sum = 0;
  for (const glm::vec3& r : ref.pixels) sum += static_cast<double>(r.x + r.y + r.z) / 3;
  const float floor = std::max(0.1f * static_cast<float>(sum / static_cast<double>(ref.pixels.size())), 1e-9f);
  Image out(ref.width, ref.height);
  for (size_t i = 0; i < ref.pixels.size(); ++i) {
    const glm::vec3 r = ref.pixels[i], t = test.pixels[i];
    const float base = (r.x + r.y + r.z) / 3, relative = ((t.x + t.y + t.z) / 3 - base) / (base + floor);
    out.pixels[i] = std::isfinite(relative) ? error_color(relative) * (mask[i] != 0 ? 1.0f : kOutside) : kNotFinite;
  }
  return out;
}

Image error_scale(int width) {
  constexpr int margin = 8, bar_top = 4, bar_height = 10, text_top = bar_top + 14;
  Image out(width, kLegendHeight);
  const int left = margin, right = width - margin;
  for (int x = left; x < right; ++x) {
    const float at = (static_cast<float>(x - left) + 0.5f) / static_cast<float>(right - left);
    for (int y = bar_top; y < bar_top + bar_height; ++y) out.at(x, y) = error_color((2.0f * at - 1.0f) * kSaturation);
  }
  constexpr std::string_view dark = "-50% dark", bright = "bright +50%";
  draw_text(out, left, text_top, dark);
  draw_text(out, (left + right) / 2 - kGlyphWidth / 2, text_top, "0");
  draw_text(out, right - text_width(bright), text_top, bright);
  return out;
}

Image error_map(const Image& ref, const Image& test, const Mask& mask) {
  const Image colors = error_colors(ref, test, mask);
  const int scale = (256 + std::min(ref.width, ref.height) - 1) / std::min(ref.width, ref.height);
  Image out(ref.width * scale, ref.height * scale + kLegendHeight);
  for (int y = 0; y < ref.height * scale; ++y)
    for (int x = 0; x < out.width; ++x) out.at(x, y) = colors.at(x / scale, y / scale);
  const Image legend = error_scale(out.width);
  std::copy(legend.pixels.begin(), legend.pixels.end(), out.pixels.end() - std::ptrdiff_t(legend.pixels.size()));
  return out;
}

}  // namespace volgi
