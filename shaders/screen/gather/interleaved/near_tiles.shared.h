#ifndef VOLGI_NEAR_TILES_SHARED_H
#define VOLGI_NEAR_TILES_SHARED_H
#include "shared/base.shared.h"

#define NEAR_TILE 8   // pixels on a side
#define LARGE_TILE 4  // tiles on a side of a large one

#endif
