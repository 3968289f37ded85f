// core/gl: OpenGL's errors end what is going on, whatever kind of context.
#include "core/gl/context.h"

#include "core/gl/limits.h"
#include "core/gl/objects.h"
#include "core/gl/pass_timer.h"
#include "core/gl/readback.h"
#include "tests/support/gl_test.h"

namespace volgi::test {
namespace {

/// Contexts of their own, since the one of all tests must see no error. True: with debug messages.
class GlErrors : public GlTest, public testing::WithParamInterface<bool> {
 protected:
  void SetUp() override {
    GlTest::SetUp();
    if (!IsSkipped()) own_ = std::make_unique<gl::Context>(gl::ContextOptions{.debug = GetParam()});
  }
  void TearDown() override {
    own_.reset();
    GlTest::TearDown();
  }
  std::unique_ptr<gl::Context> own_;
};

template <class F>
std::string expect_no_device(const F& run) {
  try {
    run();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::no_device) << error.what();
    return error.what();
  }
  ADD_FAILURE() << "no error was thrown";
  return {};
}

TEST_P(GlErrors, EndTheFrame) {
  gl::PassTimer timer(/*software=*/true, /*timing=*/false);
  timer.begin_frame();
  glEnable(GL_TEXTURE_2D_ARRAY);
  const std::string message = expect_no_device([&] { timer.end_frame(); });
  EXPECT_NE(message.find("GL_INVALID_ENUM"), std::string::npos) << message;
  timer.begin_frame();
  timer.end_frame();  // said once
}

TEST_P(GlErrors, EndADownload) {
  const gl::Buffer buffer(sizeof(int));
  const gl::Texture texture = gl::Texture::make_2d(GL_R8, 1, 1);
  glDispatchCompute(1, 1, 1);  // without a program
  expect_no_device([&] { buffer.download<int>(1); });
  glDispatchCompute(1, 1, 1);
  expect_no_device([&] { texture.download(1); });
  EXPECT_EQ(buffer.download<int>(1).size(), 1u);
}

TEST_P(GlErrors, AreNotSwallowedByTheNextObject) {
  glEnable(GL_TEXTURE_2D_ARRAY);
  const gl::Buffer buffer(16);  // looks for GL_OUT_OF_MEMORY
  expect_no_device([] { gl::throw_on_error(); });
}

TEST_P(GlErrors, WaitingThatFailsIsNoSuccess) {
  expect_no_device([] { gl::wait_for(nullptr); });
  expect_no_device([] { gl::throw_on_error(); });
}

TEST_P(GlErrors, AreCountedInDebugContextsOnly) {
  glEnable(GL_TEXTURE_2D_ARRAY);
  EXPECT_EQ(own_->debug_errors(), GetParam() ? 1 : 0);
  expect_no_device([] { gl::throw_on_error(); });
}

INSTANTIATE_TEST_SUITE_P(, GlErrors, testing::Bool(),
                         [](const auto& test) { return test.param ? "Debug" : "WithoutDebug"; });

using Contexts = GlTest;

TEST_F(Contexts, DebugOnlyWhereItIsAskedFor) {
  const auto flags = [] {
    GLint bits = 0;
    glGetIntegerv(GL_CONTEXT_FLAGS, &bits);
    return bits & GL_CONTEXT_FLAG_DEBUG_BIT;
  };
  EXPECT_NE(flags(), 0);
  {
    const gl::Context plain;
    EXPECT_EQ(flags(), 0);
  }
  EXPECT_NE(flags(), 0) << "the context before must be current again";
}

TEST_F(Contexts, EndInAnyOrder) {
  const auto current_limits = [] { return gl::limit(GL_MAX_TEXTURE_SIZE); };
  auto first = std::make_unique<gl::Context>();
  auto second = std::make_unique<gl::Context>();
  first.reset();
  EXPECT_GT(current_limits(), 0);
  second.reset();
  EXPECT_GT(current_limits(), 0);
  EXPECT_NO_THROW(gl::throw_on_error());
}

TEST_F(Contexts, FormatsThatCannotBeRenderedToAreReplaced) {
  EXPECT_EQ(gl::renderable_format(GL_RGBA32F, GL_R8), GLenum(GL_RGBA32F));
  EXPECT_EQ(gl::renderable_format(GL_COMPRESSED_RED_RGTC1, GL_R8), GLenum(GL_R8));
}

}  // namespace
}  // namespace volgi::test
