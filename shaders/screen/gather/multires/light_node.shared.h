// Nodes of the light tree: screen/gather/multires/light_tree.h.
#ifndef VOLGI_LIGHT_NODE_SHARED_H
#define VOLGI_LIGHT_NODE_SHARED_H
#include "shared/base.shared.h"
SHARED_BEGIN

// Levels, of four nodes each in one of the next. Where leaves are the fine sub-lights of virtual lights, a light is
// worth a node of level LIGHT_LEVEL.
#define LIGHT_LEVEL 2
#define MAX_LIGHT_TREE_LEVELS 8

#define NO_FLAT_NODE -3.0e38f  // rise_m of a node whose parts face different ways

// Texels of four numbers each in a node.
#define LIGHT_NODE_TEXELS 5

// std430, 80 bytes; gathers load its first three vectors of four, and of nodes that are no leaves the last one. Dark
// nodes have no flux, and nothing below them has any.
struct LightNode {
  vec3 position;      // mean of its parts, by flux; centred frame
  float area_m2;      // of a disk that is spread as its parts are, at least surface_m2
  vec3 flux;          // sum [W]
  uint normal;        // octahedral, two times 16 bits: mean by flux
  float size_m2;      // what a point's squared distance is compared with: light_tree.h; < 0: parts stay apart
  float radius_m;     // of a ball around its position that holds its parts
  float rise_m;       // smallest height over its plane of a point that any of its parts lights; NO_FLAT_NODE: any
  int kind;           // VIRTUAL_LIGHT_*
  float variance_m2;  // mean squared distance of its flux from its position; a square's is a sixth of its area
  float mean_normal;  // length of the mean normal by flux, 1 where all are alike
  int cluster;
  float surface_m2;  // sum of its parts' areas
  // How its flux is spread otherwise than a disk's: along `stretch`, in its plane, and across that. Half the square of
  // its length is by how much the variance along it is more than the mean of both. [m]
  vec3 stretch;
  uint turned;  // packHalf2x16: standard deviation off its plane over the root of its area; mean_normal
};
#ifdef __cplusplus
static_assert(sizeof(LightNode) == 80 && offsetof(LightNode, size_m2) == 32 && offsetof(LightNode, variance_m2) == 48 &&
              offsetof(LightNode, stretch) == 64);
#endif

// Share of a node's irradiance that comes from itself and not from its parts: 0 up to a squared distance of `zone`
// sizes, 1 from twice that on, and linear in squared distance between; 0 where parts stay apart.
SHARED_FUNCTION float node_share(float squared, float size_m2, float zone) {
  return clamp(squared / (zone * size_m2) - 1.0f, 0.0f, 1.0f);
}

SHARED_END
#endif
