#pragma once

namespace volgi {

/// shared::face_of_depth in integers, where baseline x86-64 has no instruction for floor.
inline int face_of_depth_quick(float depth) {
  const float scaled = depth * 8192.0f + 0.5f;
  const int truncated = int(scaled);
  return (truncated - (float(truncated) > scaled ? 1 : 0) + 4096) >> 13;
}

}  // namespace volgi
