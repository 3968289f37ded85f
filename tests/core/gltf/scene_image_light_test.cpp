// EXT_lights_image_based: a sky from six pictures and the coefficients of what it lights.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/quaternion.hpp>

#include "core/error.h"
#include "core/image.h"
#include "core/scene.h"
#include "core/sky.h"
#include "tests/support/gltf_writer.h"

namespace volgi {
namespace {

using test::Json;

constexpr double kPi = glm::pi<double>();
using Radiance = std::function<glm::dvec3(glm::dvec3)>;

/// Even light, more of it from the right, above and behind, in colours of their own: bands 0 and 1.
glm::dvec3 soft(glm::dvec3 d) { return glm::dvec3(1.0 + 0.5 * d.x, 2.0 + 0.6 * d.y, 1.5 + 0.4 * d.z); }
/// Its irradiance.
glm::dvec3 soft_irradiance(glm::dvec3 n) {
  const double band_1 = 2.0 * kPi / 3.0;
  return {kPi + band_1 * 0.5 * n.x, 2.0 * kPi + band_1 * 0.6 * n.y, 1.5 * kPi + band_1 * 0.4 * n.z};
}
/// The integral of something over all directions.
glm::dvec3 integral(const Radiance& of) {
  constexpr int n = 256;
  glm::dvec3 sum(0.0);
  for (int y = 0; y < n; ++y) {
    const double height = 1.0 - (2.0 * y + 1.0) / n, r = std::sqrt(1.0 - height * height);
    for (int x = 0; x < 2 * n; ++x) {
      const double azimuth = kPi * (x + 0.5) / n;
      sum += of({r * std::cos(azimuth), height, r * std::sin(azimuth)}) * (2.0 * kPi / (double(n) * n));
    }
  }
  return sum;
}
/// Its irradiance by the extension's coefficients: 00, 1-1 (y), 10 (z), 11 (x), five more.
Json soft_coefficients(double scale = 1.0) {
  const double of_0 = std::sqrt(4.0 * kPi) * kPi * scale, of_1 = std::sqrt(4.0 * kPi / 3.0) * 2.0 * kPi / 3.0 * scale;
  Json list = Json::array({{of_0, 2.0 * of_0, 1.5 * of_0}, {0, 0.6 * of_1, 0}, {0, 0, 0.4 * of_1}, {0.5 * of_1, 0, 0}});
  for (int i = 4; i < 9; ++i) list.push_back({0, 0, 0});
  return list;
}

class ImageLight : public ::testing::Test {
 protected:
  ImageLight() {
    writer.triangle();
    writer.root["extensionsUsed"] = {"EXT_lights_image_based"};
    light() = {{"irradianceCoefficients", soft_coefficients()}, {"specularImageSize", 16}};
    writer.root["scenes"][0]["extensions"]["EXT_lights_image_based"]["light"] = 0;
  }
  Json& light() { return writer.root["extensions"]["EXT_lights_image_based"]["lights"][0]; }

  /// Six pictures of 16², as a cube map of OpenGL has them: RGBD, its alpha 255 over the brightest colour.
  void pictures(const Radiance& radiance, bool mirrored = false) {
    constexpr int n = 16;
    Json faces = Json::array();
    for (int face = 0; face < 6; ++face) {
      std::vector<std::uint8_t> rgbd;
      for (int i = 0; i < n * n; ++i) {
        const double s = 2.0 * ((mirrored ? n - 1 - i % n : i % n) + 0.5) / n - 1.0, t = 2.0 * (i / n + 0.5) / n - 1.0;
        const glm::dvec3 d[] = {{1, -t, -s}, {-1, -t, s}, {s, 1, t}, {s, -1, -t}, {s, -t, 1}, {-s, -t, -1}};
        const glm::dvec3 value = radiance(glm::normalize(d[face]));
        const double largest = std::max({value.x, value.y, value.z, 1.0});
        const double alpha = std::floor(255.0 / largest);
        for (int c = 0; c < 3; ++c)
          rgbd.push_back(std::uint8_t(255.0f * srgb_encode(float(value[c] * alpha / 255.0)) + 0.5f));
        rgbd.push_back(std::uint8_t(alpha));
      }
      const std::string bytes = test::png(n, n, rgbd);
      faces.push_back(writer.push("images", {{"uri", "data:image/png;base64," + test::base64(bytes)}}));
    }
    light()["specularImages"] = Json::array({faces});
  }
  std::shared_ptr<const Sky> sky() { return load_scene(writer.save_glb(folder / "scene.glb")).sky; }

  test::TemporaryFolder folder;
  test::GltfWriter writer;
};

/// By the texels of its picture.
glm::dvec3 irradiance(const Sky& sky, glm::dvec3 normal) {
  glm::dvec3 sum(0.0);
  const Image& image = sky.image();
  for (int y = 0; y < image.height; ++y) {
    const double solid_angle =
        2.0 * kPi / image.width * (std::cos(kPi * y / image.height) - std::cos(kPi * (y + 1) / image.height));
    for (int x = 0; x < image.width; ++x) {
      const double cosine = glm::dot(normal, glm::dvec3(sky.direction_at(x + 0.5, y + 0.5)));
      sum += std::max(cosine, 0.0) * solid_angle * glm::dvec3(image.at(x, y));
    }
  }
  return sum;
}

const std::array<glm::dvec3, 5> DIRECTIONS{
    glm::dvec3(1, 0, 0), {0, 1, 0}, {0, 0, 1}, {-0.48, 0.6, -0.64}, {0.36, -0.48, 0.8}};

void expect_near(glm::dvec3 a, glm::dvec3 b, double tolerance) {
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(a[c], b[c], tolerance * b[c]) << c;
}

// Texels of 8 bits err by 0.5 % of what they hold, and lie up to 3.5 degrees apart; irradiance is the coefficients',
// but for the steps of the sum over 64 x 32 texels.
TEST_F(ImageLight, PicturesAndCoefficientsAgree) {
  pictures(soft);
  const auto made = sky();
  ASSERT_TRUE(made);
  for (const glm::dvec3& d : DIRECTIONS) {
    expect_near(glm::dvec3(made->radiance(glm::vec3(d))), soft(d), 0.02);
    expect_near(irradiance(*made, d), soft_irradiance(d), 2e-3);
  }
}

// What pictures lack, here all, comes from the coefficients. At a pole the nearest texels lie 1.4 degrees away: 0.7 %.
TEST_F(ImageLight, CoefficientsAlone) {
  const auto made = sky();
  ASSERT_TRUE(made);
  for (const glm::dvec3& d : DIRECTIONS) {
    expect_near(glm::dvec3(made->radiance(glm::vec3(d))), soft(d), 0.01);
    expect_near(irradiance(*made, d), soft_irradiance(d), 2e-3);
  }
}

// A bright patch is where the picture has it, also where the file's pictures are mirrored, which the coefficients tell.
// Its rim is coarse in texels of 5 degrees: 3 % of what surfaces receive.
TEST_F(ImageLight, PicturesOfBothHandsLookAlike) {
  const glm::dvec3 lamp = glm::normalize(glm::dvec3(0.8, 0.5, 0.35));
  const auto with_lamp = [&](glm::dvec3 d) {
    return soft(d) + (glm::dot(d, lamp) > 0.97 ? glm::dvec3(8.0) : glm::dvec3(0.0));
  };
  const double b = std::sqrt(0.75 / kPi), c = std::sqrt(3.75 / kPi);
  const std::array<std::function<double(glm::dvec3)>, 9> basis{
      [&](glm::dvec3) { return 0.5 / std::sqrt(kPi); },
      [&](glm::dvec3 d) { return b * d.y; },
      [&](glm::dvec3 d) { return b * d.z; },
      [&](glm::dvec3 d) { return b * d.x; },
      [&](glm::dvec3 d) { return c * d.x * d.y; },
      [&](glm::dvec3 d) { return c * d.y * d.z; },
      [&](glm::dvec3 d) { return std::sqrt(1.25 / kPi) * (1.5 * d.z * d.z - 0.5); },
      [&](glm::dvec3 d) { return c * d.x * d.z; },
      [&](glm::dvec3 d) { return 0.5 * c * (d.x * d.x - d.y * d.y); }};
  Json coefficients = Json::array();
  for (size_t i = 0; i < basis.size(); ++i) {
    const double cosine_lobe = i == 0 ? kPi : i < 4 ? 2.0 * kPi / 3.0 : kPi / 4.0;
    const glm::dvec3 e = cosine_lobe * integral([&](glm::dvec3 d) { return basis[i](d) * with_lamp(d); });
    coefficients.push_back({e.x, e.y, e.z});
  }
  light()["irradianceCoefficients"] = coefficients;
  for (const bool mirrored : {false, true}) {
    writer.root.erase("images");
    pictures(with_lamp, mirrored);
    const auto made = sky();
    ASSERT_TRUE(made);
    EXPECT_GT(made->radiance(glm::vec3(lamp)).x, 6.0f);
    EXPECT_LT(made->radiance(glm::vec3(lamp.x, lamp.y, -lamp.z)).x, 2.5f);
    for (const glm::dvec3& d : DIRECTIONS)
      expect_near(irradiance(*made, d),
                  integral([&](glm::dvec3 w) { return std::max(glm::dot(d, w), 0.0) * with_lamp(w); }), 0.03);
  }
}

TEST_F(ImageLight, TurnsAndScales) {
  const glm::dquat turn = glm::angleAxis(0.7, glm::normalize(glm::dvec3(0.3, 1.0, -0.2)));
  pictures(soft);
  light()["intensity"] = 3.0;
  light()["rotation"] = {turn.x, turn.y, turn.z, turn.w};
  const auto made = sky();
  ASSERT_TRUE(made);
  for (const glm::dvec3& d : DIRECTIONS) {
    const glm::dvec3 in_light = glm::inverse(turn) * d;
    expect_near(glm::dvec3(made->radiance(glm::vec3(d))), 3.0 * soft(in_light), 0.02);
    expect_near(irradiance(*made, d), 3.0 * soft_irradiance(in_light), 2e-3);
  }
}

// Coefficients over pi, as some write them: said, and taken at their word.
TEST_F(ImageLight, SaysWhereUnitsDiffer) {
  pictures(soft);
  light()["irradianceCoefficients"] = soft_coefficients(1.0 / kPi);
  ::testing::internal::CaptureStderr();
  const auto made = sky();
  EXPECT_NE(::testing::internal::GetCapturedStderr().find("0.32 times as bright"), std::string::npos);
  ASSERT_TRUE(made);
  expect_near(irradiance(*made, {0, 1, 0}), soft_irradiance({0, 1, 0}) / kPi, 4e-3);
}

TEST_F(ImageLight, OnlyWhereTheSceneNamesOne) {
  writer.root["scenes"][0].erase("extensions");
  EXPECT_FALSE(sky());
}

TEST_F(ImageLight, RefusesWhatIsNone) {
  const auto refused = [&](const char* name, const Json& value, const char* word) {
    const Json before = light();
    light()[name] = value;
    try {
      sky();
      ADD_FAILURE() << name << " was taken";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ExitCode::bad_input);
      EXPECT_NE(std::string(error.what()).find(word), std::string::npos) << error.what();
    }
    light() = before;
  };
  refused("irradianceCoefficients", Json::array({1, 2}), "irradianceCoefficients");
  refused("irradianceCoefficients", nullptr, "irradianceCoefficients");
  refused("specularImages", Json::array({{0, 1, 2}}), "specularImages");
  refused("specularImages", Json::array({{7, 7, 7, 7, 7, 7}}), "image 7");
  refused("rotation", Json::array({0, 0, 0, 0}), "rotation");
  refused("intensity", -1.0, "intensity");
  writer.root["scenes"][0]["extensions"]["EXT_lights_image_based"]["light"] = 3;
  EXPECT_THROW(sky(), Error);
}

}  // namespace
}  // namespace volgi
