// Beside what VoxelGridGl::bind() and GBuffer::bind() bind.
#ifndef VOLGI_VOLUME_SLOTS_SHARED_H
#define VOLGI_VOLUME_SLOTS_SHARED_H
#include "screen/base/gbuffer.shared.h"

#define SENDERS_SLOT 8  // of reflected_flux

// The volume gather, of listed pixels.
#define GATHERED_INDIRECT_IMAGE 0
#define GATHERED_DIRECT_IMAGE 1

// The radiance gather.
#define RADIANCE_UNIT GBUFFER_UNITS
#define OCCUPANCY_UNIT (GBUFFER_UNITS + 1)

#endif
