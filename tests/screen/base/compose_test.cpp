// The picture is the sum of its layers, black where there is no geometry.
#include "screen/base/compose.h"

#include <array>
#include <vector>

#include "core/error.h"
#include "tests/screen/screen_scene.h"
#include "tests/support/gl_test.h"

namespace volgi::test {
namespace {

using Compose = GlTest;

TEST_F(Compose, AddsLayers) {
  constexpr glm::ivec2 size(16);
  const Scene scene = stage();
  gl::PassTimer timer(context().software(), false);
  const gl::SceneBuffers buffers(scene);
  screen::GBuffer gbuffer(size);
  gbuffer.run(buffers, stage_camera(scene), timer);
  std::array<gl::Texture, 3> layers;
  for (size_t i = 0; i < 3; ++i) {
    layers[i] = gl::Texture::make_2d(GL_RGBA32F, size.x, size.y);
    layers[i].clear({float(1 << i), 0.0f, 0.0f, 1.0f});
  }
  screen::Compose compose(size);
  const auto sum = [&](std::vector<const gl::Texture*> shown) {
    compose.run(gbuffer, shown, nullptr, timer);
    return screen::image_from_texture(compose.radiance());
  };
  EXPECT_EQ(sum({&layers[0], &layers[1]}).at(8, 12).r, 3.0f);
  EXPECT_EQ(sum({&layers[2]}).at(8, 12).r, 4.0f);
  EXPECT_EQ(sum({&layers[0], &layers[1], &layers[2]}).at(8, 12).r, 7.0f);
  EXPECT_EQ(sum({&layers[0]}).at(0, 0), glm::vec3(0.0f));  // background
  EXPECT_EQ(sum({}).at(8, 12), glm::vec3(0.0f));
  const std::vector<const gl::Texture*> most(screen::Compose::MAX_LAYERS, &layers[0]);
  EXPECT_EQ(sum(most).at(8, 12).r, float(most.size()));
  EXPECT_THROW(sum(std::vector<const gl::Texture*>(most.size() + 1, &layers[0])), Error);
}

}  // namespace
}  // namespace volgi::test
