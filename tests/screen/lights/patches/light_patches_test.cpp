// Patches of light: their tree against the maps' own texels, and which of them are chosen.
#include "screen/lights/patches/light_patches.h"

#include <set>

#include "shaders/screen/lights/patches/light_patch.shared.h"
#include "tests/screen/virtual_light_scenes.h"
#include "tests/support/gl_test.h"

namespace volgi::test {
namespace {

using screen::LightPatches;
using screen::LightPatchOptions;
using Light = LightPatchOptions::Light;
using Method = LightPatchOptions::Method;
using shared::LightPatch;
using shared::PatchRange;

TEST(LightPatchTree, MortonPlacesAreInversesAndPartsFollowOnOneAnother) {
  for (int i = 0; i < 4096; ++i) {
    const glm::ivec2 cell = shared::morton_cell(i);
    EXPECT_EQ(shared::morton_index(cell), i);
    EXPECT_EQ(shared::morton_cell(i / 4), cell / 2);
  }
  EXPECT_EQ(shared::first_of_depth(256, 0), 0);
  EXPECT_EQ(shared::first_of_depth(256, 1), 256);
  EXPECT_EQ(shared::first_of_depth(256, 3), 256 * 21);
}

class LightPatchesTest : public GlTest {
 protected:
  struct Made {
    std::vector<LightPatch> patches;
    std::vector<PatchRange> ranges;
    std::vector<VirtualLight> lights;
    int roots = 0, deepest = 0;
    /// Flux of all patches of a depth.
    glm::dvec3 flux(int depth) const {
      glm::dvec3 sum(0.0);
      for (int i = shared::first_of_depth(roots, depth); i < shared::first_of_depth(roots, depth + 1); ++i)
        sum += glm::dvec3(patches[size_t(i)].flux);
      return sum;
    }
  };
  static Made made(const Scene& scene, const LightPatchOptions& options) {
    gl::PassTimer timer(context().software(), false);
    const gl::SceneBuffers buffers(scene);
    screen::ReflectiveShadowMap maps(kResolution);
    maps.run(buffers, scene, timer);
    LightPatches patches(options);
    patches.run(maps, glm::distance(scene.bounds_min, scene.bounds_max), timer);
    const screen::LightPatchTree& tree = patches.tree();
    const auto count = size_t(shared::first_of_depth(tree.roots, tree.deepest + 1));
    return {tree.patches.download<LightPatch>(count), patches.ranges().download<PatchRange>(count),
            download(patches.lights()), tree.roots, tree.deepest};
  }
  static LightPatchOptions options(Method method, Light light) {
    LightPatchOptions o;
    o.method = method;
    o.light = light;
    o.grid = 8;
    o.depth = 2;
    return o;
  }
  /// Of every light, what is reflected in all: its power times the mean albedo, which the virtual lights' test checks.
  static glm::dvec3 reflected(const Scene& scene) {
    VirtualLightOptions o;
    o.per_light = 16384;
    return sum_of_flux(lights_of(context(), scene, o));
  }
};

// All texels once at every depth, for every kind of light.
TEST_F(LightPatchesTest, SumsAreTheSameAtEveryDepth) {
  Scene scene = colourful_room();
  for (const volgi::Light& light : one_of_each()) {
    scene.lights = {light};
    const Made m = made(scene, options(Method::hierarchical, Light::summed));
    const glm::dvec3 truth = reflected(scene);
    for (int depth = 0; depth <= 2; ++depth) {
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(m.flux(depth)[c] / m.flux(0)[c], 1.0, 1e-5);
    }
    // Margins lie outside of the cone or the cube's face; 1 % is that of a hard-edged cone's texels on its rim.
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(m.flux(0)[c] / truth[c], 1.0, 0.01) << int(light.type);
  }
}

// As printed all solid angles of a layer are alike: right in sum for a point light, whose six faces are whole, within
// what samples and solid angles of a face vary by; exact ones are nearer.
TEST_F(LightPatchesTest, SamplesStandForTheirPatches) {
  Scene scene = colourful_room();
  scene.lights = {point_light(kLamp, 2.5f)};
  const glm::dvec3 truth = reflected(scene);
  for (const auto& [light, most] : {std::pair(Light::printed, 0.08), std::pair(Light::exact, 0.02)}) {
    LightPatchOptions o = options(Method::hierarchical, light);
    const Made m = made(scene, o);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(m.flux(2)[c] / truth[c], 1.0, most);
    // Eq. 4.2 to 4.4: a face of 4 pi / 6 sr over 32^2 patches.
    const double even = 4.0 * glm::pi<double>() / 6.0 / 1024.0;
    for (int i = shared::first_of_depth(m.roots, 2); i < shared::first_of_depth(m.roots, 3); ++i) {
      const LightPatch& p = m.patches[size_t(i)];
      if (!(p.flux.x > 0.0f) || light != Light::printed) continue;
      const glm::dvec3 way = glm::dvec3(p.position) - glm::dvec3(kLamp);
      EXPECT_NEAR(double(p.area_m2) / (even * glm::dot(way, way)), 1.0, 1e-3);
      EXPECT_LE(p.area_m2, p.bound_m2 * 1.0001f);
    }
  }
}

TEST_F(LightPatchesTest, RangesHoldThoseOfTheirParts) {
  Scene scene = stage();
  scene.lights = {spot_light({0.0f, 2.5f, 1.5f}, {0.0f, -1.0f, -0.5f}, 20.0f, 40.0f, 30.0f)};
  const Made m = made(scene, options(Method::hierarchical, Light::printed));
  for (int depth = 0; depth < 2; ++depth) {
    for (int i = shared::first_of_depth(m.roots, depth); i < shared::first_of_depth(m.roots, depth + 1); ++i) {
      const int first = shared::first_of_depth(m.roots, depth + 1) + 4 * (i - shared::first_of_depth(m.roots, depth));
      float nearest = PATCH_BACKGROUND, farthest = 0.0f, bound = 0.0f;
      for (int k = 0; k < 4; ++k) {
        nearest = std::min(nearest, m.ranges[size_t(first + k)].nearest);
        farthest = std::max(farthest, m.ranges[size_t(first + k)].farthest);
        bound = std::max(bound, 4.0f * m.patches[size_t(first + k)].bound_m2);
      }
      EXPECT_EQ(m.ranges[size_t(i)].nearest, nearest);
      EXPECT_EQ(m.ranges[size_t(i)].farthest, farthest);
      EXPECT_EQ(m.patches[size_t(i)].bound_m2, bound);
    }
  }
}

// Parts end with the map's own texels: 196 of 200 without the margin, 96 on a cube's face.
TEST_F(LightPatchesTest, AreNoSmallerThanTexels) {
  Scene scene = colourful_room();
  LightPatchOptions o = options(Method::hierarchical, Light::summed);
  o.depth = 6;
  for (const auto& [light, deepest] : {std::pair(one_of_each()[0], 4), std::pair(one_of_each()[2], 3)}) {
    scene.lights = {light};
    const Made m = made(scene, o);
    EXPECT_EQ(m.deepest, deepest);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(m.flux(deepest)[c] / m.flux(0)[c], 1.0, 1e-5);
  }
}

// §4.2.3: every texel in one chosen patch, so that they reflect what all do; few where there is one wall, more at
// edges.
TEST_F(LightPatchesTest, RadiosityTakesEveryTexelOnce) {
  Scene scene = stage();
  scene.lights = {spot_light({0.0f, 2.5f, 1.5f}, {0.0f, -1.0f, -0.5f}, 20.0f, 40.0f, 30.0f),
                  point_light({-1.0f, 1.8f, 0.5f}, 5.0f)};
  const Made m = made(scene, options(Method::radiosity, Light::summed));
  const glm::dvec3 sum = sum_of_flux(m.lights);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(sum[c] / m.flux(0)[c], 1.0, 1e-5);
  std::set<double> sizes;
  int lit = 0;
  for (const VirtualLight& l : m.lights) lit += l.flux.x > 0.0f ? 1 : 0;
  EXPECT_GT(lit, m.roots / 4);
  EXPECT_LT(lit, m.roots * 8);
  LightPatchOptions none = options(Method::radiosity, Light::summed);
  none.depth_range = 10.0f;
  none.normal_range = 2.0f;
  Scene room = colourful_room();
  room.lights = {point_light(kLamp, 2.5f)};
  int roots = 0;
  for (const VirtualLight& l : made(room, none).lights) roots += l.flux.x > 0.0f ? 1 : 0;
  EXPECT_EQ(roots, 6 * 64);
}

}  // namespace
}  // namespace volgi::test
