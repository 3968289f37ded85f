#ifndef VOLGI_PARTIAL_SUMS_SHARED_H
#define VOLGI_PARTIAL_SUMS_SHARED_H

#define PARTIAL_SUMS 64  // of a long sum, each a group's; sum_partials adds them

#endif
