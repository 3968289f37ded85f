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
#define LIGHT_NODE_TEXELS 4

// std430, 64 bytes; gathers load its first three vectors of four, and of nodes that are no leaves the last one. Dark
// nodes have no flux, and nothing below them has any.
struct LightNode {
  vec3 position;    // mean of its parts, by flux; centred frame
  float area_m2;    // of a disk that is spread as its parts are, at least as large as they are together
  vec3 flux;        // sum [W]
  uint normal;      // octahedral, two times 16 bits: mean by flux
  float lesser_m2;  // the parts' areas summed, or less than 0: the area of that disk, less, where area_m2 is their sum
  float radius_m;   // of a ball around its position that holds its parts
  float rise_m;     // smallest height over its plane of a point that any of its parts lights; NO_FLAT_NODE: any
  int kind;         // VIRTUAL_LIGHT_*, NODE_STAYS_APART, and from NODE_CLUSTER_SHIFT on the cluster
  // How its flux is spread otherwise than a disk's: along `stretch`, in its plane, and across that. Half the square of
  // its length is by how much the variance along it is more than the mean of both. [m]
  vec3 stretch;
  uint turned;  // packHalf2x16: standard deviation off its plane over the root of its area; length of the mean normal
                // by flux, 1 where all are alike
};
#define NODE_KIND_BITS 0x7f
#define NODE_STAYS_APART 0x80  // its parts have no irradiance together
#define NODE_CLUSTER_SHIFT 8
#ifdef __cplusplus
static_assert(sizeof(LightNode) == 64 && offsetof(LightNode, lesser_m2) == 32 && offsetof(LightNode, stretch) == 48);
#endif

// What a point's squared distance is compared with: light_tree.h; < 0: parts stay apart.
SHARED_FUNCTION float node_size(float area_m2, int kind) {
  return (kind & NODE_STAYS_APART) != 0 ? -(area_m2 + 1e-30f) : area_m2 + 1e-30f;
}

// Share of a node's irradiance that comes from itself and not from its parts: 0 up to a squared distance of `zone`
// sizes, 1 from twice that on, and linear in squared distance between; 0 where parts stay apart.
SHARED_FUNCTION float node_share(float squared, float size_m2, float zone) {
  return clamp(squared / (zone * size_m2) - 1.0f, 0.0f, 1.0f);
}

SHARED_END
#endif
