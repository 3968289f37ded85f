#define VOLGI_SWEEP_WIDE 0
#include "propagation/sweep/sweep_kernel_body_internal.h"

namespace volgi::sweep {

Kernels avx2() { return {"avx2", kernel, fill_face, refine_face, coarsen_face}; }

}  // namespace volgi::sweep
