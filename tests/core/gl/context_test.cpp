// core/gl: OpenGL's errors end what is going on, whatever kind of context; limits are compared and named.
#include "core/gl/context.h"

#include <regex>

#include "core/gl/limits.h"
#include "core/gl/objects.h"
#include "core/gl/pass_timer.h"
#include "core/gl/readback.h"
#include "core/gl/shader_source.h"
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

TEST(Limits, NameWhatFallsShort) {
  constexpr std::array needed{gl::Limit{GL_MAX_IMAGE_UNITS, "GL_MAX_IMAGE_UNITS", 4, "screen/a"},
                              gl::Limit{GL_MAX_UNIFORM_BLOCK_SIZE, "GL_MAX_UNIFORM_BLOCK_SIZE", 65536, "screen/b"}};
  const auto shortage = [&](GLint64 block) {
    return gl::first_shortage(needed, [&](GLenum name) { return name == GL_MAX_IMAGE_UNITS ? GLint64(4) : block; });
  };
  EXPECT_EQ(shortage(65536), "");
  EXPECT_EQ(shortage(16384), "GL_MAX_UNIFORM_BLOCK_SIZE is 16384, and screen/b needs 65536");
}

/// What GL 4.5 promises would not do: such a driver is refused by name.
TEST(Limits, OfThePromisedMinimumAreNotEnough) {
  const std::string shortage = gl::first_shortage(gl::needed_limits(), [](GLenum name) -> GLint64 {
    switch (name) {
      case GL_MAX_SHADER_STORAGE_BUFFER_BINDINGS:
        return 8;
      default:
        return 1 << 20;
    }
  });
  EXPECT_EQ(shortage.find("GL_MAX_SHADER_STORAGE_BUFFER_BINDINGS is 8"), 0u) << shortage;
}

GLint64 need_of(GLenum name) {
  for (const gl::Limit& limit : gl::needed_limits()) {
    if (limit.name == name) return limit.need;
  }
  ADD_FAILURE() << "not in the table: " << name;
  return 0;
}

struct Declared {
  int end = 0, count = 0;  // the binding behind the last, and how many
};

Declared declared(const std::string& text, const std::regex& pattern) {
  Declared all;
  for (std::sregex_iterator it(text.begin(), text.end(), pattern), none; it != none; ++it) {
    const int size = (*it)[2].length() > 0 ? std::stoi((*it)[2]) : 1;  // of an array of blocks
    all.end = std::max(all.end, std::stoi((*it)[1]) + size);
    all.count += size;
  }
  return all;
}

/// What a stage declares, in all of its variants together: an upper bound of what is active.
void expect_within_limits(const std::string& name, const std::string& text) {
  static const std::regex storage(R"(layout\(std430, binding = (\d+)\)[^;{]*buffer[^}]*\}\s*\w*(?:\[(\d+)\])?;)");
  static const std::regex uniform(R"(layout\(std140, binding = (\d+)\)\s*uniform\b()?)");
  static const std::regex image(R"(layout\([^)]*binding = (\d+)[^)]*\)[^;]*image\w+ \w+()?;)");
  static const std::regex sampler(R"(layout\([^)]*binding = (\d+)[^)]*\)[^;]*sampler\w+ \w+()?;)");
  const bool compute = name.ends_with(".comp.glsl");
  SCOPED_TRACE(name);
  const Declared buffers = declared(text, storage);
  EXPECT_LE(buffers.end, need_of(GL_MAX_SHADER_STORAGE_BUFFER_BINDINGS));
  EXPECT_LE(buffers.count,
            need_of(compute ? GL_MAX_COMPUTE_SHADER_STORAGE_BLOCKS : GL_MAX_FRAGMENT_SHADER_STORAGE_BLOCKS));
  EXPECT_LE(declared(text, uniform).count, need_of(GL_MAX_COMPUTE_UNIFORM_BLOCKS));
  EXPECT_LE(declared(text, image).end, need_of(GL_MAX_IMAGE_UNITS));
  EXPECT_LE(declared(text, image).count, need_of(GL_MAX_COMPUTE_IMAGE_UNIFORMS));
  EXPECT_LE(declared(text, sampler).end,
            need_of(compute ? GL_MAX_COMPUTE_TEXTURE_IMAGE_UNITS : GL_MAX_TEXTURE_IMAGE_UNITS));
}

TEST(Limits, CoverWhatShadersDeclare) {
  int buffers = 0;
  for (const gl::ShaderFile& file : gl::shader_files()) {
    const std::string name(file.name);
    const bool stage = name.ends_with(".comp.glsl") || name.ends_with(".frag.glsl");
    if (!stage || name.starts_with("voxel/single_pass")) continue;  // that one is tried, and left where it does not fit
    const std::string text = gl::expand_shader(file.name);
    expect_within_limits(name, text);
    buffers += text.find("std430") != std::string::npos;
  }
  EXPECT_GT(buffers, 40) << "the patterns must find something";
}

TEST_F(Contexts, FormatsThatCannotBeRenderedToAreReplaced) {
  EXPECT_EQ(gl::renderable_format(GL_RGBA32F, GL_R8), GLenum(GL_RGBA32F));
  EXPECT_EQ(gl::renderable_format(GL_COMPRESSED_RED_RGTC1, GL_R8), GLenum(GL_R8));
}

}  // namespace
}  // namespace volgi::test
