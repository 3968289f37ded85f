// EXT_lights_image_based: a sky of six pictures, and what it lights surfaces with.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "core/gltf/gltf_internal.h"
#include "core/image.h"
#include "core/sky.h"

namespace volgi::gltf {
namespace {

constexpr const char* EXTENSION = "EXT_lights_image_based";
constexpr int COEFFICIENTS = 9, FACES = 6, SMALLEST_HEIGHT = 64, LARGEST_HEIGHT = 512;
constexpr double kPi = glm::pi<double>();

using Sh = std::array<glm::dvec3, COEFFICIENTS>;

/// Y_lm in the order of docs/conventions.md#spherical-harmonics, which is the extension's.
std::array<double, COEFFICIENTS> sh_at(const glm::dvec3& d) {
  const double a = 0.5 / std::sqrt(kPi), b = std::sqrt(3.0) * a, c = std::sqrt(15.0) * a;
  return {a,
          b * d.y,
          b * d.z,
          b * d.x,
          c * d.x * d.y,
          c * d.y * d.z,
          std::sqrt(5.0) * a * (1.5 * d.z * d.z - 0.5),
          c * d.x * d.z,
          0.5 * c * (d.x * d.x - d.y * d.y)};
}

/// Irradiance of radiance, band by band.
double cosine_lobe(int i) { return i == 0 ? kPi : i < 4 ? 2.0 * kPi / 3.0 : 0.25 * kPi; }

struct Face {
  int side = 0;
  std::vector<glm::vec3> radiance;
};

/// Where a direction falls in which of the six pictures, in [0, 1]² from the upper left corner: as OpenGL has it.
int face_of(const glm::dvec3& d, glm::dvec2& at) {
  const glm::dvec3 a = glm::abs(d);
  int axis = 2;
  if (a.x >= a.y && a.x >= a.z)
    axis = 0;
  else if (a.y >= a.z)
    axis = 1;
  const double sign = d[axis] < 0.0 ? -1.0 : 1.0;
  const std::array<glm::dvec2, 3> across{glm::dvec2{-sign * d.z, -d.y}, {d.x, sign * d.z}, {sign * d.x, -d.y}};
  at = 0.5 * across[size_t(axis)] / a[axis] + 0.5;
  return 2 * axis + (sign < 0.0 ? 1 : 0);
}

glm::vec3 bilinear(const Face& face, glm::dvec2 at) {
  const glm::dvec2 texel = glm::clamp(at * double(face.side) - 0.5, 0.0, double(face.side - 1));
  const glm::ivec2 low(texel), high = glm::min(low + 1, face.side - 1);
  const glm::vec2 t = glm::vec2(texel - glm::dvec2(low));
  const auto value = [&](int x, int y) { return face.radiance[size_t(y) * size_t(face.side) + size_t(x)]; };
  return glm::mix(glm::mix(value(low.x, low.y), value(high.x, low.y), t.x),
                  glm::mix(value(low.x, high.y), value(high.x, high.y), t.x), t.y);
}

/// Calls visit(x, y, direction, solid angle) for every texel of a latitude-longitude picture.
template <class Visit>
void for_each_texel(const Image& image, const Visit& visit) {
  for (int y = 0; y < image.height; ++y) {
    const double polar = kPi * (y + 0.5) / image.height;
    const double solid_angle =
        2.0 * kPi / image.width * (std::cos(kPi * y / image.height) - std::cos(kPi * (y + 1) / image.height));
    for (int x = 0; x < image.width; ++x) {
      const double azimuth = 2.0 * kPi * ((x + 0.5) / image.width - 0.5);
      visit(x, y,
            glm::dvec3(std::sin(polar) * std::sin(azimuth), std::cos(polar), -std::sin(polar) * std::cos(azimuth)),
            solid_angle);
    }
  }
}

Sh projected(const Image& image, const glm::dmat3& light_from_world) {
  Sh sh{};
  for_each_texel(image, [&](int x, int y, const glm::dvec3& d, double solid_angle) {
    const auto basis = sh_at(light_from_world * d);
    for (size_t i = 0; i < sh.size(); ++i) sh[i] += solid_angle * basis[i] * glm::dvec3(image.at(x, y));
  });
  return sh;
}

class ImageLight {
 public:
  ImageLight(const Document& document, size_t index, const tinygltf::Value& light)
      : document_(document), light_(light), who_(fmt::format("image-based light {}", index)) {
    intensity_ = number("intensity", 1.0);
    if (!(intensity_ >= 0.0 && std::isfinite(intensity_))) refuse(fmt::format("intensity is {}", intensity_));
    world_from_light_ = rotation();
    radiance_ = coefficients();
  }

  std::shared_ptr<const Sky> sky() const {
    const std::vector<Face> faces = pictures();
    const int side = faces.empty() ? 0 : faces.front().side;
    const int height = std::clamp(2 * side, SMALLEST_HEIGHT, LARGEST_HEIGHT);
    Image image(2 * height, height);
    if (!faces.empty()) lay_out(faces, image);
    as_bright_as_told(image, !faces.empty());
    for (glm::vec3& p : image.pixels) p *= float(intensity_);
    return std::make_shared<Sky>(std::move(image), 0.0f, "the file's image-based light");
  }

 private:
  [[noreturn]] void refuse(std::string_view what) const {
    gltf::refuse(document_.path, fmt::format("{} ({}): its {}", who_, EXTENSION, what));
  }
  double number(const char* name, double otherwise) const {
    return light_.Has(name) && light_.Get(name).IsNumber() ? light_.Get(name).GetNumberAsDouble() : otherwise;
  }
  double number_at(const tinygltf::Value& list, int i, const char* name) const {
    const tinygltf::Value& value = list.Get(i);
    const double d = value.IsNumber() ? value.GetNumberAsDouble() : std::nan("");
    if (!(std::abs(d) < 1e18)) refuse(fmt::format("{} hold something that is no finite number", name));
    return d;
  }

  glm::dmat3 rotation() const {
    if (!light_.Has("rotation")) return glm::dmat3(1.0);
    const tinygltf::Value& list = light_.Get("rotation");
    if (!list.IsArray() || list.ArrayLen() != 4) refuse("rotation must be four numbers");
    const auto at = [&](int i) { return number_at(list, i, "rotation's numbers"); };
    const glm::dquat q(at(3), at(0), at(1), at(2));
    if (!(glm::length(q) > 1e-6)) refuse("rotation is no quaternion");
    return glm::mat3_cast(glm::normalize(q));
  }

  /// Of radiance, in the light's own frame.
  Sh coefficients() const {
    Sh sh{};
    const tinygltf::Value list =
        light_.Has("irradianceCoefficients") ? light_.Get("irradianceCoefficients") : tinygltf::Value();
    if (!list.IsArray() || list.ArrayLen() != COEFFICIENTS)
      refuse("irradianceCoefficients must be 9 lists of 3 numbers");
    for (int i = 0; i < COEFFICIENTS; ++i) {
      const tinygltf::Value& rgb = list.Get(i);
      if (!rgb.IsArray() || rgb.ArrayLen() != 3) refuse("irradianceCoefficients must be 9 lists of 3 numbers");
      for (int c = 0; c < 3; ++c) sh[size_t(i)][c] = number_at(rgb, c, "irradianceCoefficients") / cosine_lobe(i);
    }
    return sh;
  }

  /// The sharpest pictures; none where the file has none.
  std::vector<Face> pictures() const {
    const tinygltf::Value levels = light_.Has("specularImages") ? light_.Get("specularImages") : tinygltf::Value();
    if (!levels.IsArray() || levels.ArrayLen() == 0) return {};
    const tinygltf::Value& sharpest = levels.Get(0);
    if (!sharpest.IsArray() || sharpest.ArrayLen() != FACES) refuse("specularImages must be lists of 6 images");
    std::vector<Face> faces;
    for (int i = 0; i < FACES; ++i) {
      const int image = sharpest.Get(i).IsInt() ? sharpest.Get(i).GetNumberAsInt() : -1;
      check_index(document_, image, document_.model.images.size(), who_, "image");
      if (document_.missing_images.contains(image)) return {};
      faces.push_back(decoded(decode_image(document_, size_t(image))));
      if (faces.back().side != faces.front().side) refuse("specularImages differ in size");
    }
    return faces;
  }

  /// RGBD: colours over alpha; 1 where there is none.
  Face decoded(const TextureImage& image) const {
    if (image.width != image.height) refuse("specularImages are not square");
    Face face{image.width, std::vector<glm::vec3>(size_t(image.width) * size_t(image.height))};
    for (size_t i = 0; i < face.radiance.size(); ++i) {
      const std::uint8_t* rgbd = &image.rgba[4 * i];
      for (int c = 0; c < 3; ++c)
        face.radiance[i][c] = srgb_decode(float(rgbd[c]) / 255.0f) * 255.0f / std::max(float(rgbd[3]), 1.0f);
    }
    return face;
  }

  /// Files have pictures as a cube map has them, or turned over in one way or the other: as the coefficients say.
  void lay_out(const std::vector<Face>& faces, Image& image) const {
    const glm::dmat3 light_from_world = glm::transpose(world_from_light_);
    double nearest = -1.0;
    Image candidate(image.width, image.height);
    for (int turned = 0; turned < 4; ++turned) {
      for_each_texel(image, [&](int x, int y, const glm::dvec3& d, double) {
        glm::dvec2 at;
        const Face& face = faces[size_t(face_of(light_from_world * d, at))];
        if ((turned & 1) != 0) at.x = 1.0 - at.x;
        if ((turned & 2) != 0) at.y = 1.0 - at.y;
        candidate.at(x, y) = bilinear(face, at);
      });
      const double away = distance(projected(candidate, light_from_world));
      if (nearest >= 0.0 && away >= nearest * (1.0 - 1e-6)) continue;
      nearest = away;
      image = candidate;
    }
  }

  /// Of pictures from what is told, in bands 1 and 2, both as bright.
  double distance(const Sh& sh) const {
    double sum = 0.0;
    for (int c = 0; c < 3; ++c) {
      const double scale = sh[0][c] > 0.0 ? radiance_[0][c] / sh[0][c] : 0.0;
      for (size_t i = 1; i < sh.size(); ++i) sum += std::pow(scale * sh[i][c] - radiance_[i][c], 2.0);
    }
    return sum;
  }

  /// What surfaces receive is what the coefficients say: the pictures get what they lack of the three bands, and where
  /// that would be negative their mean is made right.
  void as_bright_as_told(Image& image, bool has_pictures) const {
    const glm::dmat3 light_from_world = glm::transpose(world_from_light_);
    const Sh have = projected(image, light_from_world);
    if (has_pictures) warn_of_units(have);
    for_each_texel(image, [&](int x, int y, const glm::dvec3& d, double) {
      const auto basis = sh_at(light_from_world * d);
      glm::dvec3 p(image.at(x, y));
      for (size_t i = 0; i < have.size(); ++i) p += basis[i] * (radiance_[i] - have[i]);
      image.at(x, y) = glm::vec3(glm::max(p, glm::dvec3(0.0)));
    });
    const Sh now = projected(image, light_from_world);
    glm::vec3 scale(0.0f);
    for (int c = 0; c < 3; ++c)
      if (now[0][c] > 0.0) scale[c] = float(std::max(radiance_[0][c], 0.0) / now[0][c]);
    for (glm::vec3& p : image.pixels) p *= scale;
  }
  void warn_of_units(const Sh& have) const {
    constexpr double ALIKE = 2.0;
    const double told = radiance_[0].x + radiance_[0].y + radiance_[0].z, seen = have[0].x + have[0].y + have[0].z;
    if (told <= ALIKE * seen && seen <= ALIKE * told) return;
    warn(document_.path,
         fmt::format(
             "{}: its irradianceCoefficients are those of pictures {:.2g} times as bright as its own; they count", who_,
             told / std::max(seen, 1e-30)));
  }

  const Document& document_;
  const tinygltf::Value& light_;
  std::string who_;
  double intensity_ = 1.0;
  glm::dmat3 world_from_light_{1.0};
  Sh radiance_{};
};

}  // namespace

std::shared_ptr<const Sky> read_image_light(const Document& document) {
  const tinygltf::Model& model = document.model;
  if (model.scenes.empty()) return nullptr;
  const auto& of_scene =
      model.scenes[size_t(document.reading.scene.value_or(std::max(model.defaultScene, 0)))].extensions;
  const auto named = of_scene.find(EXTENSION), all = model.extensions.find(EXTENSION);
  if (named == of_scene.end() || !named->second.Has("light")) return nullptr;
  const tinygltf::Value lights =
      all != model.extensions.end() && all->second.Has("lights") ? all->second.Get("lights") : tinygltf::Value();
  const tinygltf::Value& light = named->second.Get("light");
  const int index = light.IsInt() ? light.GetNumberAsInt() : -1;
  check_index(document, index, lights.IsArray() ? lights.ArrayLen() : 0, "the scene", "image-based light");
  return ImageLight(document, size_t(index), lights.Get(index)).sky();
}

}  // namespace volgi::gltf
