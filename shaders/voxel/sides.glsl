// All sides.
#ifndef VOLGI_SIDES_GLSL
#define VOLGI_SIDES_GLSL
#include "shared/side.shared.h"
#include "voxel/slots.shared.h"

layout(std430, binding = SIDES_SLOT) readonly buffer Sides { Side sides[]; };

#endif
