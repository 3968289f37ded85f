#include <array>

#include "core/gl/program_pool_internal.h"

namespace volgi::gl {
namespace {

/// What is set by value; samplers, images and counters have their bindings from the text.
enum class Kind { other, floats, ints, unsigneds, matrix3, matrix4 };
struct Uniform {
  Kind kind;
  int components;
};

Uniform uniform_of(GLenum type) {
  switch (type) {
    case GL_FLOAT:
      return {Kind::floats, 1};
    case GL_FLOAT_VEC2:
      return {Kind::floats, 2};
    case GL_FLOAT_VEC3:
      return {Kind::floats, 3};
    case GL_FLOAT_VEC4:
      return {Kind::floats, 4};
    case GL_INT:
    case GL_BOOL:
      return {Kind::ints, 1};
    case GL_INT_VEC2:
      return {Kind::ints, 2};
    case GL_INT_VEC3:
      return {Kind::ints, 3};
    case GL_UNSIGNED_INT:
      return {Kind::unsigneds, 1};
    case GL_FLOAT_MAT3:
      return {Kind::matrix3, 9};
    case GL_FLOAT_MAT4:
      return {Kind::matrix4, 16};
    default:
      return {Kind::other, 0};
  }
}

void set_to_zero(GLuint program, GLint location, Uniform uniform) {
  constexpr std::array<GLfloat, 16> floats{};
  constexpr std::array<GLint, 4> ints{};
  switch (uniform.kind) {
    case Kind::floats:
      if (uniform.components == 1) glProgramUniform1fv(program, location, 1, floats.data());
      if (uniform.components == 2) glProgramUniform2fv(program, location, 1, floats.data());
      if (uniform.components == 3) glProgramUniform3fv(program, location, 1, floats.data());
      if (uniform.components == 4) glProgramUniform4fv(program, location, 1, floats.data());
      break;
    case Kind::ints:
      if (uniform.components == 1) glProgramUniform1iv(program, location, 1, ints.data());
      if (uniform.components == 2) glProgramUniform2iv(program, location, 1, ints.data());
      if (uniform.components == 3) glProgramUniform3iv(program, location, 1, ints.data());
      break;
    case Kind::unsigneds:
      glProgramUniform1ui(program, location, 0);
      break;
    case Kind::matrix3:
      glProgramUniformMatrix3fv(program, location, 1, GL_FALSE, floats.data());
      break;
    case Kind::matrix4:
      glProgramUniformMatrix4fv(program, location, 1, GL_FALSE, floats.data());
      break;
    case Kind::other:
      break;
  }
}

/// GL starts them at zero, and no shader of ours says otherwise.
void reset_uniforms(GLuint program) {
  GLint count = 0;
  glGetProgramiv(program, GL_ACTIVE_UNIFORMS, &count);
  for (GLint i = 0; i < count; ++i) {
    std::array<char, 256> name{};
    GLint elements = 0;
    GLenum type = 0;
    glGetActiveUniform(program, GLuint(i), GLsizei(name.size()), nullptr, &elements, &type, name.data());
    const GLint first = glGetUniformLocation(program, name.data());
    if (first < 0) continue;  // in a block
    // Elements of an array of basic type have consecutive locations.
    for (GLint k = 0; k < elements; ++k) set_to_zero(program, first + k, uniform_of(type));
  }
}

}  // namespace

GLuint ProgramPool::take(const std::string& key) {
  const auto found = free_.find(key);
  if (found == free_.end() || found->second.empty()) return 0;
  const GLuint program = found->second.back();
  found->second.pop_back();
  reset_uniforms(program);
  return program;
}

void ProgramPool::give_back(const std::string& key, GLuint program) { free_[key].push_back(program); }

}  // namespace volgi::gl
