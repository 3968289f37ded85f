// Which sides each cell has.
#ifndef VOLGI_CELL_SIDES_GLSL
#define VOLGI_CELL_SIDES_GLSL
#include "shared/side.shared.h"
#include "voxel/slots.shared.h"

layout(std430, binding = CELL_SIDES_SLOT) readonly buffer CellSides { uvec2 cell_sides[]; };

#endif
