// Subsplats: squares of the picture that are one fragment each, of 2^level pixels on a side. Levels of a picture lie
// beside one another in one texture, the flattened multiresolution buffer (Nichols 2010, §4.2.1.1): level 0 on the
// left, the others on its right, one above the other. What has no level 0 holds that tower alone.
#ifndef VOLGI_SUBSPLAT_SHARED_H
#define VOLGI_SUBSPLAT_SHARED_H
#include "shared/base.shared.h"
SHARED_BEGIN

#define MAX_SUBSPLAT_LEVEL 12   // of squares of 4096 pixels
#define ALL_LIGHTS 0xffffffffu  // that a subsplat is for: once a frame, and not once a light

// Texels of a level.
SHARED_FUNCTION ivec2 level_size(ivec2 size, int level) { return (size + ((1 << level) - 1)) >> level; }

// Where a level >= 1 begins in the tower.
SHARED_FUNCTION ivec2 tower_corner(ivec2 size, int level) {
  int y = 0;
  for (int k = 1; k < level; ++k) y += level_size(size, k).y;
  return ivec2(0, y);
}
SHARED_FUNCTION ivec2 tower_size(ivec2 size, int last) {
  return ivec2(level_size(size, 1).x, max(tower_corner(size, last + 1).y, 1));
}

SHARED_FUNCTION ivec2 level_corner(ivec2 size, int level) {
  return level == 0 ? ivec2(0) : ivec2(size.x, 0) + tower_corner(size, level);
}
SHARED_FUNCTION ivec2 flattened_size(ivec2 size, int last) {
  return last == 0 ? size : ivec2(size.x + tower_size(size, last).x, max(size.y, tower_size(size, last).y));
}

struct Subsplat {
  int level;
  ivec2 texel;
};

// Where a subsplat lies in the flattened buffer, and what lies there: level -1 where nothing does.
SHARED_FUNCTION ivec2 place_of_subsplat(ivec2 size, Subsplat s) { return level_corner(size, s.level) + s.texel; }
SHARED_FUNCTION Subsplat subsplat_at(ivec2 size, int last, ivec2 place) {
  Subsplat s;
  s.level = -1;
  s.texel = place;
  if (place.x < size.x) {
    if (place.y < size.y) s.level = 0;
    return s;
  }
  s.texel = place - ivec2(size.x, 0);
  int level = 1;
  while (level <= last && s.texel.y >= level_size(size, level).y) {
    s.texel.y -= level_size(size, level).y;
    ++level;
  }
  if (level <= last && s.texel.x < level_size(size, level).x) s.level = level;
  return s;
}

// A level and a texel of it in one number, and back. Pictures have at most 16384 pixels on a side.
SHARED_FUNCTION uint pack_subsplat(Subsplat s) { return uint(s.level) << 28 | uint(s.texel.y) << 14 | uint(s.texel.x); }
SHARED_FUNCTION Subsplat unpack_subsplat(uint packed_subsplat) {
  Subsplat s;
  s.level = int(packed_subsplat >> 28);
  s.texel = ivec2(int(packed_subsplat & 0x3fffu), int(packed_subsplat >> 14 & 0x3fffu));
  return s;
}

SHARED_END
#endif
