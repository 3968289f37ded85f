// The volume's frame.
#ifndef VOLGI_GRID_BLOCK_GLSL
#define VOLGI_GRID_BLOCK_GLSL
#include "shared/grid.shared.h"
#include "voxel/slots.shared.h"

layout(std140, binding = GRID_BLOCK) uniform GridBlock { Grid grid; };

#endif
