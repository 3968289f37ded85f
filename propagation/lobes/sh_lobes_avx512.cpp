#define VOLGI_LOBES lobes_avx512
#define VOLGI_LOBES_WIDTH 16
#include "propagation/lobes/sh_lobes_kernels.inl"
