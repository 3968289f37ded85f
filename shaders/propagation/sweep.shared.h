// Sizes that the sweep's shaders and their programs agree on.
#ifndef VOLGI_SWEEP_SHARED_H
#define VOLGI_SWEEP_SHARED_H

#define SWEEP_BLOCK 8         // cells on an edge, which a group takes
#define SIDE_ROW_BITS 10      // 2^10 sides in a row of a texture
#define ARRIVED_ROW_BITS 8    // the same where each has its octants' parts
#define DIAGONAL_ROW_BITS 10  // blocks or columns of all diagonals

#endif
