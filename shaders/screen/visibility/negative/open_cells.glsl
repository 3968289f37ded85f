// Cells that light of virtual lights can reach at all: not inside bodies, not in rooms closed to it.
#ifndef VOLGI_OPEN_CELLS_GLSL
#define VOLGI_OPEN_CELLS_GLSL
#include "shared/grid.shared.h"
#include "shared/side.shared.h"

layout(std140, binding = 0) uniform GridBlock { Grid grid; };
layout(std430, binding = 3) readonly buffer CellSides { uvec2 cell_sides[]; };
layout(std430, binding = 6) buffer OpenCells { uint open_cells[]; };  // 0 or 1 a cell

bool face_is_opaque(ivec3 cell, int face) { return is_opaque(cell_sides[cell_index(grid, cell)], face); }

#endif
