#define VOLGI_SWEEP_WIDE 1
#include "propagation/sweep/sweep_kernel_body_internal.h"

namespace volgi::sweep {

Kernels avx512() { return {"avx512", kernel, fill_face, refine_face, coarsen_face}; }

}  // namespace volgi::sweep
