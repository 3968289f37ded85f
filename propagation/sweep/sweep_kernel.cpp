#define VOLGI_SWEEP_WIDE 0
#include "propagation/sweep/sweep_kernel_body_internal.h"

namespace volgi::sweep {

Kernels baseline() { return {"baseline", kernel, fill_face, refine_face, coarsen_face}; }

Available available() {
  Available a;
  // What GCC's -mavx512f and friends let the compiler use in sweep_kernel_avx512.cpp.
  const bool wide = __builtin_cpu_supports("avx512f") != 0 && __builtin_cpu_supports("avx512vl") != 0 &&
                    __builtin_cpu_supports("avx512dq") != 0;
  const bool fused = __builtin_cpu_supports("avx2") != 0 && __builtin_cpu_supports("fma") != 0;
  if (wide && fused) a.kernels[a.count++] = avx512();
  if (fused) a.kernels[a.count++] = avx2();
  a.kernels[a.count++] = baseline();
  return a;
}

}  // namespace volgi::sweep
