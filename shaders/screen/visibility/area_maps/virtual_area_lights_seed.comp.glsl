#version 450 core
// Where clusters start: cluster k from light k N / M (Dong et al. 2009, section 6) where that has flux, else from the
// next one that has and is free; after the last light comes the first. So no two share a seed, and a light that comes
// or goes moves only the seeds that queue up around it. (Numbering the lights that have flux instead, k L / M, would
// send all seeds behind it to other places.) One work group: seeds that wait are a queue, x -> max(x + a, b) over any
// piece of the list.
#include "screen/visibility/area_maps/virtual_area_lights.glsl"

#define THREADS 256
layout(local_size_x = THREADS) in;
uniform int cluster_count;
uniform int max_iterations;
shared ivec3 piece[THREADS];  // a, b, seeds that begin to wait; then: waiting, clusters seeded before

// Numbers k with floor(k N / M) < i.
int seeds_before(int i) { return (i * cluster_count + light_count - 1) / light_count; }

void scan_pieces() {
  ivec3 whole = ivec3(0);
  for (int t = 0; t < THREADS; ++t) {
    whole = ivec3(whole.x + piece[t].x, max(whole.y + piece[t].x, piece[t].y), 0);
  }
  int wrapped = max(whole.x, whole.y);  // still waiting at the end of the list
  int waiting = wrapped;
  int asked = 0;
  for (int t = 0; t < THREADS; ++t) {
    ivec3 p = piece[t];
    piece[t] = ivec3(waiting, wrapped + asked - waiting, 0);
    waiting = max(waiting + p.x, p.y);
    asked += p.z;
  }
  seeded = uint(wrapped + asked - waiting);
}

void main() {
  int t = int(gl_LocalInvocationIndex);
  int each = (light_count + THREADS - 1) / THREADS;
  int first = min(t * each, light_count);
  int end = min(first + each, light_count);
  ivec2 queue = ivec2(0);
  for (int i = first; i < end; ++i) {
    int a = seeds_before(i + 1) - seeds_before(i) - int(has_flux(i));
    queue = ivec2(queue.x + a, max(queue.y + a, 0));
  }
  piece[t] = ivec3(queue, light_count > 0 ? seeds_before(end) - seeds_before(first) : 0);
  for (int i = t; i < max_iterations; i += THREADS) moved[i] = 0u;
  barrier();
  if (t == 0) scan_pieces();
  barrier();
  int waiting = piece[t].x;
  int cluster = piece[t].y;
  for (int i = first; i < end; ++i) {
    waiting += seeds_before(i + 1) - seeds_before(i);
    if (waiting == 0 || !has_flux(i)) continue;
    centers[cluster++] = ClusterCenter(lights[i].position, lights[i].normal);
    --waiting;
  }
}
