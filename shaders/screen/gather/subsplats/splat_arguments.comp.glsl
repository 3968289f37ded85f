#version 450 core
// A list of subsplats as arguments of an instanced draw.
#include "screen/base/work_list.glsl"
#include "screen/gather/subsplats/slots.shared.h"

layout(local_size_x = 1) in;
layout(std430, binding = SUBSPLATS_IN_SLOT) readonly buffer In { WorkListHead in_head; };
layout(std430, binding = SPLAT_ARGUMENTS_SLOT) buffer Arguments {
  uint vertices, instances, first_vertex, first_instance;
  uint all;
};
uniform int instance_count;
uniform int counts;  // 1: these are new

void main() {
  vertices = in_head.count;
  instances = uint(instance_count);
  first_vertex = first_instance = 0u;
  if (counts != 0) all += in_head.count;  // of all lists of a frame
}
