#pragma once
#include <cstddef>

#include "core/gl/objects.h"

namespace volgi::screen {

/// Attributes that vertex shaders read once an instance, from buffers of structs: GL promises no storage to them.
class Instances {
 public:
  Instances() {
    GLuint id = 0;
    glCreateVertexArrays(1, &id);
    gl::count_object();
    array_ = gl::VertexArray(id);
  }
  /// @param binding  that read() gives a buffer to. @param offset  in its struct [bytes].
  void add_floats(GLuint attribute, int count, GLuint binding, size_t offset) const {
    glVertexArrayAttribFormat(array_.id(), attribute, count, GL_FLOAT, GL_FALSE, GLuint(offset));
    enable(attribute, binding);
  }
  void add_integers(GLuint attribute, int count, GLuint binding, size_t offset) const {
    glVertexArrayAttribIFormat(array_.id(), attribute, count, GL_INT, GLuint(offset));
    enable(attribute, binding);
  }
  /// @param stride  [bytes]; 0: all instances read the first one.
  void read(GLuint binding, const gl::Buffer& buffer, size_t stride) const {
    glVertexArrayVertexBuffer(array_.id(), binding, buffer.id(), 0, GLsizei(stride));
    glVertexArrayBindingDivisor(array_.id(), binding, 1);
  }
  GLuint id() const { return array_.id(); }

 private:
  void enable(GLuint attribute, GLuint binding) const {
    glVertexArrayAttribBinding(array_.id(), attribute, binding);
    glEnableVertexArrayAttrib(array_.id(), attribute);
  }
  gl::VertexArray array_;
};

}  // namespace volgi::screen
