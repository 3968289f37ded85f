// core/gl: dispatches beyond the 65535 groups that GL promises, and sums of long lists.
#include <numeric>

#include "core/gl/limits.h"
#include "core/gl/program.h"
#include "core/gl/scan.h"
#include "shaders/shared/global_index.shared.h"
#include "tests/support/gl_test.h"

namespace volgi::test {
namespace {

using Dispatch = GlTest;

/// How often each number below `count` is global_index() of some invocation of a dispatch_linear.
std::vector<GLuint> visits(const std::string& layout, size_t group_size, size_t count) {
  const std::string source = "#version 450 core\n" + gl::shader_source("shared/global_index.shared.h") + layout +
                             R"(
layout(std430, binding = 0) buffer Visits { uint visits[]; };
uniform uint count;
void main() {
  if (global_index() < count) atomicAdd(visits[global_index()], 1u);
}
)";
  const char* text = source.c_str();
  const GLuint program = glCreateShaderProgramv(GL_COMPUTE_SHADER, 1, &text);
  const gl::Buffer seen(count * sizeof(GLuint));
  seen.clear();
  seen.bind_storage(0);
  glUseProgram(program);
  glUniform1ui(glGetUniformLocation(program, "count"), GLuint(count));
  gl::dispatch_linear(count, group_size);
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  auto all = seen.download<GLuint>(count);
  glUseProgram(0);
  glDeleteProgram(program);
  return all;
}

TEST_F(Dispatch, ReachesEachOfMoreThan65535GroupsOnce) {
  constexpr size_t groups = 70001;  // three rows, the last not full
  static_assert(groups > 65535 && groups % GROUPS_PER_ROW != 0);
  EXPECT_EQ(visits("layout(local_size_x = 1) in;", 1, groups), std::vector<GLuint>(groups, 1));
}

TEST_F(Dispatch, NumbersGroupsOfAnyShape) {
  constexpr size_t count = 6 * 70001 - 5;
  EXPECT_EQ(visits("layout(local_size_x = 3, local_size_y = 2) in;", 6, count), std::vector<GLuint>(count, 1));
  EXPECT_EQ(visits("layout(local_size_x = 64) in;", 64, 100), std::vector<GLuint>(100, 1));
}

ExitCode code_of(const std::function<void()>& run) {
  try {
    run();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("smaller grid"), std::string::npos) << error.what();
    return error.code();
  }
  return ExitCode::done;
}

TEST_F(Dispatch, RefusesMoreGroupsThanAnAxisTakes) {
  const GLint64 most = gl::limit(GL_MAX_COMPUTE_WORK_GROUP_COUNT, 1);
  ASSERT_GE(most, 65535);
  if (most < std::numeric_limits<int>::max()) {
    EXPECT_EQ(code_of([&] { gl::dispatch({1, int(most) + 1, 1}, {1, 1, 1}); }), ExitCode::over_limit);
  }
  EXPECT_EQ(code_of([] { gl::dispatch_linear(size_t(1) << 31, 64); }), ExitCode::over_limit);
  EXPECT_EQ(code_of([] { gl::dispatch_linear(0, 64); }), ExitCode::done);
}

TEST_F(Dispatch, ScansSumWhatComesBefore) {
  gl::Scan scan;
  for (const size_t count : {70000, 1, 255, 256, 257, 1000}) {  // buffers that are too large remain
    std::vector<GLuint> numbers(count);
    for (size_t i = 0; i < count; ++i) numbers[i] = GLuint(i * 2654435761u >> 22);
    std::vector<GLuint> right(count);
    std::exclusive_scan(numbers.begin(), numbers.end(), right.begin(), 0u);
    const gl::Buffer buffer(numbers);
    const gl::Buffer& total = scan.run(buffer, count);
    EXPECT_EQ(buffer.download<GLuint>(count), right) << count;
    EXPECT_EQ(total.download<GLuint>(1)[0], right.back() + numbers.back()) << count;
  }
}

}  // namespace
}  // namespace volgi::test
