// The gather of virtual area lights: every light at every pixel against double precision; interleaved against every
// pixel; no light over edges of geometry; the pixels that are gathered again.
#include <algorithm>
#include <random>

#include "core/error.h"
#include "screen/gather/interleaved/area_light_gather.h"
#include "tests/screen/gather/clustered_lights.h"
#include "tests/support/gl_test.h"

namespace volgi::test {
namespace {

using screen::AreaLightGather;
using screen::AreaLightGatherOptions;
using Picture = std::vector<glm::vec4>;

class InterleavedGather : public GlTest {
 protected:
  struct Pictures {
    Picture direct, indirect;
  };

  struct Lit : ClusteredLights {
    using ClusteredLights::ClusteredLights;

    Pictures by(int interleave, float exact_rows) {
      AreaLightGatherOptions o;
      o.interleave = interleave;
      o.exact_rows = exact_rows;
      AreaLightGather gather(seen.size, o, *shadow);
      gather.run(seen.gbuffer, list, area_lights, maps, *shadow, seen.diagonal_m, seen.timer);
      return {texels(gather.direct()), texels(gather.indirect())};
    }
  };

  /// Root mean square of the difference, in parts of the mean of `exact`.
  static double error(const Picture& exact, const Picture& picture) {
    double squared = 0.0, mean = 0.0;
    for (size_t i = 0; i < exact.size(); ++i) {
      const glm::dvec3 d(glm::vec3(picture[i] - exact[i]));
      squared += glm::dot(d, d) / 3.0;
      mean += glm::dot(glm::dvec3(glm::vec3(exact[i])), glm::dvec3(1.0 / 3.0));
    }
    return std::sqrt(squared / double(exact.size())) / (mean / double(exact.size()));
  }
};

// Three blocks of lights, the last clusters of one block beginning the next; nothing stands between them and the floor.
TEST_F(InterleavedGather, EveryLightAtEveryPixelIsTheSum) {
  const auto reflected = lights_above(1500, 1.0f, 2.5f, VIRTUAL_LIGHT_REFLECTED, 1);
  const auto emitted = lights_above(700, 1.0f, 2.5f, VIRTUAL_LIGHT_EMITTED, 2);
  Lit lit(context(), open_floor(), {48, 36}, reflected, emitted);
  const Pictures pictures = lit.by(1, 0.0f);
  for (size_t i = 0; i < pictures.indirect.size(); ++i) {
    const glm::dvec3 indirect = radiance_of(reflected, lit.seen, i), direct = radiance_of(emitted, lit.seen, i);
    for (int c = 0; c < 3; ++c) {
      ASSERT_NEAR(double(pictures.indirect[i][c]), indirect[c], 1e-3 * indirect[c] + 1e-6) << i;
      ASSERT_NEAR(double(pictures.direct[i][c]), direct[c], 1e-3 * direct[c] + 1e-6) << i;
    }
  }
}

// On a plane every light counts once at every pixel. High lights give light that is smooth over a block; a subset that
// is left out or taken twice shows as 1 / 64 at least. 1000 lights do not divide by 64.
TEST_F(InterleavedGather, EveryLightCountsOnceOnAPlane) {
  Lit lit(context(), open_floor(), {256, 192}, lights_above(1000, 4.0f, 5.0f, VIRTUAL_LIGHT_REFLECTED, 3),
          lights_above(500, 4.0f, 5.0f, VIRTUAL_LIGHT_EMITTED, 4));
  const Pictures exact = lit.by(1, 0.0f);
  for (const int n : {2, 4, 8}) {
    const Pictures interleaved = lit.by(n, 0.0f);
    for (int y = 16; y < 176; ++y) {
      for (int x = 16; x < 240; ++x) {
        const size_t i = size_t(y) * 256 + size_t(x);
        if (lit.seen.position[i].w == 0.0f) continue;
        // The floor's edges cut windows: there a subset may come from one side.
        const glm::vec3 at = lit.seen.position[i];
        if (std::max(std::abs(at.x), std::abs(at.z)) > 1.4f) continue;
        for (int c = 0; c < 3; ++c) {
          ASSERT_NEAR(interleaved.indirect[i][c] / exact.indirect[i][c], 1.0f, 0.006f) << n << ": " << x << ' ' << y;
          ASSERT_NEAR(interleaved.direct[i][c] / exact.direct[i][c], 1.0f, 0.006f) << n << ": " << x << ' ' << y;
        }
      }
    }
  }
}

// Lights under the plate and the box's top: what no light meets stays black to the last pixel beside what is lit.
TEST_F(InterleavedGather, NothingBleedsOverEdges) {
  const Scene scene = floor_with_edges();
  Lit lit(context(), scene, {192, 144}, lights_above(1024, 0.3f, 0.8f, VIRTUAL_LIGHT_REFLECTED, 5));
  const Picture exact = lit.by(1, 0.0f).indirect;
  for (const int n : {4, 8}) {
    const Picture interleaved = lit.by(n, 0.0f).indirect;
    int dark = 0, lit_pixels = 0;
    for (size_t i = 0; i < exact.size(); ++i) {
      if (lit.seen.position[i].w == 0.0f) continue;
      const bool above_all = lit.seen.position[i].y > 0.85f && lit.seen.geometric(i).y > 0.9;
      if (above_all) {
        ASSERT_EQ(glm::vec3(interleaved[i]), glm::vec3(0.0f)) << n;
        ++dark;
      } else if (lit.seen.position[i].y < 0.01f) {
        lit_pixels += glm::vec3(exact[i]) != glm::vec3(0.0f);
      }
    }
    EXPECT_GT(dark, 1000);
    EXPECT_GT(lit_pixels, 1000);
  }
}

TEST_F(InterleavedGather, ErrorEstimateIsWhereTheErrorIs) {
  const Scene scene = floor_with_edges();
  Lit lit(context(), scene, {192, 144}, lights_above(1024, 1.4f, 2.0f, VIRTUAL_LIGHT_REFLECTED, 6),
          lights_above(512, 1.4f, 2.0f, VIRTUAL_LIGHT_EMITTED, 7));
  const Pictures exact = lit.by(1, 0.0f), blurred = lit.by(8, 0.0f), twentieth = lit.by(8, 7.2f);
  size_t changed = 0, wrong = 0;
  for (size_t i = 0; i < exact.indirect.size(); ++i) {
    if (twentieth.indirect[i] == blurred.indirect[i]) continue;
    ++changed;
    wrong += twentieth.indirect[i] != exact.indirect[i] || twentieth.direct[i] != exact.direct[i];
  }
  EXPECT_LE(changed, exact.indirect.size() / 20);
  EXPECT_GT(changed, exact.indirect.size() / 30);
  EXPECT_EQ(wrong, 0u);  // gathered with every light, in the same order
  // A twentieth of the pixels at random would leave 0.97 of the error.
  EXPECT_LT(error(exact.indirect, twentieth.indirect), 0.8 * error(exact.indirect, blurred.indirect));
  EXPECT_LT(error(exact.direct, twentieth.direct), 0.8 * error(exact.direct, blurred.direct));
  EXPECT_LT(error(exact.indirect, lit.by(8, 144.0f).indirect), 1e-3);
}

TEST_F(InterleavedGather, NoLightsAreBlack) {
  Lit lit(context(), open_floor(), {40, 30}, {});
  for (const int n : {1, 4}) {
    for (const glm::vec4& p : lit.by(n, 9.0f).indirect) ASSERT_EQ(glm::vec3(p), glm::vec3(0.0f));
  }
}

TEST_F(InterleavedGather, RefusesOtherBlocks) {
  Lit lit(context(), open_floor(), {16, 12}, {});
  EXPECT_THROW(lit.by(3, 0.0f), Error);
  EXPECT_THROW(lit.by(16, 0.0f), Error);
  EXPECT_THROW(lit.by(4, -1.0f), Error);
}

}  // namespace
}  // namespace volgi::test
