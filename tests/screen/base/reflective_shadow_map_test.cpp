// What shaders read from reflective shadow maps: all the light of each lamp, each part of it once, where it lands.
#include <cmath>

#include "core/gl/shader_source.h"
#include "tests/screen/screen_scene.h"
#include "tests/support/gl_test.h"

namespace volgi::test {
namespace {

struct Texel {
  glm::vec4 position;  // w = 1: counts
  glm::vec4 normal;
  glm::vec4 flux;
  glm::vec4 albedo;
};

constexpr const char* read_texels = R"(
layout(local_size_x = 8, local_size_y = 8) in;
uniform int light;
struct Texel { vec4 position; vec4 normal; vec4 flux; vec4 albedo; };
layout(std430, binding = 0) writeonly buffer Texels { Texel texels[]; };
void main() {
  ivec3 at = ivec3(gl_GlobalInvocationID);
  int resolution = rsm_lights[light].resolution;
  if (at.x >= resolution || at.y >= resolution) return;
  vec3 position, normal, flux, albedo;
  bool counts = rsm_texel(light, at.z, at.xy, position, normal, flux, albedo);
  Texel none = Texel(vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0));
  texels[(at.z * resolution + at.y) * resolution + at.x] =
      counts ? Texel(vec4(position, 1.0), vec4(normal, 0.0), vec4(flux, 0.0), vec4(albedo, 0.0)) : none;
}
)";

GLuint test_program() {
  const std::string source =
      "#version 450 core\n" + gl::expand_shader("shared/reflective_shadow_map.glsl") + "#line 1 99\n" + read_texels;
  const char* text = source.c_str();
  return glCreateShaderProgramv(GL_COMPUTE_SHADER, 1, &text);
}

std::vector<Texel> texels_of(const gl::Context& context, const Scene& scene,
                             screen::ReflectiveShadowMap::Resolution resolution, int light) {
  gl::PassTimer timer(context.software(), false);
  const gl::SceneBuffers buffers(scene);
  screen::ReflectiveShadowMap maps(resolution);
  maps.run(buffers, scene, timer);
  const int side = maps.resolution(light);
  const int layers = maps.layer_count(light);
  const size_t count = size_t(side) * size_t(side) * size_t(layers);
  const gl::Buffer out(count * sizeof(Texel));
  const GLuint program = test_program();
  glUseProgram(program);
  glUniform1i(glGetUniformLocation(program, "light"), light);
  maps.bind(light);
  out.bind_storage(0);
  gl::dispatch({side, side, layers}, {8, 8, 1});
  std::vector<Texel> texels = out.download<Texel>(count);
  glDeleteProgram(program);
  return texels;
}

/// A closed box of 2 x 1.5 x 3 m around the origin.
Scene closed_room() {
  Scene scene;
  add_box(scene, add_material(scene, {0.25f, 0.5f, 0.75f}), {0, -0.75f, 0}, {2, 1.5f, 3}, 0.0f);
  update_bounds(scene);
  return scene;
}

/// Checks that every texel lies on a wall of closed_room() and looks at the light; returns the sum of the flux.
double check_and_sum(const std::vector<Texel>& texels, glm::vec3 light) {
  double sum = 0.0;
  for (const Texel& t : texels) {
    if (t.position.w == 0.0f) continue;
    const glm::vec3 p(t.position);
    const glm::vec3 outside = glm::abs(p) / glm::vec3(1.0f, 0.75f, 1.5f);
    EXPECT_NEAR(std::max({outside.x, outside.y, outside.z}), 1.0f, 2e-4f);
    EXPECT_GT(glm::dot(glm::vec3(t.normal), light - p), 0.0f);
    EXPECT_NEAR(t.albedo.g, 0.5f, 1e-4f);
    sum += double(t.flux.r);
  }
  return sum;
}

using ReflectiveShadowMap = GlTest;

TEST_F(ReflectiveShadowMap, PointLightSendsAllItsPower) {
  Scene scene = closed_room();
  const glm::vec3 at(0.3f, -0.2f, 0.7f);
  scene.lights = {sun_light({0, -1, 0}, 1.0f), point_light(at, 2.5f)};  // the second: offsets count
  const auto texels = texels_of(context(), scene, {64, 64, 64}, 1);
  EXPECT_NEAR(check_and_sum(texels, at) / (4.0 * glm::pi<double>() * 2.5), 1.0, 5e-4);
}

TEST_F(ReflectiveShadowMap, SpotsSendTheirCone) {
  const glm::vec3 at(0.3f, -0.2f, 0.7f);
  for (const float outer_deg : {20.0f, 55.0f, 75.0f}) {
    Scene scene = closed_room();
    const float inner_deg = 0.5f * outer_deg;
    scene.lights = {spot_light(at, {0.2f, -1.0f, -0.5f}, inner_deg, outer_deg, 2.5f)};
    // 2 pi times the integral of falloff over the cosine: 1 inside the inner cone, a third of the ring's width outside.
    const double inner = std::cos(glm::radians(double(inner_deg)));
    const double outer = std::cos(glm::radians(double(outer_deg)));
    const double expected = 2.0 * glm::pi<double>() * 2.5 * ((1.0 - inner) + (inner - outer) / 3.0);
    const auto texels = texels_of(context(), scene, {64, 64, 64}, 0);
    EXPECT_EQ(texels.size(), outer_deg > 60.0f ? 6u * 64u * 64u : 64u * 64u);
    EXPECT_NEAR(check_and_sum(texels, at) / expected, 1.0, 3e-3) << outer_deg;
  }
}

TEST_F(ReflectiveShadowMap, RangeDimsTheFlux) {
  Scene scene = closed_room();
  const glm::vec3 at(0.0f);
  scene.lights = {point_light(at, 1.0f)};
  scene.lights[0].range_m = 0.5f;  // ends before the walls
  EXPECT_EQ(check_and_sum(texels_of(context(), scene, {64, 64, 64}, 0), at), 0.0);
}

TEST_F(ReflectiveShadowMap, SunSendsItsIrradianceThroughTheShadowOfTheScene) {
  Scene scene = closed_room();
  const glm::vec3 direction = glm::normalize(glm::vec3(0.4f, -1.0f, 0.3f));
  scene.lights = {sun_light(direction, 3.0f)};
  const glm::vec3 shown = glm::abs(direction) * glm::vec3(1.5f * 3.0f, 2.0f * 3.0f, 2.0f * 1.5f);
  const auto texels = texels_of(context(), scene, {64, 64, 256}, 0);
  EXPECT_NEAR(check_and_sum(texels, -100.0f * direction) / (3.0 * double(shown.x + shown.y + shown.z)), 1.0, 5e-3);
}

// C++ and GLSL share these formulas; this holds them to what they mean.
TEST(ReflectiveShadowLayers, PositionsAndClipCoordinatesAgree) {
  const glm::vec3 low(-1, 0, -2);
  const glm::vec3 high(3, 2, 2);
  for (const Light& light : {sun_light({-0.6f, -1.0f, -0.4f}, 1.0f), point_light({0.5f, 1.0f, 0.25f}, 1.0f),
                             spot_light({0.5f, 1.0f, 0.25f}, {0.3f, -1, 0.1f}, 10, 50, 1.0f)}) {
    for (const auto& layer : reflective_shadow_layers(light, 128, low, high)) {
      const glm::vec3 uvz(0.3f, -0.7f, 1.25f);
      const glm::vec3 p = shared::rsm_position_from_uvz(layer, uvz);
      const glm::vec3 back = shared::rsm_uvz_from_position(layer, p);
      const glm::vec4 clip = layer.clip_from_world * glm::vec4(p, 1.0f);
      for (int i = 0; i < 3; ++i) EXPECT_NEAR(back[i], uvz[i], 1e-5f);
      EXPECT_NEAR(clip.x / clip.w, uvz.x, 1e-5f);
      EXPECT_NEAR(clip.y / clip.w, uvz.y, 1e-5f);
      EXPECT_NEAR(shared::rsm_z_from_depth(layer, clip.z / clip.w), uvz.z, 1e-5f);
    }
  }
}

TEST(ReflectiveShadowLayers, DirectionsFindTheFaceThatLooksTheirWay) {
  const auto faces = reflective_shadow_layers(point_light({1, 2, 3}, 1.0f), 64, {0, 0, 0}, {4, 4, 4});
  ASSERT_EQ(faces.size(), 6u);
  const float edge = 1.0f - 4.0f / 64.0f;  // the face proper ends two texels before the layer
  for (const glm::vec3 d : {glm::vec3(1, 0.9f, -0.99f), glm::vec3(-2, 1, 1), glm::vec3(0.5f, 1, 0.5f),
                            glm::vec3(0, -1, 0.9f), glm::vec3(0.7f, 0.7f, 1), glm::vec3(0.1f, -0.2f, -0.3f)}) {
    const auto& face = faces[size_t(shared::rsm_layer_of_direction(6, d))];
    const glm::vec3 uvz = shared::rsm_uvz_from_position(face, glm::vec3(1, 2, 3) + d);
    EXPECT_GT(uvz.z, 0.0f);
    EXPECT_LE(std::max(std::abs(uvz.x), std::abs(uvz.y)), edge + 1e-6f);
  }
}

// A sun over a scene without extent, or lights in an empty one, must still make finite matrices.
TEST(ReflectiveShadowLayers, FlatAndEmptyScenes) {
  for (const glm::vec3 high : {glm::vec3(0.0f), glm::vec3(4, 0, 4)}) {
    for (const Light& light : {sun_light({0, 0, 1}, 1.0f), sun_light({0, -1, 0}, 1.0f), point_light({0, 0, 0}, 1.0f)}) {
      for (const auto& layer : reflective_shadow_layers(light, 64, glm::vec3(0.0f), high)) {
        for (int i = 0; i < 16; ++i) EXPECT_TRUE(std::isfinite(layer.clip_from_world[i / 4][i % 4]));
      }
    }
  }
}

}  // namespace
}  // namespace volgi::test
