#pragma once
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>

#include <glm/glm.hpp>
#include <vector>

namespace volgi {

/// Loops over sides on all threads. Blocks are the same for any number of threads, and so are sums: each block's terms
/// are added up in order, then the blocks in theirs.
constexpr size_t kSideBlock = 2048;

template <class Body>
void for_each_side(size_t count, const Body& body) {
  oneapi::tbb::parallel_for(size_t(0), (count + kSideBlock - 1) / kSideBlock, [&](size_t block) {
    const size_t last = std::min(count, (block + 1) * kSideBlock);
    for (size_t i = block * kSideBlock; i < last; ++i) body(i);
  });
}

/// Sum of term(i), a glm::dvec3.
template <class Term>
glm::dvec3 sum_over_sides(size_t count, const Term& term) {
  std::vector<glm::dvec3> partial((count + kSideBlock - 1) / kSideBlock, glm::dvec3(0.0));
  oneapi::tbb::parallel_for(size_t(0), partial.size(), [&](size_t block) {
    const size_t last = std::min(count, (block + 1) * kSideBlock);
    for (size_t i = block * kSideBlock; i < last; ++i) partial[block] += term(i);
  });
  glm::dvec3 sum(0.0);
  for (const glm::dvec3& p : partial) sum += p;
  return sum;
}

}  // namespace volgi
