// Virtual lights: they carry the light that surfaces reflect or emit, and lie on those surfaces.
#include <cmath>

#include "core/error.h"
#include "core/visibility/embree_scene.h"
#include "core/visibility/light_flux.h"
#include "tests/screen/virtual_light_scenes.h"
#include "tests/support/gl_test.h"

namespace volgi::test {
namespace {

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
        const glm::vec3 n = glm::abs(l.normal);
        EXPECT_NEAR(std::max({n.x, n.y, n.z}), 1.0f, 1e-4f);
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
