// Which subsplats a picture is made of, as its discontinuity mipmaps say.
#ifndef VOLGI_REFINED_GLSL
#define VOLGI_REFINED_GLSL
#include "screen/base/gbuffer.glsl"
#include "screen/gather/subsplats/discontinuity.shared.h"
#include "screen/gather/subsplats/slots.shared.h"
#include "screen/gather/subsplats/subsplat.shared.h"

layout(binding = DISCONTINUITIES_UNIT) uniform usampler2D discontinuities;
uniform ivec2 picture_size;
uniform int last_level;    // the coarsest one
uniform int finest_level;  // which is not refined
uniform int diagonals;     // 1: discontinuities of the four texels diagonal to it count as its own (§3.4.2)

uint bits_at(int level, ivec2 texel) {
  ivec2 end = level_size(picture_size, level);
  if (any(lessThan(texel, ivec2(0))) || any(greaterThanEqual(texel, end))) return 0u;
  return texelFetch(discontinuities, tower_corner(picture_size, level) + texel, 0).r;
}

bool has_surface(Subsplat s) {
  if (s.level == 0) return texelFetch(position_map, s.texel, 0).w != 0.0;
  return (bits_at(s.level, s.texel) & uint(SUBSPLAT_HAS_SURFACE)) != 0u;
}

// Of a subsplat that there is.
bool is_refined(Subsplat s) {
  if (s.level <= finest_level) return false;
  uint bits = bits_at(s.level, s.texel);
  if (diagonals != 0) {
    for (int k = 0; k < 4; ++k) bits |= bits_at(s.level, s.texel + 2 * ivec2(k & 1, k >> 1) - 1) & 1u;
  }
  return (bits & uint(SUBSPLAT_DISCONTINUOUS)) != 0u;
}

// §4.2.1.1: not refined itself, but what it is a part of is. We depart: all coarser levels are asked, not only the next
// one, since a diagonal neighbour of a part need not be one of the whole; then this is what refinement level by level
// comes to.
bool is_fragment(Subsplat s) {
  if (s.level < finest_level || !has_surface(s) || is_refined(s)) return false;
  for (int level = last_level; level > s.level; --level) {
    Subsplat whole = Subsplat(level, s.texel >> (level - s.level));
    if (!is_refined(whole)) return false;
  }
  return true;
}

#endif
