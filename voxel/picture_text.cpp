#include <stb/stb_easy_font.h>

#include <algorithm>
#include <vector>

#include "voxel/picture_text_internal.h"

namespace volgi {
namespace {

// stb_easy_font's characters are ASCII from space to ~; a file can name a grid as it likes.
std::string drawable(std::string text) {
  constexpr size_t longest = 96;
  if (text.size() > longest) text.replace(longest - 3, std::string::npos, "...");
  for (char& c : text)
    if (c < ' ' || c > '~') c = '?';
  return text;
}

}  // namespace

int text_width(const std::string& text) { return kTextScale * stb_easy_font_width(drawable(text).data()); }

void fill(Image& image, int x0, int y0, int width, int height, glm::vec3 color) {
  for (int y = std::max(y0, 0); y < std::min(y0 + height, image.height); ++y)
    for (int x = std::max(x0, 0); x < std::min(x0 + width, image.width); ++x) image.at(x, y) = color;
}

void draw_text(Image& image, int left, int top, const std::string& text) {
  struct Vertex {
    float x, y, z;
    unsigned char color[4];
  };
  std::string copy = drawable(text);
  std::vector<Vertex> vertices(copy.size() * 4 * 16);  // no character has more than 16 strokes
  const int quads =
      stb_easy_font_print(0.0f, 0.0f, copy.data(), nullptr, vertices.data(), int(vertices.size() * sizeof(Vertex)));
  for (int q = 0; q < quads; ++q) {
    const Vertex &a = vertices[4 * size_t(q)], &c = vertices[4 * size_t(q) + 2];
    fill(image, left + kTextScale * int(a.x), top + kTextScale * int(a.y), kTextScale * int(c.x - a.x),
         kTextScale * int(c.y - a.y), kText);
  }
}

}  // namespace volgi
