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
    o.recipe = "volume";
    o.size = {16, 16};
    o.backend = backend;
    o.of<VolumeOptions>().scheme.scheme = scheme;
    o.of<VolumeOptions>().iterations = 4;
    return o;
  }
  static screen::VolumeReport report(const Scene& scene, const screen::FrameOptions& o) {
    screen::Frame frame(scene, o);
    gl::PassTimer timer(context().software(), false);
    frame.render(scene.cameras.at(0), timer);
    return frame.report().of<screen::VolumeReport>();
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
  cpu.of<VolumeOptions>().scheme.coarse_start = false;
  EXPECT_FALSE(report(scene_, cpu).coarse_start);
  gpu.of<VolumeOptions>().scheme.coarse_start = true;
  try {
    screen::Frame(scene_, gpu);
    FAIL() << "not refused";
  } catch (const Error& e) {
    EXPECT_EQ(e.code(), ExitCode::usage);
  }
}

// Injection by MAX puts the same into the pulse on both backends.
TEST_F(FrameVolumeGl, InjectionByMaxIsTheSameOnBoth) {
  for (const char* name : {"cornell", "emissive"}) {
    const Scene scene = load_scene(source_dir() / "data" / (std::string(name) + ".glb"));
    glm::vec3 sent[2], left[2];
    for (const screen::Backend backend : {screen::Backend::gpu, screen::Backend::cpu}) {
      screen::FrameOptions o = options(Scheme::gaitatzes2010, backend);
      o.of<VolumeOptions>().scheme.injection = SchemeOptions::Injection::max;
      const BounceReport bounces = report(scene, o).bounces;
      sent[backend == screen::Backend::cpu] = bounces.sent;
      left[backend == screen::Backend::cpu] = bounces.left;
    }
    for (int band = 0; band < 3; ++band) {
      EXPECT_GT(sent[0][band], 0.0f);
      // Light comes by maps on one and by rays on the other, and the largest of a cell's sides is what differs most.
      EXPECT_NEAR(sent[1][band] / sent[0][band], 1.0f, 5e-3f) << name;
      EXPECT_NEAR(left[1][band] / left[0][band], 1.0f, 5e-3f) << name;
    }
  }
}

// What the GPU's voxelization is asked for is done, and the CPU, which has none of it, says so.
TEST_F(FrameVolumeGl, VoxelizationIsAsAskedFor) {
  const screen::VolumeReport sliced = report(scene_, options(Scheme::ordinates, screen::Backend::gpu));
  for (const VoxelizationOptions asked :
       {VoxelizationOptions{.method = VoxelizationMethod::single_pass}, VoxelizationOptions{.interleave = true}}) {
    screen::FrameOptions o = options(Scheme::ordinates, screen::Backend::gpu);
    o.of<VolumeOptions>().voxelization = asked;
    const screen::VolumeReport other = report(scene_, o);
    EXPECT_EQ(other.sides, sliced.sides);
    EXPECT_EQ(other.injected, sliced.injected);
    o.backend = screen::Backend::cpu;
    EXPECT_THROW(screen::Frame(scene_, o), Error);
  }
}

// What --memory-limit is held against is what is then taken, whatever the scheme, within a tenth.
TEST_F(FrameVolumeGl, MemoryIsAsPredicted) {
  struct Case {
    Scheme scheme;
    int sh_order, grid_cells;
  };
  for (const Case c :
       {Case{Scheme::ordinates, 1, 32}, Case{Scheme::ordinates, 1, 16}, Case{Scheme::conservative, 1, 32},
        Case{Scheme::conservative, 2, 32}, Case{Scheme::gaitatzes2010, 1, 32}, Case{Scheme::gaitatzes2010, 2, 16},
        Case{Scheme::lpv2009, 1, 32}}) {
    for (const screen::Backend backend : {screen::Backend::gpu, screen::Backend::cpu}) {
      screen::FrameOptions o = options(c.scheme, backend);
      o.of<VolumeOptions>().scheme.sh_order = c.sh_order;
      o.of<VolumeOptions>().grid_cells = c.grid_cells;
      o.of<VolumeOptions>().iterations = 40;
      const bool on_gpu = backend == screen::Backend::gpu;
      const auto predicted = double(screen::volume_bytes_expected(scene_, o.of<VolumeOptions>(), on_gpu, o.size));
      const auto taken = double(report(scene_, o).memory_bytes);
      EXPECT_NEAR(predicted / taken, 1.0, 0.1) << "scheme " << int(c.scheme) << " order " << c.sh_order << " grid "
                                               << c.grid_cells << (on_gpu ? " GPU" : " CPU") << ", taken " << taken;
    }
  }
}

// Between what is taken and half of it every scheme is refused.
TEST_F(FrameVolumeGl, IsRefusedAboveTheLimit) {
  for (const Scheme scheme : {Scheme::ordinates, Scheme::conservative, Scheme::gaitatzes2010, Scheme::lpv2009}) {
    for (const screen::Backend backend : {screen::Backend::gpu, screen::Backend::cpu}) {
      screen::FrameOptions o = options(scheme, backend);
      o.of<VolumeOptions>().grid_cells = 16;
      const size_t taken = report(scene_, o).memory_bytes;
      o.of<VolumeOptions>().memory_limit = taken * 4 / 5;
      try {
        screen::Frame(scene_, o);
        ADD_FAILURE() << "not refused: scheme " << int(scheme);
      } catch (const Error& e) {
        EXPECT_EQ(e.code(), ExitCode::over_limit);
      }
      o.of<VolumeOptions>().memory_limit = taken * 6 / 5;
      EXPECT_NO_THROW(screen::Frame(scene_, o));
    }
  }
}

}  // namespace
}  // namespace volgi::test
