#ifndef VOLGI_SCAN_SHARED_H
#define VOLGI_SCAN_SHARED_H
#include "shared/base.shared.h"

#define SCAN_BLOCK 256  // numbers that one group sums

#define SCAN_NUMBERS_SLOT 0
#define SCAN_BLOCK_SUMS_SLOT 1

#endif
