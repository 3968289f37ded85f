#pragma once
#include "shaders/shared/grid.shared.h"

namespace volgi {

/// What face_of_depth_quick adds before it divides: by falls_below_centre().
inline int steps_to_face(bool below_centre) { return SLICE_STEPS / 2 - (below_centre ? 1 : 0); }

/// shared::face_of_depth in integers, where baseline x86-64 has no instruction for floor.
inline int face_of_depth_quick(float depth, int to_face) {
  constexpr int above = 16;  // cells that depths are under the grid at most
  const float scaled = depth * float(SLICE_STEPS) + 0.5f;
  const int truncated = int(scaled);
  const int steps = truncated - (float(truncated) > scaled ? 1 : 0);
  return int(unsigned(steps + to_face + above * SLICE_STEPS) / unsigned(SLICE_STEPS)) - above;
}

}  // namespace volgi
