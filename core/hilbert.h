#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <utility>

namespace volgi {

/// Place of a point of the unit square along Hilbert's curve through 2^16 x 2^16 cells: what follows on the curve is
/// near, so that equal steps along it spread evenly over the square.
inline std::uint32_t hilbert_index(glm::vec2 at) {
  constexpr std::uint32_t kCells = 1u << 16;
  const glm::vec2 scaled = glm::clamp(at, 0.0f, 0.99999f) * float(kCells);
  auto x = std::uint32_t(scaled.x), y = std::uint32_t(scaled.y);
  std::uint32_t index = 0;
  for (std::uint32_t half = kCells / 2; half > 0; half /= 2) {
    const std::uint32_t right = (x & half) != 0 ? 1 : 0, upper = (y & half) != 0 ? 1 : 0;
    index += half * half * ((3 * right) ^ upper);
    if (upper == 0) {
      if (right == 1) {
        x = kCells - 1 - x;
        y = kCells - 1 - y;
      }
      std::swap(x, y);
    }
  }
  return index;
}

}  // namespace volgi
