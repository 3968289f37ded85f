// Reductions over a work group of GROUP threads, a power of two, in a fixed order.
layout(local_size_x = GROUP) in;
shared vec4 partial[GROUP];

vec4 sum_of_group(vec4 own) {
  uint t = gl_LocalInvocationIndex;
  barrier();  // others may still read the last result
  partial[t] = own;
  for (uint step = GROUP / 2; step > 0u; step /= 2u) {
    barrier();
    if (t < step) partial[t] += partial[t + step];
  }
  barrier();
  return partial[0];
}

vec4 min_of_group(vec4 own) {
  uint t = gl_LocalInvocationIndex;
  barrier();
  partial[t] = own;
  for (uint step = GROUP / 2; step > 0u; step /= 2u) {
    barrier();
    if (t < step) partial[t] = min(partial[t], partial[t + step]);
  }
  barrier();
  return partial[0];
}
