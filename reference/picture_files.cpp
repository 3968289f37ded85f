#include "reference/picture_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/error.h"

namespace volgi {
namespace {

namespace fs = std::filesystem;
using AskedLight = PathTracerOptions::Light;

Image difference(const Image& a, const Image& b) {
  Image out = a;
  for (size_t i = 0; i < out.pixels.size(); ++i) out.pixels[i] -= b.pixels[i];
  return out;
}

void require_same_size(const Image& a, const fs::path& path, const Image& b, const fs::path& other) {
  if (a.width == b.width && a.height == b.height) return;
  throw Error(ExitCode::bad_input, fmt::format("{} is {}x{} but {} beside it is {}x{}: they must be of one size",
                                               path.string(), a.width, a.height, other.string(), b.width, b.height));
}

const std::vector<float>& plane(const ChannelImage& image, const fs::path& path, std::string_view channel) {
  const Channel* found = image.find(channel);
  if (found == nullptr) throw Error(ExitCode::bad_input, fmt::format("{} has no channel '{}'", path.string(), channel));
  return found->values;
}

// Which lights reach a pixel, as our files call it or as Blender's do; empty where a file does not say it.
std::vector<float> lit_plane(const ChannelImage& image) {
  for (const char* name : {"lit", "Lit.V"})
    if (const Channel* found = image.find(name)) return found->values;
  return {};
}

Image layer(const ChannelImage& image, const fs::path& path, std::string_view prefix) {
  Image out;
  if (!image.rgb(prefix, out))
    throw Error(ExitCode::bad_input, fmt::format("{} has no layer '{}'", path.string(), prefix));
  return out;
}

std::optional<Image> difference(const std::optional<Image>& a, const std::optional<Image>& b) {
  if (!a || !b) return std::nullopt;
  return difference(*a, *b);
}

// R,G,B and noise of the requested light, from those of the picture and of its direct light.
struct ColorAndNoise {
  Image color;
  std::optional<Image> noise;
};
ColorAndNoise select(AskedLight light, ColorAndNoise picture, ColorAndNoise direct) {
  if (light == AskedLight::full) return picture;
  if (light == AskedLight::direct) return direct;
  return {difference(picture.color, direct.color), difference(picture.noise, direct.noise)};
}

bool is_own_reference(const ChannelImage& image) {
  return image.find("position.X") != nullptr && image.find("noise.R") != nullptr;
}

ReferenceFile from_own(const ChannelImage& image, const fs::path& path, AskedLight light) {
  const bool without_direct = image.find("left_out.direct.R") != nullptr;
  ColorAndNoise picture{layer(image, path, ""), layer(image, path, "noise.")};
  ColorAndNoise direct{layer(image, path, without_direct ? "left_out.direct." : "direct."),
                       layer(image, path, "direct_noise.")};
  RegionLayers layers{layer(image, path, "position."), layer(image, path, "normal."), direct.color,
                      plane(image, path, "id"),        plane(image, path, "depth"),   lit_plane(image),
                      direct.noise.value_or(Image())};
  if (without_direct && light == AskedLight::indirect) light = AskedLight::full;
  ColorAndNoise selected = select(light, std::move(picture), std::move(direct));
  return {std::move(selected.color), std::move(selected.noise), std::move(layers)};
}

ColorAndNoise read_with_noise(const fs::path& path) {
  ColorAndNoise out{read_exr_rgb(path), std::nullopt};
  const fs::path noise = path.parent_path() / (path.stem().string() + "_noise.exr");
  if (!fs::exists(noise)) return out;
  out.noise = read_exr_rgb(noise);
  require_same_size(*out.noise, noise, out.color, path);
  return out;
}

std::optional<RegionLayers> blender_layers(const fs::path& path, const ColorAndNoise& direct) {
  const fs::path aov_path = path.parent_path() / "aov.exr";
  if (!fs::exists(aov_path)) return std::nullopt;
  const ChannelImage aov = read_exr(aov_path);
  RegionLayers layers{layer(aov, aov_path, "Position."), layer(aov, aov_path, "Normal."), direct.color,
                      plane(aov, aov_path, "IndexOB.X"), plane(aov, aov_path, "Depth.Z"), lit_plane(aov),
                      direct.noise.value_or(Image())};
  require_same_size(layers.position, aov_path, direct.color, path);
  if (!layers.lit.empty() && !direct.noise)
    throw Error(ExitCode::bad_input,
                fmt::format("{} has Lit.V, which goes with {}, and there is no such file", aov_path.string(),
                            (path.parent_path() / "direct_noise.exr").string()));
  return layers;
}

ReferenceFile from_folder(const fs::path& path, AskedLight light) {
  const fs::path direct_path = path.parent_path() / "direct.exr";
  ColorAndNoise picture = read_with_noise(path);
  if (!fs::exists(direct_path)) {
    if (light == AskedLight::full) return {std::move(picture.color), std::move(picture.noise), std::nullopt};
    throw Error(ExitCode::bad_input, fmt::format("{} has no direct layer, and there is no {}: compare --light full",
                                                 path.string(), direct_path.string()));
  }
  ColorAndNoise direct = read_with_noise(direct_path);
  require_same_size(direct.color, direct_path, picture.color, path);
  std::optional<RegionLayers> layers = blender_layers(path, direct);
  ColorAndNoise selected = select(light, std::move(picture), std::move(direct));
  return {std::move(selected.color), std::move(selected.noise), std::move(layers)};
}

void require_finite(const Image& image, const fs::path& path, std::string_view whose) {
  const auto finite = [](glm::vec3 c) { return std::isfinite(c.x) && std::isfinite(c.y) && std::isfinite(c.z); };
  const auto bad = std::count_if(image.pixels.begin(), image.pixels.end(), [&](glm::vec3 c) { return !finite(c); });
  if (bad == 0) return;
  throw Error(ExitCode::bad_input, fmt::format("{}: {} pixels of {} are NaN or infinite", path.string(), bad, whose));
}

}  // namespace

namespace {

bool is_png(const fs::path& path) { return path.extension() == ".png" || path.extension() == ".PNG"; }

Image cropped(const Image& image, glm::ivec2 from, glm::ivec2 size) {
  Image out(size.x, size.y);
  for (int y = 0; y < size.y; ++y) {
    for (int x = 0; x < size.x; ++x) out.at(x, y) = image.at(from.x + x, from.y + y);
  }
  return out;
}

void crop(std::vector<float>& plane, int width, glm::ivec2 from, glm::ivec2 size) {
  if (plane.empty()) return;
  std::vector<float> out;
  out.reserve(size_t(size.x) * size_t(size.y));
  for (int y = 0; y < size.y; ++y) {
    const auto row = plane.begin() + (std::ptrdiff_t(from.y + y) * width + from.x);
    out.insert(out.end(), row, row + size.x);
  }
  plane = std::move(out);
}

void crop(ReferenceFile& file, glm::ivec2 from, glm::ivec2 size) {
  const int width = file.color.width;
  if (file.layers) {
    RegionLayers& l = *file.layers;
    for (Image* image : {&l.position, &l.normal, &l.direct, &l.direct_noise}) {
      if (!image->pixels.empty()) *image = cropped(*image, from, size);
    }
    for (std::vector<float>* plane : {&l.id, &l.depth, &l.lit}) crop(*plane, width, from, size);
  }
  if (file.noise) file.noise = cropped(*file.noise, from, size);
  file.color = cropped(file.color, from, size);
}

}  // namespace

void crop_to_common(ReferenceFile& reference, TestPicture& test) {
  const Image &a = reference.color, &b = test.color;
  if (reference.origin == test.origin) return;
  const glm::ivec2 low = glm::max(reference.origin, test.origin);
  const glm::ivec2 high =
      glm::min(reference.origin + glm::ivec2(a.width, a.height), test.origin + glm::ivec2(b.width, b.height));
  const glm::ivec2 size = high - low;
  if (size.x < 1 || size.y < 1) {
    throw Error(
        ExitCode::bad_input,
        fmt::format("the picture shows {}x{} pixels from {},{} on and the reference {}x{} from {},{} on: none in "
                    "common",
                    b.width, b.height, test.origin.x, test.origin.y, a.width, a.height, reference.origin.x,
                    reference.origin.y));
  }
  crop(reference, low - reference.origin, size);
  test.color = cropped(test.color, low - test.origin, size);
  reference.origin = test.origin = low;
}

ReferenceFile read_reference(const fs::path& path, AskedLight light) {
  if (is_png(path)) {
    if (light != AskedLight::full)
      throw Error(ExitCode::bad_input, path.string() + ": a PNG has all light in one: compare --light full");
    ReferenceFile reference{read_png(path), std::nullopt, std::nullopt};
    reference.for_screen = true;
    return reference;
  }
  const ChannelImage image = read_exr(path);
  ReferenceFile reference = is_own_reference(image) ? from_own(image, path, light) : from_folder(path, light);
  reference.origin = image.origin;
  require_finite(reference.color, path, "the reference");  // no figure would mean anything, and no limit would be over
  if (reference.noise) require_finite(*reference.noise, path, "the reference's noise");
  return reference;
}

TestPicture read_test(const fs::path& path, AskedLight light) {
  if (is_png(path)) return {read_png(path), glm::ivec2(0), true};
  const ChannelImage image = read_exr(path);
  TestPicture test{colors_of(image, path), image.origin};
  Image direct;
  if (light == AskedLight::full) return test;
  if (light == AskedLight::direct && image.rgb("left_out.direct.", direct)) {
    test.color = std::move(direct);
  } else if (image.rgb("direct.", direct)) {
    test.color = light == AskedLight::direct ? direct : difference(test.color, direct);
  }
  return test;
}

}  // namespace volgi
