#include "apps/bench/timing.h"

#include <tbb/parallel_for.h>

#include <cstring>

namespace volgi::app {

namespace {
constexpr size_t kPiece = 24 << 10;
}

Copying::Copying(size_t bytes)
    : pieces_((bytes + kPiece - 1) / kPiece), from_(pieces_ * kPiece, 1), to_(pieces_ * kPiece, 2) {}

void Copying::run() {
  tbb::parallel_for(size_t(0), pieces_, [&](size_t p) { std::memcpy(&to_[p * kPiece], &from_[p * kPiece], kPiece); });
  from_.swap(to_);
}

}  // namespace volgi::app
