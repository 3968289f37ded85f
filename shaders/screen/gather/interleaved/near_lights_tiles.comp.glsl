#version 450 core
// Which lights are near a tile of pixels, and may have some of its surfaces in front of them. In turn, LARGE: for large
// tiles, a thread to every 32 lights of one; then for small ones, among what their large one has.
#include "shared/global_index.shared.h"
#include "screen/gather/interleaved/near_lights.glsl"
#include "screen/gather/interleaved/tile_boxes.glsl"
#include "shared/group_sizes.shared.h"

layout(local_size_x = LINEAR_GROUP) in;
layout(std430, binding = LARGE_MASKS_SLOT) buffer LargeMasks { uint large_masks[]; };
uniform int light_count;

bool reaches(NearLight light, Box box) {
  vec3 d = clamp(light.position, box.least, box.most) - light.position;
  if (dot(d, d) >= reach_squared(light)) return false;
  // The corner of the box that is farthest in front of the light's plane.
  vec3 corner = mix(box.least, box.most, greaterThan(light.normal, vec3(0.0)));
  return dot(corner - light.position, light.normal) > light.rise_m;
}

// Those of the 32 lights of a word that `looked_at` has and that reach the box.
uint reaching(uint looked_at, int word, Box box) {
  uint mask = 0u;
  for (uint left = is_empty(box) ? 0u : looked_at; left != 0u; left &= left - 1u) {
    int k = findLSB(left);
    if (reaches(near_lights[word * 32 + k], box)) mask |= 1u << k;
  }
  return mask;
}

#ifdef LARGE
void main() {
  int index = int(global_index());
  ivec2 large = large_tiles();
  if (index >= large.x * large.y * words) return;
  int tile = index / words, word = index % words;
  int lights = light_count - word * 32;
  uint all = lights >= 32 ? 0xffffffffu : (1u << lights) - 1u;
  large_masks[index] = reaching(all, word, box_of_large(ivec2(tile % large.x, tile / large.x)));
}
#else
void list(int tile) {
  uint slot;
  APPEND_TO_LIST(head, 1u, slot)
  listed_tiles[slot] = uint(tile);
}

void main() {
  int index = int(global_index());
  if (index >= tiles.x * tiles.y) return;
  ivec2 large = ivec2(index % tiles.x, index / tiles.x) / LARGE_TILE;
  int first_of_large = (large.y * large_tiles().x + large.x) * words;
  bool any_light = false;
  for (int word = 0; word < words; ++word) {
    uint mask = reaching(large_masks[first_of_large + word], word, box_of_small(index));
    masks[index * words + word] = mask;
    any_light = any_light || mask != 0u;
  }
  if (any_light) list(index);
}
#endif
