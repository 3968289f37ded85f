// Directions of a sky, and the lights that stand for it.
#include "core/sky.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/constants.hpp>
#include <memory>

#include "core/error.h"
#include "core/luminance.h"

namespace volgi {
namespace {

/// Four quarters of azimuth, and two halves of height, each of its own colour.
Image quarters() {
  Image image(64, 32);
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 64; ++x) image.at(x, y) = glm::vec3(float(x / 16), y < 16 ? 1.0f : 0.0f, 1.0f);
  return image;
}

TEST(Sky, MiddleColumnLooksAlongMinusZ) {
  const Sky sky(quarters());
  const auto column = [&](glm::vec3 d) { return sky.radiance(glm::normalize(d)).x; };
  EXPECT_FLOAT_EQ(column({-0.5f, 0.2f, -1}), 1.0f) << "left of the middle";
  EXPECT_FLOAT_EQ(column({0.5f, 0.2f, -1}), 2.0f) << "right of it, towards +X";
  EXPECT_FLOAT_EQ(column({0.5f, 0.2f, 1}), 3.0f);
  EXPECT_FLOAT_EQ(column({-0.5f, 0.2f, 1}), 0.0f);
  EXPECT_EQ(sky.radiance({0, 1, 0}).y, 1.0f) << "row 0 is up";
  EXPECT_EQ(sky.radiance({0, -1, 0}).y, 0.0f);
  // Around in u: between the last column and the first.
  EXPECT_NEAR(column({0, 0.3f, 1}), 1.5f, 1e-3f);
}

TEST(Sky, TurnsFromMinusZTowardsX) {
  const Sky straight(quarters()), turned(quarters(), glm::half_pi<float>());
  const glm::vec3 d = glm::normalize(glm::vec3(0.3f, 0.4f, -1.0f));
  EXPECT_EQ(turned.radiance({-d.z, d.y, d.x}), straight.radiance(d));
}

TEST(Sky, TexelsAreWhereTheyLook) {
  const Sky sky(quarters(), 0.7f);
  for (const glm::ivec2 t : {glm::ivec2(3, 4), {40, 20}, {63, 31}})
    EXPECT_LT(glm::distance(sky.radiance(sky.direction_at(t.x + 0.5, t.y + 0.5)), sky.image().at(t.x, t.y)), 1e-4f);
}

TEST(Sky, LightsAreAllOfIt) {
  Image image = quarters();
  image.at(20, 5) = glm::vec3(3000.0f, 2000.0f, 1000.0f);
  for (const Sky& sky : {Sky(glm::vec3(1.0f, 1.1f, 1.3f)), Sky(image, 0.3f)}) {
    for (const int count : {64, 256}) {
      const auto lights = sky_lights(sky, count);
      EXPECT_EQ(lights.size(), size_t(count));
      glm::dvec3 sum(0.0);
      double solid_angle = 0.0;
      for (const SkyLight& l : lights) {
        sum += glm::dvec3(l.irradiance);
        solid_angle += double(l.solid_angle_sr);
        EXPECT_NEAR(glm::length(l.direction), 1.0f, 1e-5f);
      }
      EXPECT_NEAR(solid_angle, 4.0 * glm::pi<double>(), 1e-4);
      EXPECT_NEAR(luminance(sum), luminance(sky.integral()), 1e-4 * luminance(sky.integral()));
    }
  }
}

TEST(Sky, LightsLightAPlaneAsTheSkyDoes) {
  const Sky sky(glm::vec3(1.0f));
  for (const glm::vec3 normal : {glm::vec3(0, 1, 0), {1, 0, 0}, glm::normalize(glm::vec3(1, -2, 3))}) {
    double irradiance = 0.0;
    for (const SkyLight& l : sky_lights(sky, 256))
      irradiance += double(std::max(-glm::dot(l.direction, normal), 0.0f) * l.irradiance.x);
    EXPECT_NEAR(irradiance, glm::pi<double>(), 0.005 * glm::pi<double>());
  }
}

/// What a plane receives of the sky, by every texel.
double irradiance_of(const Sky& sky, glm::vec3 normal) {
  const Image& image = sky.image();
  double sum = 0.0;
  for (int y = 0; y < image.height; ++y) {
    const double solid_angle =
        2.0 * glm::pi<double>() / image.width *
        (std::cos(glm::pi<double>() * y / image.height) - std::cos(glm::pi<double>() * (y + 1) / image.height));
    for (int x = 0; x < image.width; ++x) {
      const double cosine = double(std::max(glm::dot(sky.direction_at(x + 0.5, y + 0.5), normal), 0.0f));
      sum += cosine * solid_angle * double(image.at(x, y).y);
    }
  }
  return sum;
}

// Few parts, so that a picture alone errs; means do not. Parts keep their light, and picture 0 is sky_lights().
TEST(Sky, MeansOfPartsLightAPlaneAsTheSkyDoes) {
  const auto sky = std::make_shared<const Sky>(clear_sky(glm::radians(20.0), 1.0, 3.0));
  const SkyParts parts(sky, 32);
  const auto first = sky_lights(*sky, 32);
  const glm::vec3 normals[] = {{0, 1, 0}, {1, 0, 0}, glm::normalize(glm::vec3(1, 2, -3))};
  double mean[3] = {};
  constexpr int kPictures = 64;
  for (int k = 0; k < kPictures; ++k) {
    const auto lights = parts.lights(k);
    ASSERT_EQ(lights.size(), first.size());
    for (size_t i = 0; i < lights.size(); ++i) {
      EXPECT_EQ(lights[i].irradiance, first[i].irradiance);
      EXPECT_NEAR(glm::length(lights[i].direction), 1.0f, 1e-5f);
      EXPECT_TRUE(k > 0 || lights[i].direction == first[i].direction);
      for (int n = 0; n < 3; ++n)
        mean[n] +=
            double(std::max(-glm::dot(lights[i].direction, normals[n]), 0.0f) * lights[i].irradiance.y) / kPictures;
    }
  }
  for (int n = 0; n < 3; ++n) EXPECT_NEAR(mean[n] / irradiance_of(*sky, normals[n]), 1.0, 0.01) << n;
}

TEST(Sky, ClearSkyIsDaylight) {
  const double elevation = glm::radians(45.0);
  const Sky sky = clear_sky(elevation, 0.0, 3.0);
  const Light sun = sun_of_clear_sky(elevation, 0.0, 3.0);
  EXPECT_GT(luminance(glm::dvec3(sun.intensity)), 60000.0);
  EXPECT_LT(luminance(glm::dvec3(sun.intensity)), 110000.0);
  EXPECT_GT(sun.intensity.x, sun.intensity.z) << "warm";
  double irradiance = 0.0;
  for (const SkyLight& l : sky_lights(sky, 512))
    irradiance += double(std::max(-l.direction.y, 0.0f)) * luminance(glm::dvec3(l.irradiance));
  EXPECT_GT(irradiance, 5000.0);
  EXPECT_LT(irradiance, 30000.0);
  const glm::vec3 away = sky.radiance(glm::normalize(glm::vec3(0.0f, 1.0f, 1.0f)));
  EXPECT_GT(away.z, away.x) << "blue";
  EXPECT_EQ(sun_of_clear_sky(-0.1, 0.0, 3.0).intensity, glm::vec3(0.0f));
}

TEST(Sky, FilesThatAreNone) {
  const std::filesystem::path file = std::filesystem::path(testing::TempDir()) / "sky_test.exr";
  const auto refusal = [&](const Image& image) {
    write_exr(file, image);
    try {
      read_sky(file, 0.0f);
    } catch (const Error& e) {
      EXPECT_EQ(e.code(), ExitCode::bad_input);
      return std::string(e.what());
    }
    return std::string();
  };
  EXPECT_NE(refusal(Image(8, 8)).find("twice as wide as high"), std::string::npos);
  EXPECT_NE(refusal(Image(8, 4, glm::vec3(-1.0f))).find("not negative"), std::string::npos);
  Image bad(8, 4);
  bad.at(3, 2).y = NAN;
  EXPECT_NE(refusal(bad).find("(3, 2)"), std::string::npos);
  EXPECT_EQ(refusal(Image(8, 4)), "");
}

}  // namespace
}  // namespace volgi
