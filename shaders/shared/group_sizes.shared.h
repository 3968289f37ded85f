// Sizes of work groups: shaders declare them, and programs dispatch by them.
#ifndef VOLGI_GROUP_SIZES_SHARED_H
#define VOLGI_GROUP_SIZES_SHARED_H

#define LINEAR_GROUP 64  // of the elements of a list
#define SQUARE_GROUP 8   // pixels or texels on each edge

// Cells on each edge.
#define CELL_GROUP_X 8
#define CELL_GROUP_Y 8
#define CELL_GROUP_Z 4

#endif
