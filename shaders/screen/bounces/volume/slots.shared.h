// Beside what VoxelGridGl::bind() and GBuffer::bind() bind.
#ifndef VOLGI_VOLUME_SLOTS_SHARED_H
#define VOLGI_VOLUME_SLOTS_SHARED_H
#include "screen/base/gbuffer.shared.h"

// The side gather.
#define GATHERED_EMITTED_SLOT 6
#define GATHERED_PUNCTUAL_SLOT 7
#define SIDE_SUBLIGHTS_SLOT 8
#define SIDE_NEAR_LIGHTS_SLOT 9

// The volume gather, of listed pixels.
#define GATHERED_INDIRECT_IMAGE 0
#define GATHERED_DIRECT_IMAGE 1

// The radiance gather.
#define RADIANCE_UNIT GBUFFER_UNITS
#define OCCUPANCY_UNIT (GBUFFER_UNITS + 1)

#endif
