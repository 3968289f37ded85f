// Cells that light of virtual lights can reach at all: not inside bodies, not in rooms closed to it.
#ifndef VOLGI_OPEN_CELLS_GLSL
#define VOLGI_OPEN_CELLS_GLSL
#include "screen/visibility/negative/slots.shared.h"
#include "voxel/cell_sides.glsl"
#include "voxel/grid_block.glsl"

layout(std430, binding = OPEN_CELLS_SLOT) buffer OpenCells { uint open_cells[]; };  // 0 or 1 a cell

bool face_is_opaque(ivec3 cell, int face) { return is_opaque(cell_sides[cell_index(grid, cell)], face); }

#endif
