// GL does not require that signed normalised textures can be rendered to: where they cannot, floats hold the same
// normals, to the half step of 1/32767 that 16 bits round by.
#include "screen/base/gbuffer.h"
#include "screen/base/reflective_shadow_map.h"
#include "tests/screen/screen_scene.h"
#include "tests/support/gl_test.h"

namespace volgi::test {
namespace {

using NormalFormat = GlTest;

constexpr GLenum unrenderable = GL_COMPRESSED_RED_RGTC1;

void expect_alike(const gl::Texture& snorm, const gl::Texture& other, int channels) {
  const std::vector<float> a = snorm.download(channels), b = other.download(channels);
  ASSERT_EQ(a.size(), b.size());
  float most = 0.0f;
  for (size_t i = 0; i < a.size(); ++i) most = std::max(most, std::abs(a[i] - b[i]));
  EXPECT_GT(most, 0.0f) << "they are the same format";
  EXPECT_LE(most, 0.5f / 32767.0f + 1e-7f);
}

TEST_F(NormalFormat, GBufferFallsBackToFloats) {
  const Scene scene = stage();
  const gl::SceneBuffers buffers(scene);
  gl::PassTimer timer(context().software(), false);
  screen::GBuffer usual(glm::ivec2(48)), fallback(glm::ivec2(48), unrenderable);
  for (screen::GBuffer* g : {&usual, &fallback}) g->run(buffers, stage_camera(scene), timer);
  EXPECT_EQ(fallback.normals().format(), GLenum(GL_RGBA32F));
  expect_alike(usual.normals(), fallback.normals(), 4);
}

TEST_F(NormalFormat, ReflectiveShadowMapFallsBackToFloats) {
  Scene scene = stage();
  scene.lights = {spot_light({0.0f, 2.5f, 1.5f}, {0.0f, -1.0f, -0.5f}, 20.0f, 40.0f, 30.0f)};
  const gl::SceneBuffers buffers(scene);
  gl::PassTimer timer(context().software(), false);
  const screen::ReflectiveShadowMap::Resolution small{64, 32, 64};
  screen::ReflectiveShadowMap usual(small), fallback(small, unrenderable);
  for (screen::ReflectiveShadowMap* m : {&usual, &fallback}) m->run(buffers, scene, timer);
  EXPECT_EQ(fallback.normal(0).format(), GLenum(GL_RG32F));
  EXPECT_EQ(fallback.bytes() - usual.bytes(), 4u * 64 * 64);
  expect_alike(usual.normal(0), fallback.normal(0), 2);
}

}  // namespace
}  // namespace volgi::test
