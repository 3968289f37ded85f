#include "screen/base/work_list.h"

#include "core/gl/program.h"
#include "shaders/screen/base/work_list.shared.h"

namespace volgi::screen {

using shared::WorkListHead;

void WorkList::reserve(size_t entries) { gl::reserve(buffer_, sizeof(WorkListHead) + entries * sizeof(GLuint)); }

void WorkList::clear() const {
  constexpr WorkListHead EMPTY{0, 1, 1, 0};
  buffer_.upload(&EMPTY, sizeof EMPTY);
}

void WorkList::dispatch() const { gl::dispatch_indirect(buffer_); }

GLuint WorkList::count() const { return buffer_.download<WorkListHead>(1).front().count; }

std::vector<GLuint> WorkList::entries() const { return buffer_.download<GLuint>(count(), sizeof(WorkListHead)); }

}  // namespace volgi::screen
