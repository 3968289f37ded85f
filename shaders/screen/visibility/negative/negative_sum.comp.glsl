#version 450 core
// Sums the candidates' weights from the first on.
#include "screen/visibility/negative/negative_candidates.glsl"
#define SUMMED float
#define SUM_FIRST 0
#define SUM_COUNT candidate_count()
#include "screen/base/sum_in_order.glsl"
