// A technique from outside: a stage type and a recipe of ten lines, which nobody but this file knows, make a picture.
// What docs/adding-a-technique.md asks for besides is a line in registry.cpp, so that --gi finds it.
#include "screen/frame/frame.h"
#include "tests/screen/screen_scene.h"
#include "tests/support/frame_picture.h"
#include "tests/support/gl_test.h"

namespace volgi::test {
namespace {

using namespace screen;

struct ToyOptions {
  float radiance = 0.25f;
};

/// The same radiance on every surface.
class Toy : public Stage {
 public:
  explicit Toy(const StageContext& context)
      : layer_(gl::Texture::make_2d(GL_RGBA32F, context.options.size.x, context.options.size.y)),
        radiance_(context.options.of<ToyOptions>().radiance) {}
  void run(FrameData& frame, gl::PassTimer& timer) override {
    const auto scope = timer.scope("screen/gather/toy");
    layer_.clear({radiance_, radiance_, radiance_, 1.0f});
    frame.layers.push_back({&layer_, {paths}});
  }
  void report(FrameReport& report) const override { report.add("toys", 1.0, "1 toy"); }
  static inline LightPaths paths{LightPath::punctual_first};

 private:
  gl::Texture layer_;
  float radiance_;
};

const StageType TOY{.name = "gather/toy",
                    .slot = Slot::gather,
                    .parameters = {},
                    .role = [](const FrameOptions&) { return StageRole{.adds = {{{LightPath::punctual_first}}}}; },
                    .make = [](const StageContext& c) -> std::unique_ptr<Stage> { return std::make_unique<Toy>(c); }};
const Recipe TOY_RECIPE{"toy", "the same light everywhere", {&TOY}, {LightPath::punctual_first}};

class ToyTechnique : public GlTest {
 protected:
  static FrameOptions options(LightPart light) {
    FrameOptions o;
    o.size = glm::ivec2(16);
    o.light = light;
    return o;
  }
  static Image picture(const FrameOptions& o) {
    const Scene scene = stage_with_light();
    Frame frame(scene, o, TOY_RECIPE);
    gl::PassTimer timer(context().software(), false);
    frame.render(stage_camera(scene), timer);
    EXPECT_EQ(frame.report().number("toys"), o.light == LightPart::direct ? 0.0 : 1.0);
    return image_from_texture(frame.radiance());
  }
  static Scene stage_with_light() {
    Scene scene = stage();
    scene.lights = {spot_light({0.0f, 2.5f, 1.5f}, {0.0f, -1.0f, -0.5f}, 20.0f, 40.0f, 30.0f)};
    update_bounds(scene);
    return scene;
  }
};

TEST_F(ToyTechnique, MakesAPicture) {
  const Image full = picture(options(LightPart::full));
  const Image direct = picture(options(LightPart::direct));
  const Image indirect = picture(options(LightPart::indirect));
  EXPECT_EQ(indirect.at(8, 12), glm::vec3(0.25f));
  EXPECT_EQ(indirect.at(0, 0), glm::vec3(0.0f)) << "background";
  for (size_t i = 0; i < full.pixels.size(); ++i) EXPECT_EQ(full.pixels[i], direct.pixels[i] + indirect.pixels[i]);
  FrameOptions brighter = options(LightPart::indirect);
  brighter.of<ToyOptions>().radiance = 0.5f;
  EXPECT_EQ(picture(brighter).at(8, 12), glm::vec3(0.5f));
}

TEST_F(ToyTechnique, IsStoppedWhenItsLayersAreNotWhatItsRoleSays) {
  Toy::paths = {LightPath::punctual_higher};
  EXPECT_THROW(picture(options(LightPart::full)), Error);
  Toy::paths = {LightPath::punctual_first};
}

}  // namespace
}  // namespace volgi::test
