// Twelve rooms whose doors are ajar by 15 cm (docs/hard-cases.md, "house"), and a room in other units by the grid that
// is chosen for it ("units").
#include <gtest/gtest.h>

#include <cmath>

#include "propagation/light_in/automatic_grid.h"
#include "propagation/light_in/final_gather_cpu.h"
#include "reference/metrics.h"
#include "reference/picture_files.h"
#include "tests/hardcases/frame_case.h"
#include "tests/support/frame_picture.h"
#include "tests/support/gl_test.h"
#include "tests/support/invariance.h"
#include "tests/support/paths.h"

namespace volgi::test {
namespace {

class House : public GlTest {
 protected:
  void SetUp() override {
    GlTest::SetUp();
    if (IsSkipped()) return;
    if (const char* reason = reason_to_skip(TestedOn::not_in_software, context())) GTEST_SKIP() << reason;
  }
  const Scene scene_ = load_scene(build_dir() / "data/house.glb");
};

// The room that is seen gets a thousandth of the sunny one's light, through two doors.
TEST_F(House, FarRoomNotInSoftware) {
  const ReferenceFile reference =
      read_reference(source_dir() / "data/references/house.exr", PathTracerOptions::Light::indirect);
  constexpr int size = 64;
  screen::FrameOptions o = picture_options("hybrid", {size, size}, screen::LightPart::indirect);
  o.of<VolumeOptions>().grid_cells = automatic_grid_cells(scene_);
  o.of<VolumeOptions>().gather_rays = FinalGatherCpu::RAYS_OF_SEEN;  // as `volgi render` has it
  const Image image = render(context(), scene_, scene_.cameras.at(0), o).image;
  const double energy = mean_light(image) / mean_light(box_downsample(reference.color, size, size));
  expect_of_frame("house", "hybrid, the far room, energy", off_percent(energy), 10.0, 6.0,
                  "what gaps let through of light from few directions (the first bounce is a ten-thousandth of it)");
}

// By one bounce nothing gets there but what a door's gap lets through: light is what passed a wall.
TEST_F(House, NothingPassesWallsNotInSoftware) {
  screen::FrameOptions o = picture_options("val", {64, 64}, screen::LightPart::indirect);
  const double far = mean_light(render(context(), scene_, scene_.cameras.at(0), o).image);
  const glm::vec3 origin(scene_.world_origin);
  const Camera in_sun = look_at_camera(glm::vec3(2.2f, 1.6f, 2.2f) - origin, glm::vec3(0.6f, 0.6f, 0.6f) - origin, 1.3f,
                                       scene_.bounds_min, scene_.bounds_max);
  const double sunny = mean_light(render(context(), scene_, in_sun, o).image);
  EXPECT_GT(sunny, 0.1);
  expect_of_frame("house", "val, the far room over the sunny one", 100.0 * far / sunny, 0.5);
}

// Cells are chosen in metres: at most 0.3 m long where there may be so many, whatever the unit.
TEST_F(House, ARoomInMillimetresAndKilometresNotInSoftware) {
  const Scene room = load_scene(source_dir() / "data/room.glb");
  const auto picture = [&](const Scene& scene) {
    screen::FrameOptions o = picture_options("volume", {64, 64});
    o.of<VolumeOptions>().grid_cells = automatic_grid_cells(scene);
    return render(context(), scene, scene.cameras.at(0), o).image;
  };
  const Image in_metres = picture(room);
  for (const float s : {1e-3f, 1e3f})
    expect_of_frame(
        "units", fmt::format("volume, room x {:g} by the grid that is chosen", s),
        rmse_percent(picture(scaled(room, s)), in_metres), s > 1.0f ? 5.6 : 2.0, 2.0,
        s > 1.0f ? "in km there are more cells, as many as there may be: they are asked to be 0.3 m long" : "");
}

}  // namespace
}  // namespace volgi::test
