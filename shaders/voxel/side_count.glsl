// How many of the list are sides.
#ifndef VOLGI_SIDE_COUNT_GLSL
#define VOLGI_SIDE_COUNT_GLSL
#include "voxel/slots.shared.h"

layout(std430, binding = SIDE_COUNT_SLOT) readonly buffer SideCount { uint side_count; };

#endif
