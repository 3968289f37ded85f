#version 450 core
// Systematic resampling: the candidates that equal steps through the summed weights meet.
#include "screen/lights/resample/slots.shared.h"
#include "shared/global_index.shared.h"
#include "screen/lights/resample/light_candidates.glsl"
#include "shared/group_sizes.shared.h"

layout(local_size_x = LINEAR_GROUP) in;
layout(std430, binding = CHOSEN_LIGHTS_SLOT) writeonly buffer Lights { VirtualLight chosen_lights[]; };
layout(std430, binding = CHOSEN_RANGES_SLOT) writeonly buffer Ranges { vec2 ranges[]; };
uniform int first;
uniform int count;
uniform float step_shift;  // of all steps, in [0, 1): how far into a step they begin

int candidate_at(float sum) {
  int low = 0, high = candidate_count - 1;
  while (low < high) {
    int middle = (low + high) / 2;
    if (summed_probability(middle) > sum) high = middle;
    else low = middle + 1;
  }
  return low;
}

// Where a sum is reached: candidates and parts of one, from 0 to their number.
float place_of(float sum) {
  int candidate = candidate_at(sum);
  float before = summed_probability(candidate - 1);
  float own = summed_probability(candidate) - before;
  return float(candidate) + (own > 0.0 ? clamp((sum - before) / own, 0.0, 1.0) : 0.5);
}

// Where what light k stands for begins. What is left before the first step is the end of the last one.
float begin_of(int k) {
  return k == 0 && step_shift == 0.0 ? 0.0 : place_of((float(k) + step_shift) / float(count));
}

void main() {
  int k = int(global_index());
  if (k >= count) return;
  float at = (float(k) + 0.5 + step_shift) / float(count);
  int candidate = candidate_at(at < 1.0 ? at : at - 1.0);
  float probability = summed_probability(candidate) - summed_probability(candidate - 1);
  VirtualLight l = candidate_lights[first_candidate + candidate];
  // Candidates stand for one part in candidate_count each, the chosen ones for one in count.
  float share = probability > 0.0 ? 1.0 / (float(count) * probability) : 0.0;
  l.flux *= share;
  // One that is chosen more than once stays as large as it is: its copies lie in one place and are one light together.
  l.area_m2 *= max(share, 1.0);
  chosen_lights[first + k] = l;
  ranges[first + k] = vec2(begin_of(k), k == count - 1 ? float(candidate_count) + begin_of(0) : begin_of(k + 1));
}
