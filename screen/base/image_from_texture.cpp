#include "screen/base/image_from_texture.h"

namespace volgi::screen {

Image image_from_texture(const gl::Texture& texture) {
  const std::vector<float> values = texture.download(3);
  Image image(texture.size().x, texture.size().y);
  const float* value = values.data();
  for (int y = image.height - 1; y >= 0; --y) {
    for (int x = 0; x < image.width; ++x, value += 3) image.at(x, y) = {value[0], value[1], value[2]};
  }
  return image;
}

}  // namespace volgi::screen
