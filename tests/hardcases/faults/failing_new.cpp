#include "tests/hardcases/faults/failing_new.h"

#include <cstdlib>
#include <new>

namespace volgi::test {

constinit FailingNew failing_new;

namespace {

void* allocate(std::size_t size, std::size_t alignment) {
  if (failing_new.counting && ++failing_new.count == failing_new.failing) throw std::bad_alloc();
  if (size == 0) size = 1;
  void* memory = alignment == 0 ? std::malloc(size)
                                : std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}

}  // namespace
}  // namespace volgi::test

void* operator new(std::size_t size) { return volgi::test::allocate(size, 0); }
void* operator new[](std::size_t size) { return volgi::test::allocate(size, 0); }
void* operator new(std::size_t size, std::align_val_t alignment) {
  return volgi::test::allocate(size, std::size_t(alignment));
}
void* operator new[](std::size_t size, std::align_val_t alignment) {
  return volgi::test::allocate(size, std::size_t(alignment));
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete[](void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::align_val_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t, std::align_val_t) noexcept { std::free(memory); }
