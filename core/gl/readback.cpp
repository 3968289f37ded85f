#include "core/gl/readback.h"

#include <cassert>
#include <cstring>

#include "core/error.h"

namespace volgi::gl {

namespace {
constexpr GLbitfield kMap = GL_MAP_READ_BIT | GL_MAP_PERSISTENT_BIT | GL_MAP_COHERENT_BIT;
}

void wait_for(GLsync fence) {
  constexpr GLuint64 second_ns = 1'000'000'000;
  GLenum status = GL_TIMEOUT_EXPIRED;
  while (status == GL_TIMEOUT_EXPIRED) status = glClientWaitSync(fence, GL_SYNC_FLUSH_COMMANDS_BIT, second_ns);
  if (status != GL_WAIT_FAILED) return;
  throw Error(ExitCode::no_device, "OpenGL failed to wait for a result of the GPU; use --backend cpu");
}

Readback::Readback(size_t bytes, size_t slots) : buffer_(bytes * slots, nullptr, kMap), bytes_(bytes), slots_(slots) {
  mapped_ = static_cast<const char*>(glMapNamedBufferRange(buffer_.id(), 0, GLsizeiptr(bytes * slots), kMap));
}

Readback::~Readback() {
  drop_all();
  glUnmapNamedBuffer(buffer_.id());
}

void Readback::push(const Buffer& from, size_t offset) {
  assert(waiting_.size() < slots_);
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT | GL_CLIENT_MAPPED_BUFFER_BARRIER_BIT);
  glCopyNamedBufferSubData(from.id(), buffer_.id(), GLintptr(offset), GLintptr(next_ * bytes_), GLsizeiptr(bytes_));
  waiting_.push_back({next_, glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0)});
  next_ = (next_ + 1) % slots_;
}

bool Readback::ready() const {
  if (waiting_.empty()) return false;
  const GLenum status = glClientWaitSync(waiting_.front().fence, GL_SYNC_FLUSH_COMMANDS_BIT, 0);
  return status == GL_ALREADY_SIGNALED || status == GL_CONDITION_SATISFIED;
}

void Readback::pop(void* out) {
  assert(!waiting_.empty());
  Waiting w = waiting_.front();
  waiting_.pop_front();
  wait_for(w.fence);
  glDeleteSync(w.fence);
  std::memcpy(out, mapped_ + w.slot * bytes_, bytes_);
}

void Readback::drop_all() {
  for (Waiting& w : waiting_) glDeleteSync(w.fence);
  waiting_.clear();
}

}  // namespace volgi::gl
