#include "apps/volgi/bench_timing.h"

#include <tbb/parallel_for.h>

#include <cstring>

namespace volgi::app {

double copy_ms(size_t bytes, int repeats) {
  constexpr size_t kPiece = 24 << 10;  // a leaf of lobes, as propagation moves memory
  const size_t pieces = (bytes + kPiece - 1) / kPiece;
  std::vector<char> from(pieces * kPiece, 1), to(pieces * kPiece, 2);
  return median_ms(repeats, [&] {
    tbb::parallel_for(size_t(0), pieces, [&](size_t p) { std::memcpy(&to[p * kPiece], &from[p * kPiece], kPiece); });
    from.swap(to);
  });
}

}  // namespace volgi::app
