#version 450 core
// Turns the groups' numbers of sides into the offset of each group's first side, and their sum.
layout(local_size_x = 256) in;
layout(std430, binding = 2) buffer Wanted { uint wanted[4]; };
layout(std430, binding = 4) buffer GroupTotals { uint group_totals[]; };
uniform int groups;

shared uint running[256];

void main() {
  uint lane = gl_LocalInvocationID.x;
  uint carry = 0u;
  for (int first = 0; first < groups; first += 256) {
    int g = first + int(lane);
    uint total = g < groups ? group_totals[g] : 0u;
    running[lane] = total;
    barrier();
    for (uint step = 1u; step < 256u; step <<= 1) {
      uint before = lane >= step ? running[lane - step] : 0u;
      barrier();
      running[lane] += before;
      barrier();
    }
    if (g < groups) group_totals[g] = carry + running[lane] - total;
    carry += running[255];
    barrier();
  }
  if (lane == 0u) wanted[3] = carry;
}
