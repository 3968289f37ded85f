// The dark room of thin_wall by the `conservative` scheme; `ordinates` is in pictures_test.cpp.
#include <gtest/gtest.h>

#include <filesystem>
#include <tuple>

#include "core/visibility/embree_scene.h"
#include "tests/support/frame_picture.h"
#include "tests/support/gl_test.h"

namespace volgi::test {
namespace {

class Leak : public GlTest {};

TEST_F(Leak, ThinWallConservative) {
  const Scene scene = load_scene(std::filesystem::path(VOLGI_SOURCE_DIR) / "data/thin_wall.glb");
  const Camera& camera = scene.cameras.at(0);
  const glm::ivec2 size(96, 96);
  const EmbreeScene rays(scene);
  for (auto [cells, shift, limit] :
       {std::tuple(16, 0.0f, 0.005), {24, 0.0f, 0.005}, {16, 0.25f, 0.02}, {16, 0.5f, 0.02}}) {
    screen::FrameOptions options;
    options.size = size;
    options.volume.grid_cells = cells;
    options.volume.grid_shift_cells = glm::vec3(shift);
    options.volume.scheme.scheme = Scheme::conservative;
    const Image image = render(context(), scene, camera, options).image;
    double dark = 0.0, lit = 0.0;
    int darks = 0, lits = 0;
    for (int y = 0; y < size.y; ++y) {
      for (int x = 0; x < size.x; ++x) {
        const CameraRay ray = camera_ray(camera, glm::vec2(x, y) + 0.5f, size);
        RayHit hit;
        if (!rays.intersect(ray.origin, ray.direction, 1e6f, 0, hit)) continue;
        const double world_x = double(ray.origin.x + hit.distance * ray.direction.x) + scene.world_origin.x;
        const double value = double(image.at(x, y).x + image.at(x, y).y + image.at(x, y).z);
        if (world_x > 0.011) dark += value, ++darks;
        if (world_x < -0.011) lit += value, ++lits;
      }
    }
    ASSERT_GT(darks, 1000);
    ASSERT_GT(lits, 1000);
    EXPECT_LT(dark / darks, limit * lit / lits) << cells << " cells, shifted by " << shift;
    RecordProperty("leak_" + std::to_string(cells) + "_" + std::to_string(int(100 * shift)),
                   std::to_string(100.0 * dark / darks * lits / lit) + " %");
  }
}

}  // namespace
}  // namespace volgi::test
