#pragma once
// A picture in display values to draw into and to look at, and textures of given texels.
#include <array>
#include <cmath>
#include <glm/glm.hpp>
#include <vector>

#include "core/gl/objects.h"

namespace volgi::test {

/// RGBA, row 0 at the bottom.
inline std::vector<glm::vec4> texels_of(const gl::Texture& texture) {
  const std::vector<float> values = texture.download(4);
  std::vector<glm::vec4> texels;
  for (size_t i = 0; i < values.size(); i += 4)
    texels.emplace_back(values[i], values[i + 1], values[i + 2], values[i + 3]);
  return texels;
}

/// RGBA8.
struct DisplayTarget {
  gl::Texture picture;
  gl::Framebuffer framebuffer;

  explicit DisplayTarget(glm::ivec2 size) : picture(gl::Texture::make_2d(GL_RGBA8, size.x, size.y)) {
    const std::array colors{gl::Framebuffer::Attachment{&picture}};
    framebuffer = gl::Framebuffer(colors, {}, size);
    picture.clear({0.0f, 0.0f, 0.0f, 1.0f});
  }
  std::vector<glm::vec4> texels() const { return texels_of(picture); }
};

/// @param texels  row by row.
inline gl::Texture rgba_texture(GLenum format, glm::ivec2 size, const std::vector<glm::vec4>& texels) {
  gl::Texture texture = gl::Texture::make_2d(format, size.x, size.y);
  glTextureSubImage2D(texture.id(), 0, 0, 0, size.x, size.y, GL_RGBA, GL_FLOAT, texels.data());
  return texture;
}

}  // namespace volgi::test
