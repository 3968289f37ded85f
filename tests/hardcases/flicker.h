#pragma once
// How much of a picture changes from frame to frame: the case "flicker" of docs/hard-cases.md.
#include <algorithm>
#include <optional>
#include <vector>

#include "reference/metrics.h"

namespace volgi::test {

/// Largest and median c_k: block error of a frame against the one before.
struct Flicker {
  std::vector<double> changes;
  std::optional<Image> last;
  void add(const Image& image) {
    const Mask all(image.pixels.size(), 1);
    if (last) changes.push_back(measure(*last, image, nullptr, all).relative.value().blk_pct.value());
    last = image;
  }
  double median() const {
    std::vector<double> sorted = changes;
    std::sort(sorted.begin(), sorted.end());
    return sorted[sorted.size() / 2];
  }
  double largest() const { return *std::max_element(changes.begin(), changes.end()); }
};

}  // namespace volgi::test
