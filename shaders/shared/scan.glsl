// Sums within a group. The including file defines SCAN_GROUP, the number of its invocations.
#ifndef VOLGI_SCAN_GLSL
#define VOLGI_SCAN_GLSL

shared uint scan_running[SCAN_GROUP];

// Sum of `own` over the invocations before this one. All of the group call it, once.
uint sum_before(uint own) {
  uint lane = gl_LocalInvocationIndex;
  scan_running[lane] = own;
  barrier();
  for (uint step = 1u; step < SCAN_GROUP; step <<= 1) {
    uint before = lane >= step ? scan_running[lane - step] : 0u;
    barrier();
    scan_running[lane] += before;
    barrier();
  }
  return scan_running[lane] - own;
}

#endif
