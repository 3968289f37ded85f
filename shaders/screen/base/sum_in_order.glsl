// Sums of weights from the first on, in the same order of additions on every GPU. The weights lie in SUM_PARTS parts, a
// group to each: first, with PART_SUMS, the sums of the parts; then each weight becomes the sum of all up to itself.
// The including file declares the buffer weights[] of type SUMMED, and defines SUM_FIRST and SUM_COUNT. Weights come and
// go through shared memory, all threads beside each other; one of them adds.
#ifndef VOLGI_SUM_IN_ORDER_GLSL
#define VOLGI_SUM_IN_ORDER_GLSL
#include "screen/base/sum_in_order.shared.h"

#define SUM_CHUNK 256

layout(local_size_x = SUM_PARTS) in;
layout(std430, binding = PART_SUMS_SLOT) buffer PartSums { SUMMED part_sums[SUM_PARTS]; };
shared SUMMED chunk[SUM_CHUNK];

SUMMED sum_before_part(int part) {
  chunk[gl_LocalInvocationIndex] = part_sums[gl_LocalInvocationIndex];
  barrier();
  SUMMED sum = SUMMED(0.0);
  for (int t = 0; t < part; ++t) sum += chunk[t];
  barrier();
  return sum;
}

void main() {
  int lane = int(gl_LocalInvocationIndex), part = int(gl_WorkGroupID.x);
  int each = (SUM_COUNT + SUM_PARTS - 1) / SUM_PARTS;
  int first = SUM_FIRST + part * each;
  int end = min(first + each, SUM_FIRST + SUM_COUNT);
#ifdef PART_SUMS
  SUMMED sum = SUMMED(0.0);
#else
  SUMMED sum = sum_before_part(part);
#endif
  for (int from = first; from < end; from += SUM_CHUNK) {
    int size = min(SUM_CHUNK, end - from);
    for (int i = lane; i < size; i += SUM_PARTS) chunk[i] = weights[from + i];
    barrier();
    if (lane == 0) {
      for (int i = 0; i < size; ++i) {
        sum += chunk[i];
        chunk[i] = sum;
      }
    }
    barrier();
#ifndef PART_SUMS
    for (int i = lane; i < size; i += SUM_PARTS) weights[from + i] = chunk[i];
    barrier();
#endif
  }
#ifdef PART_SUMS
  if (lane == 0) part_sums[part] = sum;
#endif
}

#endif
