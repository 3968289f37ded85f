#pragma once
#include <epoxy/gl.h>

#include <cstddef>
#include <deque>

#include "core/gl/objects.h"

namespace volgi::gl {

/// Until the GPU has come to `fence`. @throws Error(no_device) when GL says that it cannot wait.
void wait_for(GLsync fence);

/// Brings small results to the host without draining the GPU: push() queues a copy, pop() waits for the oldest copy
/// only, by when later work is already queued.
class Readback {
 public:
  /// @param bytes of one result; @param slots results that may be under way at once.
  Readback(size_t bytes, size_t slots);
  ~Readback();
  Readback(const Readback&) = delete;
  Readback& operator=(const Readback&) = delete;

  void push(const Buffer& from, size_t offset = 0);
  size_t pending() const { return waiting_.size(); }
  bool ready() const;   // pop() would not wait
  void pop(void* out);  // @throws Error(no_device) as wait_for
  void drop_all();

 private:
  struct Waiting {
    size_t slot;
    GLsync fence;
  };
  Buffer buffer_;
  const char* mapped_ = nullptr;
  size_t bytes_;
  size_t slots_;
  size_t next_ = 0;
  std::deque<Waiting> waiting_;
};

}  // namespace volgi::gl
