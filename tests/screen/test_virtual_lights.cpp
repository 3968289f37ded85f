// Virtual lights: they carry the light that surfaces reflect or emit, lie on those surfaces, and move as lights do.
#include "screen/virtual_lights.h"

#include <cstring>
#include <numeric>

#include "core/error.h"
#include "core/visibility/embree_scene.h"
#include "core/visibility/light_flux.h"
#include "tests/screen/screen_scene.h"
#include "tests/support/gl_test.h"

namespace volgi::test {
namespace {

using screen::VirtualLightOptions;
using shared::VirtualLight;
using Sampling = VirtualLightOptions::Sampling;
constexpr Sampling kSamplings[] = {Sampling::halton, Sampling::flux};
constexpr screen::ReflectiveShadowMap::Resolution kResolution{200, 100, 200};  // no powers of two or four

/// A scene, its maps and its virtual lights, for one frame after another.
class Frames {
 public:
  Frames(const gl::Context& context, const Scene& scene, const VirtualLightOptions& options)
      : scene_(scene),
        timer_(context.software(), false),
        buffers_(scene),
        maps_(kResolution),
        lights_(scene, options) {}

  const screen::ReflectiveShadowMap& maps() const { return maps_; }
  const screen::VirtualLights& run() {
    maps_.run(buffers_, scene_, timer_);
    lights_.run(maps_, timer_);
    return lights_;
  }

 private:
  const Scene& scene_;
  gl::PassTimer timer_;
  gl::SceneBuffers buffers_;
  screen::ReflectiveShadowMap maps_;
  screen::VirtualLights lights_;
};

std::vector<VirtualLight> lights_of(const gl::Context& context, const Scene& scene, VirtualLightOptions options) {
  return Frames(context, scene, options).run().download().lights;
}

glm::dvec3 sum_of_flux(const std::vector<VirtualLight>& lights) {
  glm::dvec3 sum(0.0);
  for (const VirtualLight& l : lights) sum += glm::dvec3(l.flux);
  return sum;
}

double sum_of_area(const std::vector<VirtualLight>& lights) {
  double sum = 0.0;
  for (const VirtualLight& l : lights) sum += double(l.area_m2);
  return sum;
}

constexpr glm::vec3 kHalf(1.0f, 0.75f, 1.5f);
const glm::vec3 kLamp(0.3f, -0.2f, 0.7f);

/// A closed box of 2 x 1.5 x 3 m around the origin, every wall of another colour.
Scene colourful_room() {
  Scene scene;
  for (int face = 0; face < 6; ++face) {
    const int axis = face / 2;
    const int b = (axis + 1) % 3;
    const int c = (axis + 2) % 3;
    glm::vec3 albedo(0.2f, 0.5f, 0.8f);
    albedo = glm::vec3(albedo[axis], albedo[b], albedo[c]) * (face % 2 == 0 ? 1.0f : 0.6f);
    glm::vec3 corner = -kHalf, u(0.0f), v(0.0f);
    corner[axis] = face % 2 == 0 ? kHalf[axis] : -kHalf[axis];
    u[b] = 2.0f * kHalf[b];
    v[c] = 2.0f * kHalf[c];
    add_quad(scene, add_material(scene, albedo), corner, u, v);
  }
  update_bounds(scene);
  return scene;
}

double distance_to_wall(glm::vec3 p) {
  const glm::vec3 d = kHalf - glm::abs(p);
  return double(std::min({d.x, d.y, d.z}));
}

std::vector<Light> one_of_each() {
  std::vector<Light> lights = {spot_light(kLamp, {0.2f, -1.0f, -0.5f}, 12, 30, 2.5f),
                               spot_light(kLamp, {0.2f, 0.3f, -0.5f}, 40, 100, 2.5f), point_light(kLamp, 2.5f),
                               sun_light({0.4f, -1.0f, 0.3f}, 3.0f)};
  lights[2].range_m = 2.5f;
  return lights;
}

TEST(LightShares, FollowPowerAndSumToTheCount) {
  using screen::share_out;
  EXPECT_EQ(share_out({1, 2, 1}, 1024), (std::vector<int>{256, 512, 256}));
  EXPECT_EQ(share_out({1, 1, 1}, 1024), (std::vector<int>{342, 341, 341}));
  EXPECT_EQ(share_out({0, 1e9, 1e-3}, 100), (std::vector<int>{0, 99, 1}));
  EXPECT_EQ(share_out({3, 0, 1, 2}, 2), (std::vector<int>{1, 0, 0, 1}));
  EXPECT_EQ(share_out({3, 1}, 1), (std::vector<int>{1, 0}));
  EXPECT_EQ(share_out({0, 0}, 7), (std::vector<int>{0, 0}));
  EXPECT_EQ(share_out({}, 7), (std::vector<int>{}));
  std::vector<double> power;
  for (int i = 0; i < 37; ++i) power.push_back(std::pow(1.37, i % 11) - 1.0);
  const double total = std::accumulate(power.begin(), power.end(), 0.0);
  const std::vector<int> share = share_out(power, 4000);
  EXPECT_EQ(std::accumulate(share.begin(), share.end(), 0), 4000);
  for (size_t i = 0; i < power.size(); ++i) EXPECT_NEAR(share[i], 4000 * power[i] / total, 1.0);
}

TEST(LightShares, PowerOfSpotsIsTheIntegralOfTheirFalloff) {
  for (const glm::vec2 cone_deg : {glm::vec2(10, 40), glm::vec2(0, 90), glm::vec2(44.99, 45), glm::vec2(0, 1)}) {
    const Light light = spot_light({}, {0, -1, 0}, cone_deg.x, cone_deg.y, 2.0f);
    const double outer = 1.0 - std::cos(double(light.outer_cone_rad));
    const double ramp = std::max(0.001, outer - 1.0 + std::cos(double(light.inner_cone_rad)));
    double sum = 0.0;
    constexpr int steps = 100000;
    for (int i = 0; i < steps; ++i) sum += std::pow(std::min(1.0, (i + 0.5) / steps * outer / ramp), 2.0);
    const double brightness = 2.0 * (0.2126 + 0.8 * 0.7152 + 0.6 * 0.0722);
    const double expected = 2.0 * glm::pi<double>() * outer * sum / steps * brightness;
    EXPECT_NEAR(screen::power_luminance(light, {}, {}) / expected, 1.0, 1e-5);
  }
  const Light sun = sun_light({0, -1, 0}, 1.0f);
  EXPECT_NEAR(screen::power_luminance(sun, -kHalf, kHalf) / screen::power_luminance(sun, -kHalf, 3.0f * kHalf), 0.25,
              1e-5);
}

using VirtualLights = GlTest;

TEST_F(VirtualLights, CarryWhatRaysSayIsReflected) {
  Scene scene = colourful_room();
  for (const Light& light : one_of_each()) {
    scene.lights = {light};
    glm::dvec3 expected(0.0);
    for (const FluxSample& s : light_flux(EmbreeScene(scene), 256)) expected += glm::dvec3(s.flux);
    for (const Sampling sampling : kSamplings) {
      const auto lights = lights_of(context(), scene, {4096, {}, sampling});
      const glm::dvec3 ratio = sum_of_flux(lights) / expected;
      ASSERT_EQ(lights.size(), 4096u);
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(ratio[c], 1.0, 0.01) << int(light.type) << ' ' << int(sampling);
      RecordProperty("ratio", std::to_string(ratio.g));
    }
  }
}

TEST_F(VirtualLights, LieOnWallsAndFaceTheLight) {
  Scene scene = colourful_room();
  for (const Light& light : one_of_each()) {
    if (light.type == Light::Type::directional) continue;  // lights the box from outside
    scene.lights = {light};
    for (const Sampling sampling : kSamplings) {
      for (const VirtualLight& l : lights_of(context(), scene, {2048, {}, sampling})) {
        EXPECT_NEAR(distance_to_wall(l.position), 0.0, 3e-5);
        EXPECT_NEAR(glm::length(l.normal), 1.0f, 1e-5f);
        EXPECT_NEAR(glm::length(glm::max(glm::abs(l.normal.x), glm::max(glm::abs(l.normal.y), glm::abs(l.normal.z)))),
                    1.0f, 1e-4f);
        EXPECT_GT(glm::dot(l.normal, light.position - l.position), 0.0f);
        EXPECT_EQ(l.kind, VIRTUAL_LIGHT_REFLECTED);
        EXPECT_EQ(l.source, 0);
      }
    }
  }
}

TEST_F(VirtualLights, StandForTheLitArea) {
  Scene scene = colourful_room();
  scene.lights = {point_light(kLamp, 1.0f)};
  const double walls = 2.0 * (2.0 * 1.5 + 1.5 * 3.0 + 3.0 * 2.0);
  for (const Sampling sampling : kSamplings) {
    EXPECT_NEAR(sum_of_area(lights_of(context(), scene, {4096, {}, sampling})) / walls, 1.0, 0.02);
  }
  scene.lights = {sun_light({0.4f, -1.0f, 0.3f}, 1.0f)};
  const double outside = 0.5 * walls;  // one of each pair; and the empty rest of the rectangle stands for none
  for (const Sampling sampling : kSamplings) {
    EXPECT_NEAR(sum_of_area(lights_of(context(), scene, {4096, {}, sampling})) / outside, 1.0, 0.02);
  }
}

/// Largest move of a virtual light in units of what its ray's end should move by.
double largest_move(const std::vector<VirtualLight>& before, const std::vector<VirtualLight>& after, glm::vec3 lamp,
                    double shift_m, double turn_rad) {
  double largest = 0.0;
  for (size_t i = 0; i < before.size(); ++i) {
    const auto end = [&](const VirtualLight& l) {
      const glm::vec3 d = lamp - l.position;
      const double r = double(glm::length(d));
      return (shift_m + turn_rad * r) * r / double(std::max(glm::dot(d, l.normal), 1e-6f));
    };
    const double expected = std::max(end(before[i]), end(after[i])) + 2e-4;
    largest = std::max(largest, double(glm::distance(before[i].position, after[i].position)) / expected);
  }
  return largest;
}

TEST_F(VirtualLights, MoveAsTheirLightDoes) {
  Scene scene = colourful_room();
  for (Light light : one_of_each()) {
    if (light.type == Light::Type::directional) continue;
    scene.lights = {light};
    Frames frames(context(), scene, {1024, {}, Sampling::halton});
    const auto before = frames.run().download().lights;
    scene.lights[0].position += glm::vec3(0.002f, -0.001f, 0.002f);  // a thousandth of the box
    EXPECT_LT(largest_move(before, frames.run().download().lights, light.position, 0.003, 0.0), 1.1);
    if (light.type != Light::Type::spot) continue;
    const glm::vec3 turned = glm::normalize(light.direction + 0.001f * glm::normalize(glm::vec3(1, -0.3f, 0.2f)));
    scene.lights = {light};
    scene.lights[0].direction = turned;
    const double turn = double(glm::distance(turned, light.direction));
    // The shortest arc also rolls about the axis, by less than tan of half the angle to -Y times the turn.
    EXPECT_LT(largest_move(before, frames.run().download().lights, light.position, 0.0, 2.0 * turn), 1.1);
  }
}

TEST_F(VirtualLights, OfTwoLightsAreThoseOfEach) {
  Scene scene = colourful_room();
  const std::vector<Light> lights = one_of_each();
  for (const Sampling sampling : kSamplings) {
    const VirtualLightOptions options{1, 100, sampling};
    scene.lights = lights;
    const auto together = lights_of(context(), scene, options);
    ASSERT_EQ(together.size(), 400u);
    for (size_t k = 0; k < lights.size(); ++k) {
      scene.lights = {lights[k]};
      auto alone = lights_of(context(), scene, options);
      ASSERT_EQ(alone.size(), 100u);
      for (VirtualLight& l : alone) l.source = int(k);
      EXPECT_EQ(std::memcmp(alone.data(), &together[100 * k], 100 * sizeof(VirtualLight)), 0);
    }
  }
}

bool all_zero(const std::vector<unsigned char>& bytes) {
  return std::all_of(bytes.begin(), bytes.end(), [](unsigned char b) { return b == 0; });
}

TEST_F(VirtualLights, LeaveNothingBehindAndRepeat) {
  Scene scene = colourful_room();
  scene.lights = one_of_each();
  for (const Sampling sampling : kSamplings) {
    Frames frames(context(), scene, {1500, {}, sampling});
    scene.lights = one_of_each();
    const auto first = frames.run().download().lights;
    scene.lights.resize(1);
    scene.lights.push_back(point_light({0, 0, 0}, 0.0f));
    const screen::VirtualLights& made = frames.run();
    EXPECT_EQ(made.reflected(), 1500);
    scene.lights.erase(scene.lights.begin());
    EXPECT_EQ(frames.run().count(), 0);
    ASSERT_EQ(made.buffer().bytes() % (VIRTUAL_LIGHTS_A_BLOCK * sizeof(VirtualLight)), 0u);
    EXPECT_TRUE(all_zero(made.buffer().download<unsigned char>(made.buffer().bytes())));
    scene.lights = one_of_each();
    const auto again = frames.run().download().lights;
    ASSERT_EQ(again.size(), first.size());
    EXPECT_EQ(std::memcmp(again.data(), first.data(), first.size() * sizeof(VirtualLight)), 0);
    const size_t used = first.size() * sizeof(VirtualLight);
    EXPECT_GE(made.buffer().bytes(), 2 * VIRTUAL_LIGHTS_A_BLOCK * sizeof(VirtualLight));
    EXPECT_TRUE(all_zero(made.buffer().download<unsigned char>(made.buffer().bytes() - used, used)));
  }
}

// The same object, frame after frame, makes what a new one makes of the scene as it is then.
TEST_F(VirtualLights, ForgetEarlierFrames) {
  Scene scene = colourful_room();
  const int lamp = add_material(scene, glm::vec3(0.0f));
  scene.materials[size_t(lamp)].emissive_radiance = glm::vec3(4, 3, 2);
  add_quad(scene, lamp, {-0.25f, 0.7f, -0.25f}, {0.5f, 0, 0}, {0, 0, 0.5f});
  const std::vector<Light> all = one_of_each();
  Light narrow = all[0];
  narrow.outer_cone_rad *= 0.8f;
  const std::vector<std::vector<Light>> frames_of_lights = {
      {all[0], all[2]}, {narrow, all[2]}, {all[2], narrow}, {all[3], narrow}, {all[3]}, {}, all};
  for (const Sampling sampling : kSamplings) {
    const VirtualLightOptions options{1, 150, sampling};
    Frames frames(context(), scene, options);
    for (const std::vector<Light>& lights : frames_of_lights) {
      scene.lights = lights;
      const screen::VirtualLights& made = frames.run();
      Frames fresh(context(), scene, options);
      const gl::Buffer& expected = fresh.run().buffer();
      ASSERT_EQ(made.buffer().bytes(), expected.bytes());
      EXPECT_EQ(made.buffer().download<unsigned char>(expected.bytes()),
                expected.download<unsigned char>(expected.bytes()));
    }
  }
}

TEST_F(VirtualLights, SceneWithoutLights) {
  const Scene scene = colourful_room();
  for (const Sampling sampling : kSamplings) {
    Frames frames(context(), scene, {64, {}, sampling});
    EXPECT_EQ(frames.run().count(), 0);
    EXPECT_TRUE(frames.run().download().lights.empty());
  }
  const Scene empty{};
  EXPECT_THROW(lights_of(context(), empty, {0, {}, Sampling::halton}), Error);
  EXPECT_THROW(lights_of(context(), empty, {1 << 20, {}, Sampling::halton}), Error);
}

TEST_F(VirtualLights, ThinSpots) {
  Scene scene = colourful_room();
  const glm::vec3 axis = glm::normalize(glm::vec3(0.3f, 0.9f, 0.1f));
  scene.lights = {spot_light(kLamp, axis, 0.1f, 0.2f, 1e6f)};
  glm::dvec3 expected(0.0);
  for (const FluxSample& s : light_flux(EmbreeScene(scene), 256)) expected += glm::dvec3(s.flux);
  for (const Sampling sampling : kSamplings) {
    const auto lights = lights_of(context(), scene, {1024, {}, sampling});
    const glm::dvec3 ratio = sum_of_flux(lights) / expected;
    EXPECT_NEAR(ratio.r, 1.0, 0.03) << int(sampling);
    for (const VirtualLight& l : lights) {
      EXPECT_NEAR(distance_to_wall(l.position), 0.0, 3e-5);
      const double sine = double(glm::length(glm::cross(axis, glm::normalize(l.position - kLamp))));
      EXPECT_LT(sine, std::sin(glm::radians(0.2)) * 1.03);
    }
  }
}

TEST_F(VirtualLights, SpotsMayPointAnywhere) {
  Scene scene = colourful_room();
  for (const glm::vec3 axis : {glm::vec3(0, 1, 0), glm::vec3(0, -1, 0), glm::vec3(1e-5f, 1, -1e-5f),
                               glm::vec3(-1e-20f, 1, 0), glm::vec3(0, 0, 1), glm::vec3(-1, 0, 0)}) {
    scene.lights = {spot_light(kLamp, axis, 0, 30, 1.0f)};
    glm::dvec3 mean(0.0);
    for (const VirtualLight& l : lights_of(context(), scene, {512, {}, Sampling::halton})) {
      const glm::vec3 d = glm::normalize(l.position - kLamp);
      EXPECT_GT(glm::dot(d, glm::normalize(axis)), std::cos(glm::radians(30.01f)));
      mean += glm::dvec3(d) / 512.0;
    }
    EXPECT_LT(glm::distance(glm::normalize(mean), glm::dvec3(glm::normalize(axis))), 3e-3);
  }
}

TEST_F(VirtualLights, NothingThereMeansNoFlux) {
  Scene scene;
  add_quad(scene, add_material(scene, glm::vec3(0.7f)), {-1, 0, -1}, {0, 0, 2}, {2, 0, 0});
  update_bounds(scene);
  scene.lights = {point_light({0, 1, 0}, 1.0f), sun_light({0, 1, 0.2f}, 1.0f),
                  spot_light({0, 1, 0}, {0, 1, 0}, 0, 20, 1)};
  for (const Sampling sampling : kSamplings) {
    double lit = 0.0;
    for (const VirtualLight& l : lights_of(context(), scene, {1, 300, sampling})) {
      EXPECT_TRUE(std::isfinite(glm::dot(l.position, l.position)) && std::isfinite(l.area_m2));
      EXPECT_NEAR(glm::length(l.normal), 1.0f, 1e-5f);
      EXPECT_TRUE(l.flux.r >= 0.0f && l.source < 2 + (l.flux == glm::vec3(0.0f) ? 1 : 0));
      if (l.source == 0) lit += double(l.flux.r);
    }
    // A square of 2 m seen from 1 m above its middle fills a sixth of the sphere.
    EXPECT_NEAR(lit / (0.7 * 4.0 * glm::pi<double>() / 6.0), 1.0, 0.03);
  }
}

/// Luminance that the texels of a map reflect: textures read back, the rest in C++.
double luminance_of_texels(const screen::ReflectiveShadowMap& maps) {
  const shared::ReflectiveShadowLight& l = maps.lights()[0];
  const std::vector<float> depth = maps.depth(0).download(1);
  const std::vector<float> albedo = maps.albedo(0).download(4);
  double sum = 0.0;
  for (size_t i = 0; i < depth.size(); ++i) {
    const int x = int(i) % l.resolution;
    const int y = int(i) / l.resolution % l.resolution;
    if (depth[i] <= 0.0f || !shared::rsm_texel_counts(l.layer_count, l.resolution, x, y)) continue;
    const auto& view = maps.layers()[i / (size_t(l.resolution) * size_t(l.resolution))];
    const glm::vec2 uv = (glm::vec2(x, y) + 0.5f) * (2.0f / float(l.resolution)) - 1.0f;
    const float z = shared::rsm_z_from_depth(view, depth[i]);
    const glm::vec3 d = shared::rsm_position_from_uvz(view, {uv, z}) - l.light.position;
    float share = shared::rsm_texel_measure(view, l.resolution, uv.x, uv.y);
    if (l.light.type != LIGHT_DIRECTIONAL) share *= shared::range_window(l.light, glm::length(d));
    if (l.light.type == LIGHT_SPOT) share *= shared::spot_falloff(l.light, glm::normalize(d));
    const glm::dvec3 flux =
        glm::dvec3(l.light.intensity) * double(share) * glm::dvec3(albedo[4 * i], albedo[4 * i + 1], albedo[4 * i + 2]);
    sum += glm::dot(flux, glm::dvec3(0.2126, 0.7152, 0.0722));
  }
  return sum;
}

// Sampled by flux, all lights are equally bright and sum to the light of all texels, at any number of them.
TEST_F(VirtualLights, ByFluxShareAllTexelsEqually) {
  Scene scene = stage();
  for (Light light : one_of_each()) {
    light.position = {0.9f, 2.5f, 2.2f};
    scene.lights = {light};
    Frames frames(context(), scene, {50, {}, Sampling::flux});
    const auto lights = frames.run().download().lights;
    const double expected = luminance_of_texels(frames.maps()) / 50.0;
    for (const VirtualLight& l : lights) {
      EXPECT_NEAR(glm::dot(glm::dvec3(l.flux), glm::dvec3(0.2126, 0.7152, 0.0722)) / expected, 1.0, 2e-5);
    }
  }
}

// Among other surfaces, too, lights lie where rays from the lamp end; at silhouettes a texel may decide otherwise.
TEST_F(VirtualLights, LieWhereRaysEnd) {
  Scene scene = stage();
  add_sphere(scene, 1, {-1.0f, 0.5f, 0.9f}, 0.4f, 24);
  const glm::vec3 lamp(0.9f, 2.5f, 2.2f);
  scene.lights = {spot_light(lamp, {-0.4f, -0.8f, -0.8f}, 20, 40, 5.0f)};
  const EmbreeScene embree(scene);
  for (const Sampling sampling : kSamplings) {
    int off = 0;
    const auto lights = lights_of(context(), scene, {2048, {}, sampling});
    for (const VirtualLight& l : lights) {
      RayHit hit;
      const glm::vec3 d = l.position - lamp;
      const float r = glm::length(d);
      if (l.flux == glm::vec3(0.0f)) continue;
      if (!embree.intersect(lamp, d / r, 100.0f, 0, hit) || std::abs(hit.distance - r) > 2e-3f) ++off;
    }
    RecordProperty("off", std::to_string(off));
    EXPECT_LT(off, 2048 / 50) << int(sampling);
  }
}

TEST_F(VirtualLights, EmittersComeLastWithTheirShare) {
  Scene scene = colourful_room();
  const int lamp = add_material(scene, glm::vec3(0.0f));
  scene.materials[size_t(lamp)].emissive_radiance = glm::vec3(4, 3, 2);
  scene.materials[size_t(lamp)].double_sided = true;
  add_quad(scene, lamp, {-0.25f, 0.7f, -0.25f}, {0.5f, 0, 0}, {0, 0, 0.5f});
  const glm::dvec3 emitted = glm::pi<double>() * 0.25 * 2.0 * glm::dvec3(4, 3, 2);
  scene.lights = {point_light(kLamp, 1.0f)};
  Frames frames(context(), scene, {1000, {}, Sampling::halton});
  const screen::VirtualLights& made = frames.run();
  const auto lights = made.download().lights;
  const double sent = 4.0 * glm::pi<double>() * (0.2126 + 0.8 * 0.7152 + 0.6 * 0.0722);
  const double share = emitted.r / 4.0 * (4 * 0.2126 + 3 * 0.7152 + 2 * 0.0722);
  EXPECT_EQ(made.count(), 1000);
  EXPECT_NEAR(made.emitted(), 1000.0 * share / (sent + share), 1.0);
  glm::dvec3 sum(0.0);
  for (size_t i = 0; i < lights.size(); ++i) {
    const bool emits = int(i) >= made.reflected();
    EXPECT_EQ(lights[i].kind, emits ? VIRTUAL_LIGHT_EMITTED : VIRTUAL_LIGHT_REFLECTED);
    EXPECT_EQ(lights[i].source, emits ? -1 : 0);
    if (emits) sum += glm::dvec3(lights[i].flux);
  }
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(sum[c] / emitted[c], 1.0, 1e-5);
  scene.lights.clear();
  EXPECT_EQ(frames.run().emitted(), 1000);
  EXPECT_EQ(made.reflected(), 0);
}

}  // namespace
}  // namespace volgi::test
