// The wave lattice: how many lights there are, where they are and what they send.
#include "screen/lights/lattice/wave_lattice.h"

#include <cmath>
#include <numeric>
#include <set>

#include "core/error.h"
#include "screen/visibility/visibility_choice.h"
#include "tests/screen/gathered.h"
#include "tests/screen/virtual_light_scenes.h"
#include "tests/support/frame_picture.h"
#include "tests/support/gl_test.h"
#include "tests/support/paths.h"

namespace volgi::test {
namespace {

using screen::lattice_lights_on;
using screen::lattice_size;
using screen::LatticeSize;
using screen::WaveLattice;
using screen::WaveLatticeOptions;

TEST(LatticeSize, AsPrinted) {
  const LatticeSize spot = lattice_size(Light::Type::spot, 5.0f, 5);
  EXPECT_EQ(spot.about, 72);
  EXPECT_EQ(spot.along, 18);
  EXPECT_EQ(spot.rays, 1297);
  EXPECT_EQ(spot.lights, 6485);
  EXPECT_EQ(lattice_size(Light::Type::spot, 10.0f, 1).lights, 36 * 9 + 1);
  EXPECT_EQ(lattice_size(Light::Type::spot, 90.0f, 2).lights, 2 * (4 + 1));
  EXPECT_EQ(lattice_size(Light::Type::point, 5.0f, 5).rays, 72 * 35 + 2);
  EXPECT_EQ(lattice_size(Light::Type::directional, 5.0f, 5).rays, 36 * 36);
}

TEST(LatticeSize, AnglesAreEvenAndNoRayComesTwice) {
  for (const Light::Type type : {Light::Type::spot, Light::Type::point}) {
    const LatticeSize size = lattice_size(type, 15.0f, 1);
    std::set<std::pair<int, int>> seen;
    for (int ray = 0; ray < size.rays; ++ray) {
      const glm::vec2 angles = glm::degrees(shared::lattice_angles(ray, size.about, size.step_rad));
      EXPECT_NEAR(std::remainder(angles.x, 15.0f), 0.0f, 1e-3f);
      EXPECT_NEAR(std::remainder(angles.y, 15.0f), 0.0f, 1e-3f);
      EXPECT_LE(angles.x, type == Light::Type::spot ? 90.001f : 180.001f);
      seen.insert({int(std::lround(angles.x)), int(std::lround(angles.y))});
    }
    EXPECT_EQ(int(seen.size()), size.rays);
  }
}

TEST(LatticeShells, AsPrinted) {
  const float printed[] = {0.05f, 0.1f, 0.2f, 0.4f, 0.8f};
  for (int k = 0; k < 5; ++k) EXPECT_NEAR(shared::lattice_shell(k, 5, 0.8f, 2.0f), printed[k], 1e-6f);
  EXPECT_FLOAT_EQ(shared::lattice_shell(0, 1, 0.8f, 2.0f), 0.8f);
  EXPECT_FLOAT_EQ(shared::lattice_attenuation(0.8f, 1.0f), std::exp(-0.8f));
}

TEST(LatticeLightsOn, AsManyAsAskedFor) {
  EXPECT_EQ(lattice_lights_on(6485, 1.0f, 3).size(), 6485u);
  std::vector<int> times(6485, 0);
  for (int seed = 0; seed < 64; ++seed) {
    const std::vector<int> on = lattice_lights_on(6485, 0.25f, seed);
    EXPECT_NEAR(double(on.size()), 6485 * 0.25, 5.0) << seed;
    EXPECT_EQ(on, lattice_lights_on(6485, 0.25f, seed));
    for (const int i : on) ++times[size_t(i)];
  }
  for (const int n : times) EXPECT_NEAR(n, 16, 3);  // each as often as any other
}

class WaveLatticeTest : public GlTest {
 protected:
  static std::vector<VirtualLight> lights_of(const Scene& scene, const WaveLatticeOptions& options,
                                             std::optional<int> bounces = {}) {
    gl::PassTimer timer(context().software(), false);
    const gl::SceneBuffers buffers(scene);
    screen::ReflectiveShadowMap maps({512, 256, 256});
    maps.run(buffers, scene, timer);
    WaveLattice lattice(scene, options, bounces);
    lattice.run(maps, timer);
    return download(lattice.list());
  }
  static Scene floor_of(float albedo) {
    Scene scene;
    add_quad(scene, add_material(scene, glm::vec3(albedo)), {-9, -1, -9}, {0, 0, 18}, {18, 0, 0});
    update_bounds(scene);
    return scene;
  }
};

/// Over a plane 2 m below: its farthest point in the cone is 2 m / cos.
TEST_F(WaveLatticeTest, SpotOverAPlane) {
  Scene scene = floor_of(0.5f);
  const glm::vec3 position(0.5f, 1.0f, -0.25f), axis(0.0f, -1.0f, 0.0f);
  scene.lights = {spot_light(position, axis, 20, 30, 7.0f)};
  const auto lights = lights_of(scene, {});
  ASSERT_EQ(lights.size(), 6485u);
  const double depth_m = 2.0 / std::cos(glm::radians(30.0));
  std::array<int, 5> in_shell{};
  for (size_t i = 0; i < lights.size(); ++i) {
    const glm::vec3 way = lights[i].position - position;
    const size_t shell = i % 5;
    const double expected_m = depth_m * 0.05 * double(1 << shell);
    EXPECT_NEAR(glm::length(way) / expected_m, 1.0, 2e-3);  // a texel at the cone's rim
    EXPECT_LT(glm::distance(glm::normalize(way), lights[i].normal), 1e-4f);
    EXPECT_GT(glm::dot(lights[i].normal, axis), -1e-4f);
    EXPECT_NEAR(lights[i].area_m2 / (2.0 * glm::pi<double>() * expected_m * expected_m / 1297.0), 1.0, 5e-3);
    EXPECT_EQ(lights[i].kind, VIRTUAL_LIGHT_LATTICE);
    ++in_shell[shell];
  }
  for (const int n : in_shell) EXPECT_EQ(n, 1297);
}

/// Printed: what the light sends, shared out evenly, less what the distance takes, times the shell's factor.
TEST_F(WaveLatticeTest, PrintedPower) {
  Scene scene = floor_of(0.5f);
  scene.lights = {spot_light({0, 1, 0}, {0, -1, 0}, 59.9f, 60.0f, 7.0f)};
  const double sent_w = 7.0 * 2.0 * glm::pi<double>() * (1.0 - std::cos(glm::radians(60.0)));
  WaveLatticeOptions options;
  options.power = WaveLatticeOptions::Power::printed;
  options.attenuation = 1.5f;
  options.factor[3] = 4.0f;
  const auto lights = lights_of(scene, options);
  ASSERT_EQ(lights.size(), 6485u);
  for (size_t i = 0; i < lights.size(); ++i) {
    const size_t shell = i % 5;
    const double expected = sent_w / 6485.0 * std::exp(-1.5 * 0.05 * double(1 << shell)) * (shell == 3 ? 4.0 : 1.0);
    EXPECT_NEAR(double(lights[i].flux.x) / expected, 1.0, 4e-3) << i;
  }
}

/// Conserving: all of the light that meets the floor is reflected once, and what meets it there lies in the last shell
/// before the floor. Of all bounces: in a closed box the series rho + rho^2 + ...
TEST_F(WaveLatticeTest, ConservingPower) {
  Scene scene = floor_of(0.25f);
  scene.lights = {spot_light({0, 1, 0}, {0, -1, 0}, 59.9f, 60.0f, 7.0f)};
  const double sent_w = 7.0 * 2.0 * glm::pi<double>() * (1.0 - std::cos(glm::radians(60.0)));
  const auto once = lights_of(scene, {}, 1);
  EXPECT_NEAR(sum_of_flux(once).x / (0.25 * sent_w), 1.0, 4e-3);
  for (size_t i = 0; i < once.size(); ++i) EXPECT_EQ(once[i].flux.x > 0.0f, i % 5 >= 3) << i;  // 2 m of 4 and more

  Scene box = colourful_room();
  for (Material& m : box.materials) m.base_color_factor = glm::vec4(0.5f, 0.5f, 0.5f, 1.0f);
  box.lights = {point_light({0.2f, 0.1f, -0.3f}, 3.0f)};
  const double lamp_w = 4.0 * glm::pi<double>() * 3.0;
  for (const auto& [bounces, share] : {std::pair<std::optional<int>, double>(1, 0.5), {2, 0.75}, {std::nullopt, 1.0}})
    EXPECT_NEAR(sum_of_flux(lights_of(box, {}, bounces)).x / (lamp_w * share), 1.0, 5e-3) << share;
  WaveLatticeOptions by_ray;
  by_ray.depth = WaveLatticeOptions::Depth::ray;
  EXPECT_NEAR(sum_of_flux(lights_of(box, by_ray, 1)).x / (lamp_w * 0.5), 1.0, 5e-3);
}

/// Each ray's own depth: all lights of a box lie inside it, at their parts of the way to the wall.
TEST_F(WaveLatticeTest, DepthByRay) {
  Scene scene = colourful_room();
  scene.lights = {point_light(kLamp, 1.0f)};
  WaveLatticeOptions options;
  options.depth = WaveLatticeOptions::Depth::ray;
  options.angle_deg = 10.0f;
  const auto lights = lights_of(scene, options);
  ASSERT_EQ(int(lights.size()), 5 * (36 * 17 + 2));
  for (size_t i = 0; i < lights.size(); ++i) {
    const glm::vec3 d = lights[i].normal;
    float to_wall = 1e9f;
    for (int a = 0; a < 3; ++a) {
      if (d[a] != 0.0f) to_wall = std::min(to_wall, ((d[a] > 0.0f ? kHalf[a] : -kHalf[a]) - kLamp[a]) / d[a]);
    }
    const float part = 0.05f * float(1 << (i % 5));
    EXPECT_NEAR(glm::distance(lights[i].position, kLamp), part * to_wall, 0.03f * to_wall) << i;
  }
}

TEST_F(WaveLatticeTest, SunsHaveAPlaneOfRays) {
  Scene scene = floor_of(0.5f);
  const glm::vec3 direction = glm::normalize(glm::vec3(0.3f, -1.0f, 0.1f));
  scene.lights = {sun_light(direction, 2.0f)};
  const auto lights = lights_of(scene, {}, 1);
  ASSERT_EQ(lights.size(), 36u * 36u * 5u);
  for (const VirtualLight& l : lights) EXPECT_LT(glm::distance(l.normal, direction), 1e-5f);
  const double met_w = 2.0 * 18.0 * 18.0 * double(-direction.y);
  EXPECT_NEAR(sum_of_flux(lights).x / (0.5 * met_w), 1.0, 5e-3);
}

/// Turned off by chance: those that are on stand for the others, the same ones every time, and over seeds the mean is
/// that of all.
TEST_F(WaveLatticeTest, SomeLightsStandForAll) {
  const Scene scene = load_scene(source_dir() / "data" / "cornell.glb");
  screen::FrameOptions o = picture_options("lattice", {32, 32}, screen::LightPart::indirect);
  o.of<WaveLatticeOptions>().angle_deg = 15.0f;
  o.of<screen::VisibilityChoice>().maps = screen::VisibilityChoice::Maps::none;
  o.of<screen::GatherOptions>().stride = 1;
  const Image all = render(context(), scene, scene.cameras.at(0), o).image;
  o.of<WaveLatticeOptions>().on_percent = 25.0f;
  glm::dvec3 mean_of_all(0.0), mean_of_some(0.0);
  double worst = 0.0;
  Image sum = all;
  for (glm::vec3& p : sum.pixels) p = glm::vec3(0.0f);
  constexpr int seeds = 64;
  for (int seed = 0; seed < seeds; ++seed) {
    o.of<WaveLatticeOptions>().seed = seed;
    const Image some = render(context(), scene, scene.cameras.at(0), o).image;
    for (size_t i = 0; i < some.pixels.size(); ++i) sum.pixels[i] += some.pixels[i] / float(seeds);
    if (seed == 5) {
      EXPECT_EQ(some.pixels, render(context(), scene, scene.cameras.at(0), o).image.pixels);
    }
  }
  for (size_t i = 0; i < all.pixels.size(); ++i) {
    mean_of_all += glm::dvec3(all.pixels[i]);
    mean_of_some += glm::dvec3(sum.pixels[i]);
    worst = std::max(worst,
                     double(glm::distance(all.pixels[i], sum.pixels[i])) / double(glm::length(all.pixels[i]) + 1e-6f));
  }
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(mean_of_some[c] / mean_of_all[c], 1.0, 0.01);
  EXPECT_LT(worst, 0.25);  // pixels beside a light
}

/// A light of the lattice on a floor, in front and behind, against the closed form.
TEST_F(WaveLatticeTest, HalfOfTheLightGoesBack) {
  Scene scene = floor_of(0.5f);
  const Camera camera =
      look_at_camera({0.0f, 3.0f, 0.1f}, {0.0f, -1.0f, 0.0f}, glm::radians(50.0f), scene.bounds_min, scene.bounds_max);
  const Seen seen(context(), scene, camera, {24, 24});
  for (const glm::vec3 normal : {glm::vec3(0, -1, 0), glm::vec3(0, 1, 0), glm::vec3(1, 0, 0)}) {
    const VirtualLight light = light_at({0.2f, 0.3f, -0.1f}, normal, glm::vec3(3.0f), 0.04f, VIRTUAL_LIGHT_LATTICE);
    screen::VirtualLightListGl list = list_of({light});
    list.in_the_air = true;
    Seen again(context(), scene, camera, {24, 24});
    const Gathered lit = gathered(again, list, every_pixel());
    for (size_t i = 0; i < lit.indirect.size(); ++i) {
      const glm::dvec3 d = glm::dvec3(light.position) - glm::dvec3(seen.position[i]);
      const double squared = glm::dot(d, d), half = glm::dot(glm::dvec3(normal), d) < 0.0 ? 1.0 : 0.5;
      const double e = 3.0 * half * d.y / std::sqrt(squared) / (3.0 * (glm::pi<double>() * squared + 0.04));
      EXPECT_NEAR(double(lit.indirect[i].x), 0.5 / glm::pi<double>() * e, 2e-4 * e) << i;
    }
  }
}

TEST_F(WaveLatticeTest, TooManyLightsAreRefused) {
  Scene scene = floor_of(0.5f);
  scene.lights = {spot_light({0, 1, 0}, {0, -1, 0}, 20, 30, 7.0f)};
  WaveLatticeOptions fine;
  fine.angle_deg = 1.0f;
  try {
    WaveLattice lattice(scene, fine, {});
    FAIL();
  } catch (const Error& e) {
    EXPECT_EQ(e.code(), ExitCode::over_limit);
    EXPECT_NE(std::string(e.what()).find("lattice.angle"), std::string::npos);
  }
}

}  // namespace
}  // namespace volgi::test
