#include <stb/stb_image_write.h>

#include <cmath>
#include <fstream>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/image.h"

namespace volgi {
namespace {

std::uint8_t to_byte(float display) {
  if (!(display > 0.0f)) return 0;  // NaN as well
  return std::uint8_t(std::lround(std::min(display, 1.0f) * 255.0f));
}

void append_to_stream(void* stream, void* data, int size) {
  static_cast<std::ofstream*>(stream)->write(static_cast<const char*>(data), size);
}

template <typename ToDisplay>
void write_png_as(const std::filesystem::path& path, const Image& image, ToDisplay to_display) {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(image.pixels.size() * 3);
  for (const glm::vec3& pixel : image.pixels) {
    const glm::vec3 display = to_display(pixel);
    for (int c = 0; c < 3; ++c) bytes.push_back(to_byte(display[c]));
  }
  write_atomically(path, [&](const std::filesystem::path& temporary) {
    std::ofstream stream(temporary, std::ios::binary);
    const int encoded =
        stbi_write_png_to_func(append_to_stream, &stream, image.width, image.height, 3, bytes.data(), 3 * image.width);
    stream.close();
    if (encoded == 0 || !stream) throw Error(ExitCode::cannot_write, "cannot write " + path.string());
  });
}

}  // namespace

void write_png(const std::filesystem::path& path, const Image& image, float exposure_ev) {
  const float scale = std::exp2(exposure_ev);
  write_png_as(path, image, [scale](glm::vec3 linear) {
    const glm::vec3 display = tone_map(linear * scale);
    return glm::vec3(srgb_encode(display.x), srgb_encode(display.y), srgb_encode(display.z));
  });
}

void write_png_display(const std::filesystem::path& path, const Image& display) {
  write_png_as(path, display, [](glm::vec3 value) { return value; });
}

}  // namespace volgi
