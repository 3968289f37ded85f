#pragma once
#include <array>

namespace volgi {

/// Octants by number, bit a set where they go up axis a, in the order in which several ranks begin them: from two
/// opposite corners of the ranks' y and z, then from the other two.
constexpr std::array<int, 8> kOppositeCorners{6, 7, 0, 1, 2, 3, 4, 5};

}  // namespace volgi
