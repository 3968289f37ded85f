#version 450 core
// The box around the surfaces in each tile of pixels.
#include "screen/base/gbuffer.glsl"
#include "shared/global_index.shared.h"
#include "screen/gather/interleaved/tile_boxes.glsl"
#include "shared/group_sizes.shared.h"

layout(local_size_x = LINEAR_GROUP) in;

void main() {
  int index = int(global_index());
  if (index >= tiles.x * tiles.y) return;
  ivec2 first = ivec2(index % tiles.x, index / tiles.x) * NEAR_TILE;
  ivec2 end = min(first + NEAR_TILE, textureSize(position_map, 0));
  vec3 least = vec3(3.0e38), most = vec3(-3.0e38);
  for (int y = first.y; y < end.y; ++y) {
    for (int x = first.x; x < end.x; ++x) {
      vec4 position = texelFetch(position_map, ivec2(x, y), 0);
      if (position.w == 0.0) continue;
      least = min(least, position.xyz);
      most = max(most, position.xyz);
    }
  }
  boxes[2 * index] = vec4(least, 0.0);
  boxes[2 * index + 1] = vec4(most, 0.0);
}
