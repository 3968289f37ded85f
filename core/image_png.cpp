#include <stb/stb_image.h>
#include <stb/stb_image_write.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>
#include <memory>

#include "core/atomic_file.h"
#include "core/encoded_picture_internal.h"
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
  std::ifstream file(path, std::ios::binary);
  const std::vector<unsigned char> bytes{std::istreambuf_iterator<char>(file), {}};
  constexpr std::array<unsigned char, 8> png{0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
  const bool is_png = bytes.size() <= size_t(std::numeric_limits<int>::max()) && bytes.size() >= png.size() &&
                      std::equal(png.begin(), png.end(), bytes.begin()) && png_chunks_fit(bytes);
  const auto size = int(bytes.size());
  const bool known = is_png && stbi_info_from_memory(bytes.data(), size, &width, &height, &channels) != 0;
  if (!known || width < 1 || height < 1 || width > largest_edge || height > largest_edge ||
      !pixels_fit(std::int64_t(width) * height, bytes.size()))
    throw Error(ExitCode::bad_input, path.string() + ": no PNG that can be read");
  const std::unique_ptr<stbi_uc, void (*)(void*)> texels(
      stbi_load_from_memory(bytes.data(), size, &width, &height, &channels, 3), stbi_image_free);
  if (!texels) throw Error(ExitCode::bad_input, path.string() + ": cannot be decoded");
  Image image(width, height);
  for (size_t i = 0; i < image.pixels.size(); ++i) {
    for (size_t c = 0; c < 3; ++c) image.pixels[i][int(c)] = srgb_decode(float(texels.get()[3 * i + c]) / 255.0f);
  }
  return image;
}

}  // namespace volgi
