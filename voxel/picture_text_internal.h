#pragma once
#include <string>

#include "core/image.h"

namespace volgi {

inline constexpr int kTextScale = 2;
inline constexpr int kLineHeight = 12 * kTextScale;  // stb_easy_font's line is 12 high
inline constexpr glm::vec3 kText(0.9f);

/// Clipped to the picture.
void fill(Image& image, int x0, int y0, int width, int height, glm::vec3 color);
/// In one line; what is not ASCII becomes '?', what is long is cut.
void draw_text(Image& image, int left, int top, const std::string& text);
int text_width(const std::string& text);

}  // namespace volgi
