// core/gl: the embedded shaders, objects, pass times.
#include <array>
#include <chrono>
#include <limits>
#include <thread>

#include "core/gl/objects.h"
#include "core/gl/pass_timer.h"
#include "core/gl/shader_source.h"
#include "tests/support/gl_test.h"

namespace volgi::test {
namespace {

size_t count(const std::string& text, std::string_view part) {
  size_t n = 0;
  for (size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++n;
  return n;
}

TEST(ShaderSource, IncludesEachFileOnceAndKeepsLineNumbers) {
  const std::string text = gl::expand_shader("screen/base/direct.frag.glsl", "#define A 1\n");
  EXPECT_TRUE(text.starts_with("#version 450 core\n#define A 1\n"));
  EXPECT_EQ(count(text, "//file "), 11u) << gl::file_legend(text);
  EXPECT_EQ(count(text, "struct PunctualLight {"), 1u);
  EXPECT_EQ(count(text, "#include"), 0u);
  EXPECT_TRUE(gl::file_legend(text).starts_with("0 screen/base/direct.frag.glsl, 1 shared/constants.glsl"));
}

TEST(ShaderSource, NamesAMissingFile) {
  try {
    gl::expand_shader("screen/nonesuch.frag.glsl");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::no_device);
    EXPECT_NE(std::string(error.what()).find("screen/nonesuch.frag.glsl"), std::string::npos);
  }
}

using Gl = GlTest;

TEST_F(Gl, DeviceThatDoesNotExist) {
  try {
    const gl::Context other({.device = 1000});
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::usage);
  }
}

TEST_F(Gl, RefusesWhatExceedsTheLimits) {
  const auto code_of = [](auto make) {
    try {
      make();
    } catch (const Error& error) {
      return error.code();
    }
    return ExitCode::done;
  };
  EXPECT_EQ(code_of([] { gl::Buffer(size_t(1) << 40); }), ExitCode::over_limit);
  EXPECT_EQ(code_of([] { gl::Texture::make_2d(GL_R8, 1 << 20, 1); }), ExitCode::over_limit);
  EXPECT_EQ(code_of([] { gl::Texture::make_3d(GL_R8, {1, 1, 1 << 20}); }), ExitCode::over_limit);
}

TEST_F(Gl, BuffersKeepWhatIsWritten) {
  const std::vector<int> values{1, 2, 3, 4, 5};
  const gl::Buffer buffer(values);
  EXPECT_EQ(buffer.download<int>(5), values);
  buffer.upload(values.data(), 2 * sizeof(int), 3 * sizeof(int));
  EXPECT_EQ(buffer.download<int>(2, 3 * sizeof(int)), (std::vector<int>{1, 2}));
  buffer.clear();
  EXPECT_EQ(buffer.download<int>(5), std::vector<int>(5, 0));
  EXPECT_EQ(gl::Buffer(0).bytes(), 16u);
}

TEST_F(Gl, TexturesClearAndReadBack) {
  const gl::Texture colour = gl::Texture::make_2d(GL_RGBA32F, 3, 2);
  colour.clear({0.5f, 1.0f, -2.0f, 0.0f});
  EXPECT_EQ(colour.download(3)[5], -2.0f);
  const gl::Texture ids = gl::Texture::make_2d(GL_R32UI, 3, 2);
  ids.clear({70000.0f, 0, 0, 0});
  EXPECT_EQ(ids.download(1), std::vector<float>(6, 70000.0f));
}

TEST_F(Gl, WallClockPassTimesAddUpWithinAFrame) {
  gl::PassTimer timer(/*software=*/true, /*timing=*/true);
  for (int frame = 0; frame < 3; ++frame) {
    timer.begin_frame();
    for (const char* name : {"a", "b", "a"}) {
      const auto scope = timer.scope(name);
      std::this_thread::sleep_for(std::chrono::milliseconds(4));
    }
    timer.end_frame();
  }
  const auto passes = timer.medians();
  ASSERT_EQ(passes.size(), 2u);
  EXPECT_EQ(passes[0].name, "a");
  EXPECT_GE(passes[0].gpu_ms, 8.0);
  EXPECT_GE(passes[1].gpu_ms, 4.0);
  EXPECT_LT(passes[1].gpu_ms, passes[0].gpu_ms);
  EXPECT_GE(timer.frame_time().median_ms, 12.0);
  timer.reset();
  EXPECT_TRUE(timer.medians().empty());
  EXPECT_EQ(timer.frame_time().max_ms, 0.0);
}

TEST_F(Gl, WithoutTimingNothingIsRecordedInSoftware) {
  gl::PassTimer timer(/*software=*/true, /*timing=*/false);
  timer.begin_frame();
  { const auto scope = timer.scope("a"); }
  timer.end_frame();
  EXPECT_TRUE(timer.medians().empty());
}

// The hardware path, wherever it runs: llvmpipe answers queries, if wrongly.
TEST_F(Gl, TimerQueriesAreReadBack) {
  gl::PassTimer timer(/*software=*/false, /*timing=*/false);
  for (int frame = 0; frame < 40; ++frame) {
    timer.begin_frame();
    {
      const auto scope = timer.scope("draw");
      gl::Texture::make_2d(GL_RGBA32F, 64, 64).clear({0, 0, 0, 0});
    }
    timer.end_frame();
  }
  const auto passes = timer.medians();
  ASSERT_EQ(passes.size(), 1u);
  EXPECT_GE(passes[0].gpu_ms, 0.0);
  EXPECT_LT(passes[0].gpu_ms, 1000.0);
  EXPECT_EQ(timer.kind(), gl::PassTimer::Kind::gpu);
}

}  // namespace
}  // namespace volgi::test
