// Every view of a real frame: none fails, none is empty, none makes GL objects once it has been drawn; and pictures of
// all of them in the build folder's views/, to look at.
#include <algorithm>
#include <filesystem>
#include <tuple>

#include "core/image.h"
#include "screen/display/accumulate.h"
#include "screen/display/fxaa.h"
#include "screen/display/present.h"
#include "screen/views/error_view.h"
#include "screen/views/gbuffer_view.h"
#include "screen/views/lights_view.h"
#include "screen/views/lobe_view.h"
#include "screen/views/texture_view.h"
#include "screen/views/view_target.h"
#include "screen/views/voxel_view.h"
#include "screen/views/wipe.h"
#include "screen/visibility/area_maps/light_clusters.h"
#include "tests/support/frame_picture.h"
#include "tests/support/gl_test.h"
#include "tests/support/paths.h"

namespace volgi::test {
namespace {

constexpr glm::ivec2 SIZE(192, 192);
constexpr float EXPOSURE_EV = 1.0f;

/// Draws views of one frame, writes them and looks at what they have changed.
class Views {
 public:
  Views(const gl::Context& context, screen::Frame& frame, const Camera& camera, const std::string& recipe)
      : frame_(frame), camera_(camera), recipe_(recipe), timer_(context.software(), false), target_(SIZE) {
    std::filesystem::create_directories(folder());
    frame_.render(camera_, timer_);
  }
  static std::filesystem::path folder() { return build_dir() / "views"; }

  /// In place of the picture. @param draw  of the target's framebuffer and a timer.
  template <class Draw>
  void expect_view(const std::string& name, size_t least_colors, const Draw& draw) {
    const Image shown = drawn_twice(name, [&] { draw(target_.framebuffer(), timer_); });
    EXPECT_GE(colors(shown), least_colors) << name;
  }
  /// Over it. @param hidden  by its surfaces; else seen alone.
  template <class Draw>
  void expect_overlay(const std::string& name, bool hidden, float slack_m, const Draw& draw) {
    const auto begin = [&] {
      present_.run(frame_.radiance(), EXPOSURE_EV, target_.framebuffer(), timer_);
      target_.begin_overlays(
          {.gbuffer = hidden ? &frame_.gbuffer() : nullptr, .slack_m = slack_m, .brightness = hidden ? 0.4f : 0.1f},
          camera_, timer_);
    };
    begin();
    const Image before = screen::image_from_texture(target_.picture());
    const Image shown = drawn_twice(name, [&] {
      begin();
      draw(target_.framebuffer(), timer_);
    });
    size_t changed = 0;
    for (size_t i = 0; i < shown.pixels.size(); ++i) changed += shown.pixels[i] != before.pixels[i] ? 1 : 0;
    EXPECT_GT(changed, shown.pixels.size() / 500) << name;
  }
  const screen::ViewTarget& target() const { return target_; }
  gl::PassTimer& timer() { return timer_; }

 private:
  template <class Draw>
  Image drawn_twice(const std::string& name, const Draw& draw) {
    draw();
    const std::uint64_t made = gl::objects_made();
    draw();
    EXPECT_EQ(gl::objects_made(), made) << name;
    Image shown = screen::image_from_texture(target_.picture());
    write_png_display(folder() / (recipe_ + "_" + name + ".png"), shown);
    return shown;
  }
  static size_t colors(const Image& image) {
    std::vector<glm::vec3> all = image.pixels;
    const auto less = [](glm::vec3 a, glm::vec3 b) { return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z); };
    std::sort(all.begin(), all.end(), less);
    return size_t(std::unique(all.begin(), all.end()) - all.begin());
  }
  screen::Frame& frame_;
  const Camera& camera_;
  std::string recipe_;
  gl::PassTimer timer_;
  screen::ViewTarget target_;
  screen::Present present_;
};

class FrameViews : public GlTest {
 protected:
  void SetUp() override {
    GlTest::SetUp();
    if (IsSkipped()) return;
    scene_ = load_scene(source_dir() / "data/cornell.glb");
  }
  screen::FrameOptions options(Gi recipe) {
    screen::FrameOptions options = picture_options(recipe, SIZE);
    options.backend = screen::Backend::automatic;
    options.of<VolumeOptions>().grid_cells = 16;
    return options;
  }
  Scene scene_;
};

void expect_display(Views& views, const screen::Frame& frame) {
  screen::Present present;
  screen::Fxaa fxaa;
  screen::Accumulate accumulate(SIZE);
  const screen::ViewTarget unfiltered(SIZE);
  views.expect_view("present", 1000, [&](const gl::Framebuffer& target, gl::PassTimer& timer) {
    accumulate.add(frame.radiance(), timer);
    present.run(accumulate.mean(), EXPOSURE_EV, target, timer);
  });
  views.expect_view("fxaa", 1000, [&](const gl::Framebuffer& target, gl::PassTimer& timer) {
    present.run(frame.radiance(), EXPOSURE_EV, unfiltered.framebuffer(), timer);
    fxaa.run(unfiltered.picture(), target, timer);
  });
}

void expect_textures(Views& views, const screen::Frame& frame) {
  screen::TextureView view;
  for (const screen::NamedTexture& named : frame.textures()) {
    const bool light = screen::texel_kind(*named.texture).channels > 2;
    screen::TextureView::Options options;
    options.channel = light ? screen::TextureView::Channel::rgb : screen::TextureView::Channel::red;
    options.range = screen::automatic_range(*named.texture, 0, options.channel);
    std::string name = "texture_" + named.name;
    std::ranges::replace_if(
        name, [](char c) { return c == '/' || c == ' '; }, '_');
    const auto draw = [&](const gl::Framebuffer& target, gl::PassTimer& timer) {
      view.run(*named.texture, options, target, timer);
    };
    views.expect_view(name, 1, draw);  // no light of some kinds in this scene
  }
}

void expect_gbuffer(Views& views, const screen::Frame& frame, const Camera& camera) {
  using Mode = screen::GBufferView::Mode;
  screen::GBufferView view;
  constexpr std::array<std::pair<Mode, const char*>, 6> modes{{{Mode::albedo, "albedo"},
                                                               {Mode::shading_normal, "shading_normal"},
                                                               {Mode::geometric_normal, "geometric_normal"},
                                                               {Mode::depth, "depth"},
                                                               {Mode::emission, "emission"},
                                                               {Mode::object_id, "object_id"}}};
  for (const auto& [mode, name] : modes) {
    const size_t least_colors = mode == Mode::emission ? 1 : mode == Mode::depth ? 20 : 4;
    views.expect_view(std::string("gbuffer_") + name, least_colors,
                      [&](const gl::Framebuffer& target, gl::PassTimer& timer) {
                        view.run(frame.gbuffer(), camera, {.mode = mode, .depth_range_m = {0.0f, 8.0f}}, target, timer);
                      });
  }
}

void expect_sides(Views& views, const screen::FrameVolume& volume, const Camera& camera) {
  using Mode = screen::VoxelView::Mode;
  screen::VoxelView view;
  constexpr std::array<std::pair<Mode, const char*>, 7> modes{{{Mode::indirect, "indirect"},
                                                               {Mode::direct, "direct"},
                                                               {Mode::irradiance, "irradiance"},
                                                               {Mode::albedo, "albedo"},
                                                               {Mode::coverage, "coverage"},
                                                               {Mode::normal, "normal"},
                                                               {Mode::emission, "emission"}}};
  const float slack_m = screen::ViewTarget::SIDES_SLACK_CELLS * volume.voxels().grid.cell_size_m;
  for (bool hidden : {true, false}) {
    for (const auto& [mode, name] : modes) {
      const auto draw = [&](const gl::Framebuffer& target, gl::PassTimer& timer) {
        view.run(volume.voxels(), volume.direct_irradiance(), volume.indirect_irradiance(), camera,
                 {.mode = mode, .exposure_ev = EXPOSURE_EV}, target, timer);
      };
      views.expect_overlay(std::string(hidden ? "sides_" : "sides_alone_") + name, hidden, slack_m, draw);
    }
  }
}

void expect_lobe(Views& views, const screen::FrameVolume& volume, const Camera& camera, bool hidden) {
  const RadianceVolumeGl* radiance = volume.radiance(views.timer());
  ASSERT_NE(radiance, nullptr);
  screen::LobeView view;
  for (const glm::ivec3 at : {glm::ivec3(4, 3, 9), glm::ivec3(8, 8, 8), glm::ivec3(13, 12, 4)}) {
    const auto draw = [&](const gl::Framebuffer& target, gl::PassTimer& timer) {
      view.run(*radiance, camera, {.cell = at, .exposure_ev = EXPOSURE_EV, .radius_cells = 0.8f}, target, timer);
    };
    views.expect_overlay("lobe_" + std::to_string(at.x), hidden, 0.0f, draw);
  }
}

void expect_lights(Views& views, const screen::Products& products, const Camera& camera) {
  using Mode = screen::LightsView::Mode;
  screen::LightsView view;
  const auto* clusters = products.find<screen::LightClusters>();
  const screen::LightsView::Shown shown{.lights = products.find<screen::VirtualLightListGl>(),
                                        .negative = products.find<screen::NegativeLights>(),
                                        .area_lights = clusters != nullptr ? &clusters->area_lights : nullptr};
  constexpr std::array<std::pair<Mode, const char*>, 3> modes{
      {{Mode::flux, "flux"}, {Mode::source, "source"}, {Mode::cluster, "cluster"}}};
  for (const auto& [mode, name] : modes) {
    const auto draw = [&](const gl::Framebuffer& target, gl::PassTimer& timer) {
      view.run(shown, camera, {.mode = mode, .share = 0.1f, .tick_px = 4.0f, .squares = mode == Mode::cluster}, target,
               timer);
    };
    views.expect_overlay(std::string("lights_") + name, true, 0.0f, draw);
  }
}

void expect_errors(Views& views, const screen::Frame& frame) {
  const Image reference = read_exr_rgb(source_dir() / "data/references/cornell.exr");
  ASSERT_EQ(glm::ivec2(reference.width, reference.height), SIZE);
  const gl::Texture texture = gl::Texture::make_2d(GL_RGBA32F, SIZE.x, SIZE.y);
  for (int y = 0; y < SIZE.y; ++y)
    glTextureSubImage2D(texture.id(), 0, 0, SIZE.y - 1 - y, SIZE.x, 1, GL_RGB, GL_FLOAT, &reference.at(0, y));
  screen::ErrorView error;
  screen::Wipe wipe;
  const float floor_radiance = screen::error_floor(texture);
  views.expect_view("error", 100, [&](const gl::Framebuffer& target, gl::PassTimer& timer) {
    error.run(frame.radiance(), texture, {.floor_radiance = floor_radiance}, target, timer);
  });
  views.expect_view("wipe", 1000, [&](const gl::Framebuffer& target, gl::PassTimer& timer) {
    wipe.run(frame.radiance(), texture, EXPOSURE_EV, SIZE.x / 2, target, timer);
  });
}

TEST_F(FrameViews, OfHybrid) {
  screen::Frame frame(scene_, options("hybrid"));
  const Camera& camera = scene_.cameras.at(0);
  Views views(context(), frame, camera, "hybrid");
  const screen::FrameVolume* volume = frame.products().find<screen::FrameVolume>();
  ASSERT_NE(volume, nullptr);
  expect_display(views, frame);
  expect_textures(views, frame);
  expect_gbuffer(views, frame, camera);
  expect_sides(views, *volume, camera);
  expect_lobe(views, *volume, camera, true);
  expect_lights(views, frame.products(), camera);
  expect_errors(views, frame);
}

TEST_F(FrameViews, OfNegativeLights) {
  screen::Frame frame(scene_, options("negative"));
  const Camera& camera = scene_.cameras.at(0);
  Views views(context(), frame, camera, "negative");
  expect_lights(views, frame.products(), camera);
}

/// From outside, where sides seen from behind leave the view open.
TEST_F(FrameViews, OfTheVolumeFromOutside) {
  screen::Frame frame(scene_, options("volume"));
  const glm::vec3 middle = 0.5f * (scene_.bounds_min + scene_.bounds_max), size = scene_.bounds_max - scene_.bounds_min;
  const Camera camera = look_at_camera(middle + 1.3f * glm::length(size) * glm::normalize(glm::vec3(0.6f, 0.5f, 1.0f)),
                                       middle, 0.7f, scene_.bounds_min, scene_.bounds_max);
  Views views(context(), frame, camera, "outside");
  const screen::FrameVolume* volume = frame.products().find<screen::FrameVolume>();
  ASSERT_NE(volume, nullptr);
  expect_sides(views, *volume, camera);
  expect_lobe(views, *volume, camera, false);
}

}  // namespace
}  // namespace volgi::test
