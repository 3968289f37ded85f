#include "core/gl/pass_timer.h"
#include "core/gl/program.h"
#include "tests/support/gl_test.h"

namespace volgi::gl {
namespace {

using test::GlTest;

class ProgramPoolTest : public GlTest {};
class PassTimerTest : public GlTest {};

Program some_program(const std::vector<std::string>& defines = {}) {
  return Program::compute("screen/display/exposure_meter.comp.glsl", defines);
}

TEST_F(ProgramPoolTest, WhatIsNoLongerUsedIsTakenAgain) {
  const GLuint first = some_program().id();
  const std::uint64_t made = objects_made();
  const Program again = some_program();
  EXPECT_EQ(again.id(), first);
  EXPECT_EQ(objects_made(), made);
  const Program beside = some_program();  // it is lent to one owner at a time
  EXPECT_NE(beside.id(), again.id());
  const Program other = some_program({"OTHER 1"});
  EXPECT_NE(other.id(), again.id());
}

TEST_F(ProgramPoolTest, UniformsAreZeroAgain) {
  GLuint id = 0;
  {
    const Program program = Program::raster("shared/fullscreen.vert.glsl", "screen/display/present.frag.glsl");
    program.set("exposure", 3.5f);
    id = program.id();
  }
  const Program again = Program::raster("shared/fullscreen.vert.glsl", "screen/display/present.frag.glsl");
  ASSERT_EQ(again.id(), id);
  float exposure = -1.0f;
  glGetUniformfv(id, glGetUniformLocation(id, "exposure"), &exposure);
  EXPECT_EQ(exposure, 0.0f);
}

TEST_F(PassTimerTest, LatestIsTheLastFrameThatIsKnown) {
  PassTimer timer(context().software(), true);
  EXPECT_TRUE(timer.latest().empty());
  for (const char* name : {"a/first", "a/second"}) {
    timer.begin_frame();
    { const auto scope = timer.scope(name); }
    { const auto scope = timer.scope("a/both"); }
    { const auto scope = timer.scope("a/both"); }
    timer.end_frame();
  }
  glFinish();
  timer.medians();  // waits for queries
  const auto times = timer.latest();
  ASSERT_EQ(times.size(), 2u);
  EXPECT_EQ(times[0].name, "a/second");
  EXPECT_EQ(times[1].name, "a/both");
  EXPECT_GE(times[1].gpu_ms, 0.0);
}

}  // namespace
}  // namespace volgi::gl
