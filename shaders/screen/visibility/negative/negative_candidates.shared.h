#ifndef VOLGI_NEGATIVE_CANDIDATES_SHARED_H
#define VOLGI_NEGATIVE_CANDIDATES_SHARED_H

// Middles of so many equal parts of the screen.
#define CANDIDATES_X 64
#define CANDIDATES_Y 64

#define BLOCK_EDGE 8  // cells of a block of sides_by_block.glsl

#endif
