#version 450 core
// Sums the candidates' weights from the first on, in one work group and in a fixed order.
#include "screen/visibility/negative/negative_candidates.glsl"

layout(local_size_x = 64) in;
shared float part[64];

void main() {
  int each = (candidate_count() + 63) / 64;
  int first = int(gl_LocalInvocationIndex) * each;
  int end = min(first + each, candidate_count());
  float sum = 0.0;
  for (int i = first; i < end; ++i) sum += weights[i];
  part[gl_LocalInvocationIndex] = sum;
  barrier();
  sum = 0.0;
  for (uint t = 0u; t < gl_LocalInvocationIndex; ++t) sum += part[t];
  for (int i = first; i < end; ++i) {
    sum += weights[i];
    weights[i] = sum;
  }
}
