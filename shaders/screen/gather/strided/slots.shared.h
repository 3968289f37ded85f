// Beside what screen/base and screen/visibility/negative name.
#ifndef VOLGI_STRIDED_SLOTS_SHARED_H
#define VOLGI_STRIDED_SLOTS_SHARED_H
#include "screen/base/gbuffer.shared.h"

#define GATHERED_IMAGE 0

// Discontinuities.
#define COARSE_INDIRECT_UNIT GBUFFER_UNITS
#define COARSE_DIRECT_UNIT (GBUFFER_UNITS + 1)
#define FINE_INDIRECT_IMAGE 0
#define FINE_DIRECT_IMAGE 1

#endif
