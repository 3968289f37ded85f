// Levels of a light tree as lights: each has all of the flux, in ever fewer of them.
#include "screen/views/light_tree_level.h"

#include <algorithm>

#include "tests/screen/gather/clustered_lights.h"
#include "tests/support/gl_test.h"

namespace volgi::test {
namespace {

using LightTreeLevelTest = GlTest;

glm::dvec3 flux_of(const std::vector<VirtualLight>& lights) {
  glm::dvec3 sum(0.0);
  for (const VirtualLight& l : lights) sum += glm::dvec3(l.flux);
  return sum;
}

TEST_F(LightTreeLevelTest, EachLevelHasAllOfTheFlux) {
  const auto reflected = lights_above(1500, 1.0f, 2.5f, VIRTUAL_LIGHT_REFLECTED, 1);
  const auto emitted = lights_above(300, 1.0f, 2.5f, VIRTUAL_LIGHT_EMITTED, 2);
  ClusteredLights lit(context(), open_floor(), {16, 16}, reflected, emitted);
  screen::LightTree tree(2.0f);
  tree.run(lit.list, nullptr, lit.area_lights, lit.seen.diagonal_m, lit.seen.timer);
  ASSERT_GE(tree.top_level(), 3);
  const glm::dvec3 expected = flux_of(reflected) + flux_of(emitted);
  screen::LightTreeLevel level;
  size_t last = reflected.size() + emitted.size() + 1;
  for (int k = 0; k <= tree.top_level(); ++k) {
    const std::vector<VirtualLight> lights = download(level.run(tree, k, lit.seen.timer));
    const glm::dvec3 flux = flux_of(lights);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(flux[c] / expected[c], 1.0, 1e-5) << k;
    const auto bright = size_t(std::count_if(lights.begin(), lights.end(), [](auto& l) { return l.flux.x > 0.0f; }));
    EXPECT_LT(bright, last) << k;
    EXPECT_GE(bright * 4, k == 0 ? 0 : last) << k;
    last = bright;
  }
  // Above the topmost there are the roots.
  EXPECT_EQ(download(level.run(tree, 100, lit.seen.timer)).size(),
            download(level.run(tree, tree.top_level(), lit.seen.timer)).size());
}

}  // namespace
}  // namespace volgi::test
