// Beside what the G-buffer, the volume and virtual lights name.
#ifndef VOLGI_VIEWS_SLOTS_SHARED_H
#define VOLGI_VIEWS_SLOTS_SHARED_H
#include "screen/base/gbuffer.shared.h"

#define VIEWED_TEXTURE_UNIT 0

// gbuffer_view
#define VIEWED_EMISSION_UNIT GBUFFER_UNITS
#define VIEWED_OBJECT_ID_UNIT (GBUFFER_UNITS + 1)

// lights_view, beside VIRTUAL_LIGHTS_SLOT
#define TOTAL_FLUX_SLOT 1
#define TOTAL_FLUX_BLOCK 0

// light_tree_level
#define VIEWED_NODES_SLOT 2
#define LIGHTS_OF_NODES_SLOT 3

// lobe_view
#define VIEWED_RADIANCE_UNIT 0
#define LOBE_RINGS 32
#define LOBE_SEGMENTS 64

// error_view, wipe
#define JUDGED_RADIANCE_UNIT 0
#define REFERENCE_RADIANCE_UNIT 1

#endif
