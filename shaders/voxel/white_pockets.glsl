// Where light leaves closed places: voxel/white_pockets.h.
#ifndef VOLGI_WHITE_POCKETS_GLSL
#define VOLGI_WHITE_POCKETS_GLSL
#include "voxel/cell_sides.glsl"
#include "voxel/grid_block.glsl"
#include "voxel/white_pockets.shared.h"

layout(std430, binding = CELL_MARKS_SLOT) buffer Leaving { uint leaving[]; };  // bits of bands, a cell

#endif
