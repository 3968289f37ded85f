#version 450 core
// Draws what paraboloid_depth_maps.comp.glsl listed: groups share the tiles out, and a thread keeps the nearest of all a
// tile's triangles at a column of its texels, so that a triangle is made ready once for sixteen of them.
#include "screen/visibility/area_maps/paraboloid_triangle.glsl"

#define TILES 4  // of a group at once
layout(local_size_x = TILE_TEXELS, local_size_y = TILES) in;
uniform int first_layer;
uniform int layers;

void main() {
  int across = tiles_across();
  int end = (first_layer + layers) * across * across;
  int step = int(gl_NumWorkGroups.x) * TILES;
  for (int tile = first_layer * across * across + int(gl_WorkGroupID.x) * TILES + int(gl_LocalInvocationID.y); tile < end; tile += step) {
    uint entry = tile_ends[tile];
    if (entry == 0u) continue;
    int layer = tile / (across * across);
    ivec2 texel = ivec2(tile % across, tile / across % across) * TILE_TEXELS + ivec2(gl_LocalInvocationID.x, 0);
    uint nearest[TILE_TEXELS];
    for (int y = 0; y < TILE_TEXELS; ++y) nearest[y] = NOTHING_BITS;
    while (entry != 0u) {
      uvec2 listed = entries[entry - 1u];
      LayerTriangle t;
      layer_triangle(layer, int(listed.x), t);  // seen, or it would not be listed
      for (int y = 0; y < TILE_TEXELS; ++y) nearest[y] = min(nearest[y], texel_bits(t, texel + ivec2(0, y)));
      entry = listed.y;
    }
    for (int y = 0; y < TILE_TEXELS; ++y) {
      ivec3 at = ivec3(texel + ivec2(0, y), layer);
      if (max(at.x, at.y) >= resolution || nearest[y] == NOTHING_BITS) continue;
      imageStore(distance_bits, at, uvec4(min(nearest[y], imageLoad(distance_bits, at).r)));
    }
  }
}
