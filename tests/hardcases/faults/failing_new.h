#pragma once
#include <atomic>

namespace volgi::test {

/// The program's operator new (failing_new.cpp), which can be told to fail.
struct FailingNew {
  std::atomic<bool> counting{false};
  std::atomic<long> count{0};    // since the counting began
  std::atomic<long> failing{0};  // the allocation that throws std::bad_alloc; 0: none
};
extern FailingNew failing_new;

}  // namespace volgi::test
