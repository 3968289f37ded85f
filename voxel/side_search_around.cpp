#include "voxel/side_search_around.h"

#include <algorithm>
#include <cstdint>
#include <cstring>

#include "voxel/side_search_internal.h"

namespace volgi {

unsigned columns_around_baseline(const AroundQuery& q, AroundColumns& out) {
  unsigned found = 0;
  for (int k = 0; k < 8; ++k) {
    const int nine = k < 4 ? k : k + 1, i = nine % 3 - 1, j = nine / 3 - 1;
    const float depth = q.point + (q.slope_b * (q.point_b - (q.low_b + float(i)) - 0.5f) +
                                   q.slope_c * (q.point_c - (q.low_c + float(j)) - 0.5f));
    if (!(std::max(q.low - depth, depth - (q.low + 1.0f)) <= q.farthest)) continue;
    out.depth[k] = depth;
    out.face[k] = face_of_depth_quick(depth, q.to_face);
    for (int way = 0; way < 2; ++way) {
      const int first = out.face[k] - q.below[way];
      std::uint32_t word;
      std::memcpy(&word, q.own_bytes[way] + (i * q.stride_b + j * q.stride_c + (first >> 3)), sizeof word);
      out.three[way][k] = word >> (first & 7) & 7u;
      if (out.three[way][k] != 0) found |= 1u << (k + 8 * way);
    }
  }
  return found;
}

ColumnsAround columns_around() {
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx2") != 0) return columns_around_avx2;
#endif
  return columns_around_baseline;
}

}  // namespace volgi
