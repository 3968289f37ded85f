// Where virtual area lights and their maps are, for those who make them and for gathers.
#ifndef VOLGI_AREA_MAPS_SLOTS_SHARED_H
#define VOLGI_AREA_MAPS_SLOTS_SHARED_H

// Gathers, beside VIRTUAL_LIGHTS_SLOT.
#define AREA_LIGHTS_BLOCK 1
#define LIGHT_ORDER_SLOT 1
#define CLUSTER_OF_SLOT 2

// AreaLightShadow::bind(): behind the units of what else a gather may read.
#define SHADOW_DISTANCE_UNIT 8
#define SHADOW_BASIS_UNIT 8
#define SHADOW_BASIS_DEPTH_UNIT 9
#define SHADOW_DEPTH_UNIT 10
#define SHADOW_FARTHEST_UNIT 11

// Clustering, beside VIRTUAL_LIGHTS_SLOT.
#define MADE_CLUSTER_OF_SLOT 1
#define CENTERS_SLOT 2
#define CENTERS_BLOCK 0  // the same buffer for reading only: llvmpipe reads uniform blocks faster
#define PROGRESS_SLOT 3
#define MADE_AREA_LIGHTS_SLOT 4
#define MADE_ORDER_SLOT 5

// Paraboloid depth maps.
#define VERTICES_SLOT 0
#define MAPPED_AREA_LIGHTS_SLOT 1
#define MAP_TILES_SLOT 2
#define MAP_TILE_ENDS_SLOT 3
#define DISTANCE_BITS_IMAGE 0

// Convolution shadows.
#define DISTANCE_MAP_UNIT 0
#define FARTHEST_UNIT 1
#define FARTHEST_IMAGE 0
#define BASIS_IMAGE 0
#define BASIS_DEPTH_IMAGE 1
#define BASIS_MEAN_IMAGE 2

#endif
