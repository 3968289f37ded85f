#version 450 core
// Sums the candidates' weights from the first on.
#include "screen/lights/resample/light_candidates.glsl"
#define SUMMED vec2
#define SUM_FIRST first_candidate
#define SUM_COUNT candidate_count
#include "screen/base/sum_in_order.glsl"
