#version 450 core
// Draws the tiles that paraboloid_depth_maps.comp.glsl listed; groups share them out.
#include "screen/visibility/area_maps/paraboloid_triangle.glsl"

layout(local_size_x = TILE_TEXELS, local_size_y = 4) in;

void main() {
  uint count = min(head.count, head.capacity);
  for (uint slot = gl_WorkGroupID.x; slot < count; slot += gl_NumWorkGroups.x) {
    uvec2 tile = tiles[slot];
    LayerTriangle t;
    if (!layer_triangle(int(tile.y & 0xffffu), int(tile.x), t)) continue;
    ivec2 texel = ivec2(tile.y >> 16 & 0xffu, tile.y >> 24) * TILE_TEXELS + ivec2(gl_LocalInvocationID.xy);
    for (int y = 0; y < TILE_TEXELS; y += int(gl_WorkGroupSize.y)) {
      if (max(texel.x, texel.y + y) < resolution) draw_texel(t, texel + ivec2(0, y));
    }
  }
}
