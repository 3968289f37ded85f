// Tiles of pixels, and the list of those that lights are near.
#ifndef VOLGI_NEAR_LIGHTS_GLSL
#define VOLGI_NEAR_LIGHTS_GLSL
#include "shared/near_light.shared.h"

#define NEAR_TILE 8  // pixels on a side

#define GROUPS_A_ROW 32768u  // GL promises 65535 in each direction
// Arguments of an indirect dispatch of one group a tile, and the tiles in no order.
layout(std430, binding = 1) buffer TileList {
  uint groups_x, groups_y, groups_z;
  uint tile_count;
  uint listed_tiles[];
};
layout(std430, binding = 0) readonly buffer NearLights { NearLight near_lights[]; };
layout(std430, binding = 2) buffer Masks { uint masks[]; };  // 32 lights a word, tile after tile
uniform ivec2 tiles;
uniform int words;   // of a tile's mask
uniform float zone;  // areas of a light

#endif
