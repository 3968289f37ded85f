// Where a subsplat's light is gathered.
#ifndef VOLGI_SUBSPLAT_RECEIVER_GLSL
#define VOLGI_SUBSPLAT_RECEIVER_GLSL
#include "screen/base/gbuffer.glsl"
#include "screen/gather/subsplats/subsplat.shared.h"
#include "shared/octahedral.glsl"

struct Receiver {
  vec3 position, normal, geometric;
  ivec2 pixel;  // whose surface it is of
};

// Of a pixel. Without surface its normal has no length.
Receiver receiver_at(ivec2 pixel) {
  vec4 position = texelFetch(position_map, pixel, 0);
  vec4 normals = texelFetch(normal_map, pixel, 0);
  if (position.w == 0.0) return Receiver(vec3(0.0), vec3(0.0), vec3(0.0), pixel);
  return Receiver(position.xyz, octahedral_decode(normals.xy), octahedral_decode(normals.zw), pixel);
}

bool has_surface(Receiver at) { return at.normal != vec3(0.0); }

vec3 mean_direction(vec3 sum) { return dot(sum, sum) > 1e-6 ? normalize(sum) : vec3(0.0, 0.0, 1.0); }

// Of a subsplat: its middle lies between four pixels, whose mean it is. `whole` is false where it could not be refined
// and may show several surfaces: then the first pixel that shows one, of the four or of all.
Receiver receiver_of(Subsplat s, ivec2 size, bool whole) {
  if (s.level == 0) return receiver_at(s.texel);
  int edge = 1 << s.level;
  ivec2 corner = s.texel * edge, last = min(corner + edge, size) - 1;
  ivec2 middle = corner + edge / 2;
  Receiver sum = Receiver(vec3(0.0), vec3(0.0), vec3(0.0), middle);
  float count = 0.0;
  for (int k = 0; k < 4; ++k) {
    Receiver at = receiver_at(min(middle - ivec2(k & 1, k >> 1), last));
    if (!has_surface(at) || (!whole && count > 0.0)) continue;
    sum = Receiver(sum.position + at.position, sum.normal + at.normal, sum.geometric + at.geometric, at.pixel);
    count += 1.0;
  }
  for (int i = 0; i < edge * edge && count == 0.0; ++i) {
    ivec2 pixel = corner + ivec2(i % edge, i / edge);
    if (any(greaterThan(pixel, last))) continue;
    sum = receiver_at(pixel);
    count = has_surface(sum) ? 1.0 : 0.0;
  }
  if (count == 0.0) return sum;
  return Receiver(sum.position / count, mean_direction(sum.normal), mean_direction(sum.geometric), sum.pixel);
}

#endif
