#pragma once
#include <vector>

#include "core/gl/objects.h"

namespace volgi::screen {

/// Entries, one uint each, that one program lists and another works off, without the host: the list dispatches itself
/// (shaders/screen/base/work_list.glsl).
class WorkList {
 public:
  /// Room for so many entries.
  void reserve(size_t entries);
  /// Before a program lists: none yet.
  void clear() const;
  /// Storage binding of WorkListHead and the entries.
  void bind(GLuint binding) const { buffer_.bind_storage(binding); }
  /// The current program, a group for as many entries as APPEND_TO_LIST was told. After a barrier for storage and
  /// commands.
  void dispatch() const;
  /// Both wait for the GPU; after a frame, not in one.
  GLuint count() const;
  std::vector<GLuint> entries() const;
  size_t bytes() const { return buffer_.bytes(); }

 private:
  gl::Buffer buffer_;
};

}  // namespace volgi::screen
