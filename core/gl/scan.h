#pragma once
#include <vector>

#include "core/gl/objects.h"
#include "core/gl/program.h"

namespace volgi::gl {

/// Sums of whole numbers from the first on, on the GPU: each of a list becomes the sum of those before it. Blocks of
/// 256 are summed at once, then their sums in the same way, and added. Cost: two passes over the list.
class Scan {
 public:
  Scan();

  /// @param numbers  uint; written by shaders before a storage barrier, and to be read behind another.
  /// @returns a buffer whose first uint is the sum of all; behind a barrier as well.
  const Buffer& run(const Buffer& numbers, size_t count);
  size_t bytes() const;

 private:
  Program scan_, add_;
  std::vector<Buffer> block_sums_;  // of the list, of those sums, ...
};

}  // namespace volgi::gl
