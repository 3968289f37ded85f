// Beside what screen/base and screen/visibility/area_maps name.
#ifndef VOLGI_INTERLEAVED_SLOTS_SHARED_H
#define VOLGI_INTERLEAVED_SLOTS_SHARED_H
#include "screen/base/gbuffer.shared.h"

#define ARRANGED_LIGHTS_SLOT 3

// The two layers of both gathers.
#define INDIRECT_IMAGE 0
#define DIRECT_IMAGE 1

#define BLUR_SOURCE_UNIT GBUFFER_UNITS
#define BLURRED_IMAGE 0
#define BLUR_ERROR_IMAGE 1

#define ERROR_ESTIMATE_IMAGE 0
#define ERROR_BINS_SLOT 1

#define NEAR_LIGHTS_SLOT 0
#define NEAR_TILES_SLOT 1
#define TILE_MASKS_SLOT 2
#define NEAR_SUBLIGHTS_SLOT 3
#define LARGE_MASKS_SLOT 4
#define TILE_BOXES_SLOT 5

#endif
