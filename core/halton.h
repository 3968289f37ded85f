#pragma once
#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <glm/gtc/constants.hpp>
#include <vector>

namespace volgi {

/// Phi_b(i): the digits of i in base b, mirrored at the point; in [0, 1).
inline double radical_inverse(unsigned base, std::uint64_t i) {
  assert(base >= 2);
  double inverse = 0.0;
  double digit = 1.0;
  for (; i > 0; i /= base) {
    digit /= base;
    inverse += digit * double(i % base);
  }
  return inverse;
}

/// Point i = 1, 2, ... of the Halton sequence in bases 2 and 3.
inline glm::dvec2 halton(std::uint64_t i) { return {radical_inverse(2, i), radical_inverse(3, i)}; }

/// The first `count` Halton points of the unit sphere that lie in the cone about -Y with 1 - cos(half angle) =
/// `cone_height`, in (0, 2]: phi = 2 pi Phi_2(i), sin(delta) = 2 Phi_3(i) - 1. Cochran and Steele 2007, §3.1; we
/// depart: the pole of the sphere is the cone's axis, so that the points are the same wherever the cone turns. Then a
/// point is inside when Phi_3(i) >= 1 - cone_height / 2, which needs the last digits of i in base 3 to be 2s, as many
/// as the bound begins with: only those i are tried, and fewer than three for every point that is taken.
/// @param skip  as many points that come before, but for those few by which an even share of them errs.
inline std::vector<glm::vec3> halton_directions_in_cone(double cone_height, int count, std::uint64_t skip = 0) {
  assert(cone_height > 0.0 && cone_height <= 2.0);
  cone_height = std::max(cone_height, 1e-10);  // 1e-5 rad; indices stay below 2^63
  std::uint64_t stride = 1;
  while (double(stride) * 3.0 * cone_height <= 2.0) stride *= 3;
  std::vector<glm::vec3> directions;
  directions.reserve(size_t(count));
  const std::uint64_t first = stride > 1 ? stride - 1 : 1;
  const auto skipped = std::uint64_t(std::llround(double(skip) / (0.5 * cone_height * double(stride))));
  for (std::uint64_t i = first + stride * skipped; directions.size() < size_t(count); i += stride) {
    const double height = 2.0 * (1.0 - radical_inverse(3, i));  // 1 - sin(delta)
    if (height > cone_height) continue;
    const double phi = 2.0 * glm::pi<double>() * radical_inverse(2, i);
    const double across = std::sqrt(height * (2.0 - height));
    directions.emplace_back(across * std::sin(phi), height - 1.0, across * std::cos(phi));
  }
  return directions;
}

}  // namespace volgi
