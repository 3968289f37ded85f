#include "voxel/side_search_around.h"

#ifdef __AVX2__
#include <immintrin.h>

namespace volgi {

namespace {

constexpr float kSteps = 384.0f;  // SLICE_STEPS

/// shared::face_of_depth.
__m256i faces_of_depths(__m256 depth, int to_face) {
  const __m256 scaled = _mm256_add_ps(_mm256_mul_ps(depth, _mm256_set1_ps(kSteps)), _mm256_set1_ps(0.5f));
  const __m256 to_next = _mm256_add_ps(_mm256_floor_ps(scaled), _mm256_set1_ps(float(to_face) + 0.5f));
  return _mm256_cvttps_epi32(_mm256_floor_ps(_mm256_mul_ps(to_next, _mm256_set1_ps(1.0f / kSteps))));
}

__m256 part_of_depth(float point, float low, float slope, __m256i step) {
  const __m256 of_column = _mm256_add_ps(_mm256_set1_ps(low), _mm256_cvtepi32_ps(step));
  const __m256 from_centre = _mm256_sub_ps(_mm256_sub_ps(_mm256_set1_ps(point), of_column), _mm256_set1_ps(0.5f));
  return _mm256_mul_ps(_mm256_set1_ps(slope), from_centre);
}

}  // namespace

unsigned columns_around_avx2(const AroundQuery& q, AroundColumns& out) {
  const __m256i step_b = _mm256_setr_epi32(-1, 0, 1, -1, 1, -1, 0, 1);
  const __m256i step_c = _mm256_setr_epi32(-1, -1, -1, 0, 0, 1, 1, 1);
  const __m256 depth =
      _mm256_add_ps(_mm256_set1_ps(q.point), _mm256_add_ps(part_of_depth(q.point_b, q.low_b, q.slope_b, step_b),
                                                           part_of_depth(q.point_c, q.low_c, q.slope_c, step_c)));
  const __m256 outside =
      _mm256_max_ps(_mm256_sub_ps(_mm256_set1_ps(q.low), depth), _mm256_sub_ps(depth, _mm256_set1_ps(q.low + 1.0f)));
  const __m256i reached = _mm256_castps_si256(_mm256_cmp_ps(outside, _mm256_set1_ps(q.farthest), _CMP_LE_OQ));
  const __m256i face = faces_of_depths(depth, q.to_face);
  _mm256_storeu_ps(out.depth, depth);
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(out.face), face);
  const __m256i columns = _mm256_add_epi32(_mm256_mullo_epi32(step_b, _mm256_set1_epi32(q.stride_b)),
                                           _mm256_mullo_epi32(step_c, _mm256_set1_epi32(q.stride_c)));
  unsigned found = 0;
  for (int way = 0; way < 2; ++way) {
    const __m256i first = _mm256_sub_epi32(face, _mm256_set1_epi32(q.below[way]));
    const __m256i at = _mm256_add_epi32(columns, _mm256_srai_epi32(first, 3));
    const __m256i words = _mm256_mask_i32gather_epi32(_mm256_setzero_si256(),
                                                      reinterpret_cast<const int*>(q.own_bytes[way]), at, reached, 1);
    const __m256i shifted = _mm256_srlv_epi32(words, _mm256_and_si256(first, _mm256_set1_epi32(7)));
    const __m256i three = _mm256_and_si256(shifted, _mm256_set1_epi32(7));
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(out.three[way]), three);
    const __m256i some = _mm256_cmpgt_epi32(three, _mm256_setzero_si256());
    found |= unsigned(_mm256_movemask_ps(_mm256_castsi256_ps(some))) << (8 * way);
  }
  return found;
}

}  // namespace volgi
#endif
