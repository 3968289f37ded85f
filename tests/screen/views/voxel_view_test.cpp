// Squares are where rays meet the faces of sides, in the side's colour, and nowhere else; on a grid that is no cube and
// lies elsewhere.
#include "screen/views/voxel_view.h"

#include <optional>
#include <random>

#include "screen/views/view_target.h"
#include "shaders/shared/color_maps.shared.h"
#include "shaders/shared/tone_map.shared.h"
#include "tests/screen/display_target.h"
#include "tests/screen/screen_scene.h"
#include "tests/support/gl_test.h"
#include "tests/support/voxels.h"

namespace volgi::test {
namespace {

namespace formulas = volgi::shared;
using Mode = screen::VoxelView::Mode;

constexpr glm::ivec2 SIZE(160, 120);
constexpr float STEP = 0.5f / 255.0f + 2e-4f;  // of eight bits, and of GLSL's pow()
constexpr glm::vec4 BACKGROUND(0.0f, 0.0f, 0.0f, 1.0f);

/// 5 x 3 x 4 cells of 0.4 m; a third of all faces have a side, of random properties.
Voxels random_voxels() {
  Voxels voxels;
  voxels.grid.cells = {5, 3, 4};
  voxels.grid.cell_size_m = 0.4f;
  voxels.grid.origin = {1.0f, -0.5f, -2.0f};
  std::mt19937 random(11);
  std::uniform_real_distribution<float> share(0.0f, 1.0f);
  const auto color = [&] { return glm::vec3(share(random), share(random), share(random)); };
  for (int cell = 0; cell < 5 * 3 * 4; ++cell) {
    glm::uvec2 of_cell(voxels.sides.size(), 0);
    for (int face = 0; face < 6; ++face) {
      if (share(random) > 0.33f) continue;
      of_cell.y |= 1u << face;
      Side side{};
      side.normal = glm::normalize(color() - 0.5f);
      side.coverage = share(random);
      side.albedo = color();
      side.radiosity = 3.0f * color();
      side.cell = cell;
      side.face = face;
      voxels.sides.push_back(side);
    }
    voxels.cells.push_back(of_cell);
  }
  return voxels;
}

struct Hit {
  size_t side;
  float distance;
  float from_middle;  // 0 to 1 at the face's edge
};

std::optional<Hit> meet(const Grid& grid, const Side& side, size_t number, const CameraRay& ray) {
  const int axis = formulas::face_axis(side.face);
  const glm::vec3 outwards(formulas::face_step(side.face));
  const glm::vec3 middle =
      grid.origin + grid.cell_size_m * (glm::vec3(formulas::cell_coord(grid, side.cell)) + 0.5f + 0.5f * outwards);
  if (glm::dot(ray.direction, outwards) <= 0.0f) return {};  // from behind
  const float distance = (middle[axis] - ray.origin[axis]) / ray.direction[axis];
  glm::vec3 off = glm::abs(ray.origin + distance * ray.direction - middle) * (2.0f / grid.cell_size_m);
  off[axis] = 0.0f;
  const float from_middle = std::max({off.x, off.y, off.z});
  if (distance <= 0.0f || from_middle > 1.05f) return {};  // corners are rounded to parts of pixels
  return Hit{number, distance, from_middle};
}

class VoxelView : public GlTest {
 protected:
  void SetUp() override {
    GlTest::SetUp();
    if (IsSkipped()) return;
    timer_ = std::make_unique<gl::PassTimer>(context().software(), false);
    target_ = std::make_unique<screen::ViewTarget>(SIZE);
    view_ = std::make_unique<screen::VoxelView>();
  }
  std::vector<glm::vec4> shown(const VoxelGridGl& voxels, const screen::VoxelView::Options& options) {
    target_->picture().clear({0.0f, 0.0f, 0.0f, 1.0f});
    target_->begin_overlays({}, camera_, *timer_);
    view_->run(voxels, direct_, indirect_, camera_, options, target_->framebuffer(), *timer_);
    return texels_of(target_->picture());
  }
  /// @param expected  color of a side. @return pixels that were compared with a side's.
  template <class Expected>
  int expect_sides(const Voxels& voxels, const std::vector<glm::vec4>& picture, const Expected& expected) {
    int sides = 0, empty = 0;
    for (int y = 0; y < SIZE.y; ++y) {
      for (int x = 0; x < SIZE.x; ++x) {
        const CameraRay ray = camera_ray(camera_, glm::vec2(x, SIZE.y - 1 - y) + 0.5f, SIZE);
        std::optional<Hit> nearest;
        bool sure = true;  // neither in a rim nor in a gap
        for (size_t i = 0; i < voxels.sides.size(); ++i) {
          const std::optional<Hit> hit = meet(voxels.grid, voxels.sides[i], i, ray);
          if (!hit || (nearest && nearest->distance < hit->distance)) continue;
          sure = hit->from_middle < 0.5f;  // rims begin at 0.53 where pixels are coarsest
          nearest = hit;
        }
        if (!sure) continue;
        const glm::vec4 shown = picture[size_t(y * SIZE.x + x)];
        const glm::vec4 color = nearest ? glm::vec4(expected(nearest->side), 1.0f) : BACKGROUND;
        for (int band = 0; band < 4; ++band) EXPECT_NEAR(shown[band], color[band], STEP) << "pixel " << x << ", " << y;
        if (HasFailure()) return sides;
        (nearest ? sides : empty) += 1;
      }
    }
    EXPECT_GT(empty, 1000);
    return sides;
  }
  std::unique_ptr<screen::VoxelView> view_;
  std::unique_ptr<gl::PassTimer> timer_;
  std::unique_ptr<screen::ViewTarget> target_;
  const gl::Buffer *direct_ = nullptr, *indirect_ = nullptr;  // irradiance by side
  Camera camera_ = look_at_camera({4.0f, 1.5f, 1.5f}, {2.0f, 0.1f, -1.2f}, 0.8f, {1, -0.5f, -2}, {3, 0.7f, -0.4f});
};

TEST_F(VoxelView, DrawsEverySideAtItsPlace) {
  const Voxels voxels = random_voxels();
  const VoxelGridGl gpu = upload(voxels);
  std::vector<glm::vec4> direct, indirect;
  for (size_t i = 0; i < voxels.sides.size(); ++i) {
    direct.emplace_back(0.01f * float(i), 0.5f, 0.0f, 1.0f);
    indirect.emplace_back(0.3f, 0.0f, 0.02f * float(i), 1.0f);
  }
  const gl::Buffer direct_buffer(direct), indirect_buffer(indirect);
  direct_ = &direct_buffer;
  indirect_ = &indirect_buffer;
  const auto light = [](glm::vec3 irradiance) {
    return formulas::display_from_linear(irradiance * (4.0f / glm::pi<float>()));
  };
  const auto expect_mode = [&](Mode mode, const auto& color) {
    EXPECT_GT(expect_sides(voxels, shown(gpu, {.mode = mode, .exposure_ev = 2.0f}), color), 1000);
  };
  expect_mode(Mode::coverage, [&](size_t i) { return formulas::viridis(voxels.sides[i].coverage); });
  expect_mode(Mode::albedo, [&](size_t i) { return formulas::srgb_encode(voxels.sides[i].albedo); });
  expect_mode(Mode::normal, [&](size_t i) { return 0.5f + 0.5f * voxels.sides[i].normal; });
  expect_mode(Mode::emission, [&](size_t i) { return light(voxels.sides[i].radiosity); });
  expect_mode(Mode::direct, [&](size_t i) { return light(direct[i]); });
  expect_mode(Mode::indirect, [&](size_t i) { return light(indirect[i]); });
  expect_mode(Mode::irradiance, [&](size_t i) { return light(glm::vec3(direct[i] + indirect[i])); });

  camera_.kind = Camera::Kind::orthographic;
  camera_.ymag = 1.6f;
  expect_mode(Mode::coverage, [&](size_t i) { return formulas::viridis(voxels.sides[i].coverage); });
}

/// A wall without volume in front of all sides hides them, unless it is given so much slack.
TEST_F(VoxelView, IsHiddenByThePicture) {
  const VoxelGridGl gpu = upload(random_voxels());
  Scene scene;
  // Upright and aslant, 1 m before the nearest corner and 3.5 m before the farthest, both across it.
  const glm::vec3 front = glm::normalize(glm::vec3(1.0f, 0.0f, 0.5f)), along = glm::normalize(glm::vec3(0.5f, 0, -1));
  const glm::vec3 middle = glm::vec3(3.0f, 0.1f, -0.4f) + front;
  add_quad(scene, add_material(scene, glm::vec3(0.5f)), middle - 9.0f * along - glm::vec3(0, 9, 0), 18.0f * along,
           {0.0f, 18.0f, 0.0f});
  update_bounds(scene);
  camera_ = look_at_camera({5.5f, 0.8f, 2.0f}, {2.0f, 0.1f, -1.2f}, 0.7f, glm::vec3(-3.0f), glm::vec3(5.0f));
  camera_.znear = 0.1f;
  screen::GBuffer gbuffer(SIZE);
  gbuffer.run(gl::SceneBuffers(scene), camera_, *timer_);
  const auto drawn = [&](float slack_m) {
    target_->picture().clear({0.5f, 0.5f, 0.5f, 1.0f});
    target_->begin_overlays({.gbuffer = &gbuffer, .slack_m = slack_m, .brightness = 0.5f}, camera_, *timer_);
    view_->run(gpu, nullptr, nullptr, camera_, {.mode = Mode::direct}, target_->framebuffer(), *timer_);
    int count = 0;
    for (glm::vec4 texel : texels_of(target_->picture())) {
      const bool side = texel.r < 0.01f;  // without light sides are black
      count += side ? 1 : 0;
      EXPECT_NEAR(texel.r, side ? 0.0f : 0.25f, 1.5f / 255.0f);  // or the picture, dimmed
    }
    return count;
  };
  EXPECT_EQ(drawn(0.0f), 0);
  EXPECT_EQ(drawn(0.99f), 0);
  const int some = drawn(1.8f), all = drawn(3.6f);
  EXPECT_GT(some, 100);
  EXPECT_GT(all, some + 100);
  EXPECT_EQ(all, drawn(100.0f));
}

TEST_F(VoxelView, DrawsNothingOfNoSides) {
  Voxels voxels = random_voxels();
  voxels.sides.clear();
  voxels.cells.assign(voxels.cells.size(), glm::uvec2(0));
  for (glm::vec4 texel : shown(upload(voxels), {})) EXPECT_EQ(texel, BACKGROUND);
}

}  // namespace
}  // namespace volgi::test
