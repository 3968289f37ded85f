// Pixels read irradiance from spherical harmonics: closed forms, clamp, and which cells take part.
#include "screen/bounces/volume/radiance_gather.h"

#include <gtest/gtest.h>

#include "core/camera.h"
#include "core/gl/scene_buffers.h"
#include "tests/support/gl_test.h"
#include "tests/support/volume_scenes.h"
#include "tests/support/voxels.h"

namespace volgi::test {
namespace {

constexpr float kPi = glm::pi<float>();
const glm::vec3 kAlbedo(0.8f, 0.4f, 0.2f);

/// A square at z = -0.01 that faces +z and fills the view, in a grid of 8^3 cells over [-1,1]^3.
class RadianceGatherGl : public GlTest, public testing::WithParamInterface<int> {
 protected:
  using Coefficients = std::vector<glm::vec4>;  // the same in every cell

  /// Of the middle pixel.
  glm::vec3 gather(const Coefficients& sh, const gl::Texture* normal_occupancy = nullptr) {
    Scene scene;
    add_square(scene, add_material(scene, kAlbedo), {0.0f, 0.0f, -0.01f}, {0.0f, 0.0f, 1.0f}, 1.0f);
    Voxels v;
    v.grid = grid_;
    v.cells.assign(cell_count(grid_), glm::uvec2(0));
    v.sides.resize(1);
    RadianceVolumeGl radiance(grid_, int(sh.size()));
    std::vector<glm::vec4> texels;
    for (const glm::vec4& c : sh) texels.insert(texels.end(), cell_count(grid_), c);
    glTextureSubImage3D(radiance.sh.id(), 0, 0, 0, 0, 8, 8, 8 * int(sh.size()), GL_RGBA, GL_FLOAT, texels.data());
    gl::PassTimer timer(context().software(), false);
    screen::GBuffer gbuffer({8, 8});
    const Camera camera = look_at_camera({0.0f, 0.0f, 2.0f}, glm::vec3(0.0f), 0.5f, glm::vec3(-1.0f), glm::vec3(1.0f));
    gbuffer.run(gl::SceneBuffers(scene), camera, timer);
    screen::RadianceGather pass({8, 8}, GetParam());
    pass.run(gbuffer, upload(v), radiance, normal_occupancy, timer);
    for (float x : pass.direct().download(3)) EXPECT_EQ(x, 0.0f);
    const std::vector<float> pixels = pass.indirect().download(3);
    const size_t middle = 3 * (4 * 8 + 4);
    return {pixels[middle], pixels[middle + 1], pixels[middle + 2]};
  }
  /// 4 or 9 zeros.
  static Coefficients dark() { return Coefficients(GetParam() == 1 ? 4 : 9, glm::vec4(0.0f)); }
  static void expect_irradiance(glm::vec3 radiance, glm::vec3 irradiance) {
    for (int band = 0; band < 3; ++band) EXPECT_NEAR(radiance[band], kAlbedo[band] / kPi * irradiance[band], 1e-4f);
  }

  const Grid grid_ = unit_grid(8);
};

// Isotropic radiance L: sh_00 = sqrt(4 pi) L, E = pi L.
TEST_P(RadianceGatherGl, Isotropic) {
  Coefficients sh = dark();
  sh[0] = std::sqrt(4.0f * kPi) * glm::vec4(1.0f, 2.0f, 3.0f, 0.0f);
  expect_irradiance(gather(sh), kPi * glm::vec3(1.0f, 2.0f, 3.0f));
}

// Radiance 1 + a d_z of light that travels along d, a = -0.5: more comes down on a surface that faces +z.
// E = pi (1 - 2/3 a n_z).
TEST_P(RadianceGatherGl, LightTravelsAlongItsDirection) {
  Coefficients sh = dark();
  sh[0] = glm::vec4(std::sqrt(4.0f * kPi));
  sh[2] = glm::vec4(-0.5f * std::sqrt(4.0f * kPi / 3.0f));
  expect_irradiance(gather(sh), glm::vec3(kPi * (1.0f + 0.5f * 2.0f / 3.0f)));
  if (GetParam() == 2) {  // + b (3 d_z^2 - 1)/2: + pi/4 b
    sh[6] = glm::vec4(0.3f * std::sqrt(4.0f * kPi / 5.0f));
    expect_irradiance(gather(sh), glm::vec3(kPi * (1.0f + 0.5f * 2.0f / 3.0f + 0.25f * 0.3f)));
  }
  sh[2] = glm::vec4(4.0f * std::sqrt(4.0f * kPi / 3.0f));  // all of it travels away: clamped
  expect_irradiance(gather(sh), glm::vec3(0.0f));
}

TEST_P(RadianceGatherGl, OnlyOccupiedCells) {
  Coefficients sh = dark();
  sh[0] = glm::vec4(std::sqrt(4.0f * kPi));
  gl::Texture occupancy = gl::Texture::make_3d(GL_RGBA32F, grid_.cells);
  occupancy.clear({0.0f, 0.0f, 1.0f, 0.0f});
  EXPECT_EQ(gather(sh, &occupancy), glm::vec3(0.0f));
  occupancy.clear({0.0f, 0.0f, 1.0f, 0.1f});
  expect_irradiance(gather(sh, &occupancy), glm::vec3(kPi));
}

INSTANTIATE_TEST_SUITE_P(Orders, RadianceGatherGl, testing::Values(1, 2));

}  // namespace
}  // namespace volgi::test
