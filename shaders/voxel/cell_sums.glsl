// What a cell adds up of the surface in it. Areas in 2^-20 h^2; maxima as bits of floats, which are ordered as the numbers
// are. Two numbers a buffer, so that buffers stay below 128 MiB up to 256^3 cells.
#include "voxel/slots.shared.h"

const float AREA_UNITS = 1048576.0;
layout(std430, binding = CELL_SUMS_SLOT) buffer CellSums { uvec2 at[]; } cell_sums[6];
// 0: area, most that is stopped; 1: albedo r, g; 2: albedo b, normal x; 3: normal y, z (as int); 4: most radiosity r, g;
// 5: its b
