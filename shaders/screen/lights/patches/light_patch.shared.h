// Patches of light: squares of a reflective shadow map and what they reflect (screen/lights/patches/light_patches.h).
// Depth 0 has the coarsest ones, the roots; each has four parts at the next depth, and those follow on one another:
// parts of patch i are 4 i ... 4 i + 3. Depths lie behind one another.
#ifndef VOLGI_LIGHT_PATCH_SHARED_H
#define VOLGI_LIGHT_PATCH_SHARED_H
#include "shared/base.shared.h"
SHARED_BEGIN

#define MAX_PATCH_DEPTH 6
#define PATCH_BACKGROUND 3.0e38f  // depth of what the light sees nothing in

// std430, 48 bytes; gathers read three vectors of four.
struct LightPatch {
  vec3 position;  // centred frame
  float area_m2;
  vec3 normal;     // unit, on the light's side; 0 where nothing is
  float bound_m2;  // of the area that eq. 4.3 gives it at most: from the largest distance of the patch (§4.2.4.1)
  vec3 flux;       // [W]
  float measure;   // solid angle [sr], of a sun area across the light [m^2]
};

// std430, 32 bytes: min-max mipmaps of the map, of it and one texel around it.
struct PatchRange {
  vec3 least;     // of each component of the normal
  float nearest;  // depth [m]; PATCH_BACKGROUND: nothing
  vec3 most;
  float farthest;  // PATCH_BACKGROUND: some of it is background
};
#ifdef __cplusplus
static_assert(sizeof(LightPatch) == 48 && offsetof(LightPatch, flux) == 32);
static_assert(sizeof(PatchRange) == 32 && offsetof(PatchRange, most) == 16);
#endif

// Behind (4^depth - 1) / 3 times as many patches as there are roots.
SHARED_FUNCTION int first_of_depth(int root_count, int depth) {
  return root_count * (((1 << (2 * depth)) - 1) & 0x55555555);
}

// Place on a Z-order curve, by the lowest ten bits of each coordinate; and back.
SHARED_FUNCTION int morton_index(ivec2 cell) {
  int index = 0;
  for (int bit = 0; bit < 10; ++bit) index |= (cell.x >> bit & 1) << (2 * bit) | (cell.y >> bit & 1) << (2 * bit + 1);
  return index;
}
SHARED_FUNCTION ivec2 morton_cell(int index) {
  ivec2 cell = ivec2(0);
  for (int bit = 0; bit < 10; ++bit) {
    cell.x |= (index >> (2 * bit) & 1) << bit;
    cell.y |= (index >> (2 * bit + 1) & 1) << bit;
  }
  return cell;
}

SHARED_END
#endif
