// Beside what screen/base and screen/visibility/area_maps name.
#ifndef VOLGI_MULTIRES_SLOTS_SHARED_H
#define VOLGI_MULTIRES_SLOTS_SHARED_H
#include "screen/base/gbuffer.shared.h"

// Building the tree, beside VIRTUAL_LIGHTS_SLOT and AREA_LIGHTS_BLOCK.
#define TREE_ROOTS_SLOT 1
#define TREE_NODES_SLOT 2
#define TREE_SUBLIGHTS_SLOT 3
#define TREE_LEAF_CLUSTERS_SLOT 4
#define TREE_CHUNK_COUNTS_SLOT 5

// Gathering, beside the images and the list of SmoothPixels.
#define LIGHT_ROOTS_SLOT 1
#define LIGHT_NODES_UNIT 3  // GBUFFER_UNITS
#define CUT_INDIRECT_IMAGE 0
#define CUT_DIRECT_IMAGE 1

#endif
