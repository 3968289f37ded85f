// A pyramid of how much light the texels of a light's reflective shadow map reflect, in luminance [W]. Level 1 holds
// blocks of 4 x 4 texels, level k + 1 blocks of 4 x 4 values of level k, up to one value a layer; texels themselves are
// not stored. Any resolution: blocks at the edge are smaller.
#ifndef VOLGI_FLUX_IMPORTANCE_GLSL
#define VOLGI_FLUX_IMPORTANCE_GLSL
#include "shared/luminance.glsl"

int level_size(int resolution, int level) {
  for (int k = 0; k < level; ++k) resolution = (resolution + 3) / 4;
  return resolution;
}

int last_level(int resolution) {
  int level = 0;
  for (; resolution > 1; resolution = (resolution + 3) / 4) ++level;
  return level;
}

// Where level 1, 2, ... begins; all layers of a level lie together.
int level_start(int resolution, int layer_count, int level) {
  int start = 0;
  for (int k = 1; k < level; ++k) {
    int size = level_size(resolution, k);
    start += layer_count * size * size;
  }
  return start;
}

#endif
