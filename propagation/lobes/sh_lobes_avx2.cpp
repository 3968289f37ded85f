#define VOLGI_LOBES lobes_avx2
#define VOLGI_LOBES_WIDTH 8
#include "propagation/lobes/sh_lobes_kernels.inl"
