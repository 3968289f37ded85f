#ifndef VOLGI_SUM_IN_ORDER_SHARED_H
#define VOLGI_SUM_IN_ORDER_SHARED_H
#include "shared/base.shared.h"

#define SUM_PARTS 64  // of a list, summed beside each other
#define PART_SUMS_SLOT 8

#endif
