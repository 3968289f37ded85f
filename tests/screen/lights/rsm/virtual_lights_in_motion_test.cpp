// Virtual lights from frame to frame: they move as lights do, depend on their own light alone, and nothing stays
// behind.
#include <algorithm>
#include <cstring>

#include "tests/screen/virtual_light_scenes.h"
#include "tests/support/gl_test.h"

namespace volgi::test {
namespace {

using VirtualLightsInMotion = GlTest;

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

TEST_F(VirtualLightsInMotion, MoveAsTheirLightDoes) {
  Scene scene = colourful_room();
  for (const Light& light : one_of_each()) {
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

TEST_F(VirtualLightsInMotion, OfTwoLightsAreThoseOfEach) {
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
      EXPECT_EQ(std::memcmp(alone.data(), &together[100 * k], alone.size() * sizeof(VirtualLight)), 0);
    }
  }
}

bool all_zero(const std::vector<unsigned char>& bytes) {
  return std::all_of(bytes.begin(), bytes.end(), [](unsigned char b) { return b == 0; });
}

TEST_F(VirtualLightsInMotion, LeaveNothingBehindAndRepeat) {
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
    ASSERT_EQ(made.buffer().bytes() % (VIRTUAL_LIGHTS_PER_BLOCK * sizeof(VirtualLight)), 0u);
    EXPECT_TRUE(all_zero(made.buffer().download<unsigned char>(made.buffer().bytes())));
    scene.lights = one_of_each();
    const auto again = frames.run().download().lights;
    ASSERT_EQ(again.size(), first.size());
    EXPECT_EQ(std::memcmp(again.data(), first.data(), first.size() * sizeof(VirtualLight)), 0);
    const size_t used = first.size() * sizeof(VirtualLight);
    EXPECT_GE(made.buffer().bytes(), 2 * VIRTUAL_LIGHTS_PER_BLOCK * sizeof(VirtualLight));
    EXPECT_TRUE(all_zero(made.buffer().download<unsigned char>(made.buffer().bytes() - used, used)));
  }
}

// The same object, frame after frame, makes what a new one makes of the scene as it is then.
TEST_F(VirtualLightsInMotion, ForgetEarlierFrames) {
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

}  // namespace
}  // namespace volgi::test
