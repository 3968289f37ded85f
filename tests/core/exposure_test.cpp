#include "core/exposure.h"

#include <gtest/gtest.h>

#include <cmath>

namespace volgi {
namespace {

Image grey(std::initializer_list<float> values) {
  Image image(int(values.size()), 1);
  int x = 0;
  for (const float v : values) image.at(x++, 0) = glm::vec3(v);
  return image;
}

TEST(Exposure, BringsTheGeometricMeanToMiddleGrey) {
  EXPECT_NEAR(automatic_exposure_ev(grey({0.18f})), 0.0f, 1e-6f);
  EXPECT_NEAR(automatic_exposure_ev(grey({0.09f, 0.36f})), 0.0f, 1e-6f);
  EXPECT_NEAR(automatic_exposure_ev(grey({18.0f})), -std::log2(100.0f), 0.006f);
}

TEST(Exposure, LeavesOutBlackAndTheBrightest) {
  EXPECT_EQ(automatic_exposure_ev(grey({0.0f, 0.0f})), 0.0f);
  EXPECT_NEAR(automatic_exposure_ev(grey({0.0f, 0.18f, 0.18f})), 0.0f, 1e-6f);
  EXPECT_NEAR(automatic_exposure_ev(grey({INFINITY, NAN, 0.18f})), 0.0f, 1e-6f);
  Image lamp(100, 1, glm::vec3(0.18f));
  lamp.pixels[7] = lamp.pixels[8] = glm::vec3(1e6f);
  EXPECT_NEAR(automatic_exposure_ev(lamp), 0.0f, 1e-6f);
}

// Candela or watts, in anything from microwatts to gigawatts.
TEST(Exposure, ScalesWithTheLight) {
  Image image = grey({0.02f, 0.3f, 0.11f, 0.7f, 2.0f});
  const float ev = automatic_exposure_ev(image);
  for (const int stops : {-20, 10, 30}) {
    Image other = image;
    for (glm::vec3& p : other.pixels) p *= std::exp2(float(stops));
    EXPECT_NEAR(automatic_exposure_ev(other), ev - float(stops), 1e-4f) << stops;
  }
}

}  // namespace
}  // namespace volgi
