// Boxes around the surfaces in tiles of pixels.
#ifndef VOLGI_TILE_BOXES_GLSL
#define VOLGI_TILE_BOXES_GLSL
#include "screen/gather/interleaved/near_lights.glsl"

struct Box {
  vec3 least, most;
};

layout(std430, binding = TILE_BOXES_SLOT) buffer Boxes { vec4 boxes[]; };  // two for each tile

bool is_empty(Box box) { return box.least.x > box.most.x; }

Box box_of_small(int tile) { return Box(boxes[2 * tile].xyz, boxes[2 * tile + 1].xyz); }

ivec2 large_tiles() { return (tiles + LARGE_TILE - 1) / LARGE_TILE; }

Box box_of_large(ivec2 large) {
  ivec2 end = min((large + 1) * LARGE_TILE, tiles);
  Box box = Box(vec3(3.0e38), vec3(-3.0e38));
  for (int y = large.y * LARGE_TILE; y < end.y; ++y) {
    for (int x = large.x * LARGE_TILE; x < end.x; ++x) {
      Box small = box_of_small(y * tiles.x + x);
      box.least = min(box.least, small.least);
      box.most = max(box.most, small.most);
    }
  }
  return box;
}

#endif
