#version 450 core
// Adds what the four octants that reach a side have brought (sweep.comp.glsl) to what it has received.
layout(local_size_x = 64) in;
layout(std430, binding = 5) readonly buffer SideCount { uint side_count; };
layout(std430, binding = 6) buffer Received { vec4 received[]; };
layout(std430, binding = 10) readonly buffer Arrived { vec4 arrived[]; };

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= side_count) return;
  received[i] += (arrived[4u * i] + arrived[4u * i + 1u]) + (arrived[4u * i + 2u] + arrived[4u * i + 3u]);
}
