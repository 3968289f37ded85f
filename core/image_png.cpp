#include <stb/stb_image.h>
#include <stb/stb_image_write.h>

#include <array>
#include <cmath>
#include <fstream>
#include <memory>

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

Image read_png(const std::filesystem::path& path) {
  constexpr int largest_edge = 32768;
  int width = 0, height = 0, channels = 0;
  std::array<unsigned char, 8> head{};
  std::ifstream(path, std::ios::binary).read(reinterpret_cast<char*>(head.data()), head.size());
  constexpr std::array<unsigned char, 8> png{0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
  const bool known = head == png && stbi_info(path.c_str(), &width, &height, &channels) != 0;
  if (!known || width < 1 || height < 1 || width > largest_edge || height > largest_edge)
    throw Error(ExitCode::bad_input, path.string() + ": no PNG that can be read");
  const std::unique_ptr<stbi_uc, void (*)(void*)> bytes(stbi_load(path.c_str(), &width, &height, &channels, 3),
                                                        stbi_image_free);
  if (!bytes) throw Error(ExitCode::bad_input, path.string() + ": cannot be decoded");
  Image image(width, height);
  for (size_t i = 0; i < image.pixels.size(); ++i) {
    for (size_t c = 0; c < 3; ++c) image.pixels[i][int(c)] = srgb_decode(float(bytes.get()[3 * i + c]) / 255.0f);
  }
  return image;
}

}  // namespace volgi
