// Pictures of which the camera moves, or what plays on a screen: they change no more than the same lights, seen
// exactly, would make them. Lights that move: FirstBounce.Flicker.
#include "tests/hardcases/flicker.h"

#include <gtest/gtest.h>

#include "reference/virtual_light_tracer.h"
#include "screen/visibility/visibility_choice.h"
#include "tests/hardcases/frame_case.h"
#include "tests/support/gl_test.h"
#include "tests/support/paths.h"

namespace volgi::test {
namespace {

using screen::LightPart;

constexpr glm::ivec2 SIZE(64, 64);

class Flickers : public GlTest {
 protected:
  static VirtualLightGatherOptions exactly(PathTracerOptions::Light light) {
    VirtualLightGatherOptions o;
    o.size = SIZE;
    o.light = light;
    return o;
  }
  static void expect_no_more(const std::string& what, const Flicker& shown, const Flicker& exact) {
    expect_of_frame("flicker", what + ", median", shown.median() / exact.median(), 1.5, {}, {}, "times");
    expect_of_frame("flicker", what + ", largest", shown.largest() / exact.largest(), 1.5, {}, {}, "times");
  }
};

TEST_F(Flickers, AsTheCameraMoves) {
  for (const char* name : {"cornell", "room"}) {
    const Scene scene = load_scene(source_dir() / "data" / (std::string(name) + ".glb"));
    const float step = 1e-3f * glm::distance(scene.bounds_min, scene.bounds_max);
    screen::FrameOptions o = picture_options("hybrid", SIZE, LightPart::indirect);
    o.of<screen::VirtualLightOptions>().count = 256;
    o.of<VolumeOptions>().grid_cells = 24;
    screen::Frame frame(scene, o);
    gl::PassTimer timer(context().software(), false);
    const VirtualLightTracer tracer(scene);
    Camera camera = scene.cameras.at(0);
    const glm::vec4 along = camera.world_from_camera[0] * step;
    Flicker shown, exact;
    for (int k = 0; k <= 12; ++k) {
      frame.render(camera, timer);
      shown.add(screen::image_from_texture(frame.radiance()));
      exact.add(tracer.gather(camera, frame.virtual_lights(), exactly(PathTracerOptions::Light::indirect)).color);
      camera.world_from_camera[3] += along;
    }
    EXPECT_GT(exact.median(), 0.05) << "nothing moves";
    expect_no_more(std::string("hybrid, ") + name + ", camera moved by a thousandth, 12 steps", shown, exact);
  }
}

/// A bright square that crosses a dark screen of 64 x 36.
TextureImage picture_of_film(int k) {
  constexpr int WIDTH = 64, HEIGHT = 36;
  TextureImage image{WIDTH, HEIGHT, SharedBytes::Bytes(size_t(WIDTH) * HEIGHT * 4, 255)};
  SharedBytes::Bytes& bytes = image.rgba.edit();
  for (int y = 0; y < HEIGHT; ++y) {
    for (int x = 0; x < WIDTH; ++x) {
      const bool bright = x >= 5 * k && x < 5 * k + 12 && y >= 8 && y < 22;
      for (size_t c = 0; c < 3; ++c) bytes[4 * (size_t(y) * WIDTH + size_t(x)) + c] = bright ? 250 : 20;
    }
  }
  return image;
}

TEST_F(Flickers, AsAScreenPlays) {
  struct Shown {
    const char* recipe;
    screen::VisibilityChoice::Ways ways;
    Flicker shown, exact;
  };
  Shown all[] = {{"hybrid", {}, {}, {}}, {"area", screen::VisibilityChoice::Ways::faces, {}, {}}};
  Scene scene = load_scene(source_dir() / "data/reference/scenes/area_tv.glb");
  gl::PassTimer timer(context().software(), false);
  for (int k = 0; k < 6; ++k) {
    for (const Material& m : scene.materials) {
      if (!m.is_emissive() || m.emissive.texture < 0) continue;
      scene.images[size_t(scene.textures[size_t(m.emissive.texture)].image)] = picture_of_film(k);
    }
    const VirtualLightTracer tracer(scene);
    for (Shown& s : all) {
      screen::FrameOptions o = picture_options(s.recipe, SIZE, LightPart::direct);
      o.of<screen::VisibilityChoice>().ways = s.ways;
      o.of<VolumeOptions>().grid_cells = 32;
      screen::Frame frame(scene, o);
      frame.render(scene.cameras.at(0), timer);
      s.shown.add(screen::image_from_texture(frame.radiance()));
      s.exact.add(
          tracer.gather(scene.cameras.at(0), frame.virtual_lights(), exactly(PathTracerOptions::Light::direct)).color);
    }
  }
  for (const Shown& s : all) {
    EXPECT_GT(s.exact.median(), 1.0) << "nothing plays";
    expect_no_more(std::string(s.recipe) + ", area_tv, a square crosses the screen", s.shown, s.exact);
  }
}

}  // namespace
}  // namespace volgi::test
