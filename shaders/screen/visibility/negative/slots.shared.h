// Beside VIRTUAL_LIGHTS_SLOT and what VoxelGridGl::bind() binds.
#ifndef VOLGI_NEGATIVE_SLOTS_SHARED_H
#define VOLGI_NEGATIVE_SLOTS_SHARED_H

#define PLACED_LIGHTS_SLOT 1
#define PASSED_FLUX_SLOT 2
#define BLOCK_STARTS_SLOT 2
#define OPEN_CELLS_SLOT 6
#define SIDES_BY_BLOCK_SLOT 7

#define NEGATIVE_LIGHTS_BLOCK 1  // of a gather

#endif
