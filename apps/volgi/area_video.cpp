#include "apps/volgi/area_video.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <cmath>
#include <set>

#include "apps/volgi/frame_times.h"
#include "core/error.h"
#include "core/image.h"

namespace volgi::app {

namespace {

TextureImage texture_of(const std::filesystem::path& file) {
  const Image image = read_png(file);
  TextureImage texture{image.width, image.height, SharedBytes::Bytes(image.pixels.size() * 4, 255)};
  SharedBytes::Bytes& bytes = texture.rgba.edit();
  for (size_t i = 0; i < image.pixels.size(); ++i) {
    for (size_t c = 0; c < 3; ++c)
      bytes[4 * i + c] = std::uint8_t(std::lround(255.0f * srgb_encode(image.pixels[i][int(c)])));
  }
  return texture;
}

std::set<int> emissive_images(const Scene& scene) {
  std::set<int> images;
  for (const Material& m : scene.materials) {
    if (m.is_emissive() && m.emissive.texture >= 0) images.insert(scene.textures[size_t(m.emissive.texture)].image);
  }
  return images;
}

}  // namespace

void AreaVideo::add_to(CLI::App& command) {
  command
      .add_option("--area-video", files_,
                  "PNGs that play, over and over, on every emissive surface that has a texture: all of a folder, by "
                  "name, or those of a name with %d or %04d, from 0 or 1 on")
      ->type_name("DIR|%04d.png");
  command.add_option("--area-fps", frames_per_s_, "pictures of --area-video a second")
      ->check(CLI::Range(1e-3, 1e6))
      ->capture_default_str();
}

std::vector<std::filesystem::path> AreaVideo::list_files() const {
  namespace fs = std::filesystem;
  std::vector<fs::path> list;
  if (fs::is_directory(files_)) {
    for (const fs::directory_entry& entry : fs::directory_iterator(files_)) {
      if (entry.path().extension() == ".png") list.push_back(entry.path());
    }
    std::sort(list.begin(), list.end());
  } else if (files_.find('%') != std::string::npos) {
    for (int k = fs::exists(frame_path(files_, 0)) ? 0 : 1; fs::exists(frame_path(files_, k)); ++k)
      list.push_back(frame_path(files_, k));
  } else if (fs::exists(files_)) {
    list.emplace_back(files_);
  }
  if (list.empty()) throw Error(ExitCode::usage, fmt::format("--area-video {}: there is no such PNG", files_));
  return list;
}

double AreaVideo::duration_s() {
  if (!plays()) return 0.0;
  if (list_.empty()) list_ = list_files();
  return double(list_.size()) / frames_per_s_;
}

std::vector<std::string> AreaVideo::arguments() const {
  if (!plays()) return {};
  return {"--area-video", files_, "--area-fps", fmt::format("{}", frames_per_s_)};
}

bool AreaVideo::show(Scene& scene, double time_s) {
  if (files_.empty()) return false;
  if (list_.empty()) list_ = list_files();
  const auto count = std::int64_t(list_.size());
  const auto at = std::int64_t(std::floor(time_s * frames_per_s_ + 1e-6));
  const auto k = size_t((at % count + count) % count);
  if (k == shown_) return false;
  const std::set<int> images = emissive_images(scene);
  if (images.empty())
    throw Error(ExitCode::usage, fmt::format("--area-video: no emissive surface of {} has a texture", scene.name));
  const TextureImage texture = texture_of(list_[k]);
  for (const int i : images) scene.images[size_t(i)] = texture;
  shown_ = k;
  return true;
}

}  // namespace volgi::app
