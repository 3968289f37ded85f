#version 450 core
// Which lights are near a tile of pixels, and may have some of its surfaces in front of them. First for large tiles, then
// for small ones, among what their large one has.
#include "screen/base/gbuffer.glsl"
#include "screen/gather/interleaved/near_lights.glsl"

layout(local_size_x = 64) in;
layout(std430, binding = 4) readonly buffer LargeMasks { uint large_masks[]; };
uniform int light_count;
uniform int tile_size;    // pixels on a side
uniform int large_tiles;  // small tiles on a side of a large one; 0: these are large
uniform int large_columns;

struct Box {
  vec3 least, most;
};

Box box_of(ivec2 first, ivec2 end) {
  Box box = Box(vec3(3.0e38), vec3(-3.0e38));
  for (int y = first.y; y < end.y; ++y) {
    for (int x = first.x; x < end.x; ++x) {
      vec4 position = texelFetch(position_map, ivec2(x, y), 0);
      if (position.w == 0.0) continue;
      box.least = min(box.least, position.xyz);
      box.most = max(box.most, position.xyz);
    }
  }
  return box;
}

bool reaches(NearLight light, Box box) {
  vec3 d = clamp(light.position, box.least, box.most) - light.position;
  if (dot(d, d) >= 2.0 * zone * light.area_m2) return false;
  // The corner of the box that is farthest in front of the light's plane.
  vec3 corner = mix(box.least, box.most, greaterThan(light.normal, vec3(0.0)));
  return dot(corner - light.position, light.normal) > light.rise_m;
}

void list(int tile) {
  uint slot;
  TAKE_SLOT(head, 1u, slot)
  listed_tiles[slot] = uint(tile);
}

// Lights to look at.
uint looked_at(ivec2 tile, int word) {
  if (large_tiles == 0) return light_count - word * 32 >= 32 ? 0xffffffffu : (1u << (light_count - word * 32)) - 1u;
  return large_masks[(tile.y / large_tiles * large_columns + tile.x / large_tiles) * words + word];
}

void main() {
  int index = int(gl_GlobalInvocationID.x);
  if (index >= tiles.x * tiles.y) return;
  ivec2 tile = ivec2(index % tiles.x, index / tiles.x);
  Box box = box_of(tile * tile_size, min((tile + 1) * tile_size, textureSize(position_map, 0)));
  bool empty = box.least.x > box.most.x, any_light = false;
  for (int word = 0; word < words; ++word) {
    uint mask = 0u;
    for (uint left = empty ? 0u : looked_at(tile, word); left != 0u; left &= left - 1u) {
      int k = findLSB(left);
      if (reaches(near_lights[word * 32 + k], box)) mask |= 1u << k;
    }
    masks[index * words + word] = mask;
    any_light = any_light || mask != 0u;
  }
  if (any_light && large_tiles != 0) list(index);
}
