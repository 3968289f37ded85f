// What a volume says of itself before and after it has run: what is refused, what ran, and how much memory it takes.
#include "screen/bounces/volume/frame_volume.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/scene.h"
#include "tests/support/frame_picture.h"
#include "tests/support/gl_test.h"
#include "tests/support/paths.h"

namespace volgi::test {
namespace {

class FrameVolumeGl : public GlTest {
 protected:
  static screen::FrameOptions options(Scheme scheme, screen::Backend backend) {
    screen::FrameOptions o;
    o.size = {16, 16};
    o.backend = backend;
    o.volume.scheme.scheme = scheme;
    o.volume.iterations = 4;
    return o;
  }
  static screen::VolumeReport report(const Scene& scene, const screen::FrameOptions& o) {
    screen::Frame frame(scene, o);
    gl::PassTimer timer(context().software(), false);
    frame.render(scene.cameras.at(0), timer);
    return frame.report().volume;
  }

  const Scene scene_ = load_scene(source_dir() / "data/cornell.glb");
};

// The coarse grid of `conservative` is the CPU's alone: where nobody asks, each backend does what it has and says so;
// who asks for what there is not is told.
TEST_F(FrameVolumeGl, CoarseGridIsRefusedWhereThereIsNone) {
  screen::FrameOptions gpu = options(Scheme::conservative, screen::Backend::gpu);
  screen::FrameOptions cpu = options(Scheme::conservative, screen::Backend::cpu);
  EXPECT_FALSE(report(scene_, gpu).coarse_start);
  EXPECT_TRUE(report(scene_, cpu).coarse_start);
  cpu.volume.scheme.coarse_start = false;
  EXPECT_FALSE(report(scene_, cpu).coarse_start);
  gpu.volume.scheme.coarse_start = true;
  try {
    screen::Frame(scene_, gpu);
    FAIL() << "not refused";
  } catch (const Error& e) {
    EXPECT_EQ(e.code(), ExitCode::usage);
  }
}

}  // namespace
}  // namespace volgi::test
