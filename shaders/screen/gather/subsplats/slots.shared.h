// Beside what screen/base, screen/visibility/area_maps and screen/visibility/negative name.
#ifndef VOLGI_SUBSPLATS_SLOTS_SHARED_H
#define VOLGI_SUBSPLATS_SLOTS_SHARED_H
#include "screen/base/gbuffer.shared.h"

// Discontinuity mipmaps, made.
#define DEPTH_RANGES_IMAGE 0
#define LEAST_NORMALS_IMAGE 1
#define MOST_NORMALS_IMAGE 2
#define BENDS_IMAGE 3
#define DISCONTINUITIES_IMAGE 4
// And read.
#define DISCONTINUITIES_UNIT 5  // behind GBUFFER_MIRROR_UNIT

// Refinement: a subsplat and its light each.
#define SUBSPLATS_IN_SLOT 1
#define SUBSPLATS_OUT_SLOT 2
#define SUBSPLATS_DONE_SLOT 3
#define SPLAT_ARGUMENTS_SLOT 4

// The cache of virtual lights, and the number of them.
#define CACHED_LIGHTS_SLOT 3
#define CACHE_STARTS_SLOT 4
#define CACHE_SIZE_SLOT 5
// The tree of patches.
#define PATCH_TREE_UNIT 6

// Upsampling.
#define RENDERED_UNIT 4
#define COARSER_UNIT 5
#define UPSAMPLED_IMAGE 0

#endif
