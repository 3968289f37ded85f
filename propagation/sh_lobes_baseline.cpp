#define VOLGI_LOBES lobes_baseline
#define VOLGI_LOBES_WIDTH 8
#include "propagation/sh_lobes_kernels.inl"
