#include "propagation/lobes/sh_lobes_kernels.h"

#include <string_view>

namespace volgi {

namespace {

bool runs_avx2() { return __builtin_cpu_supports("avx2") != 0 && __builtin_cpu_supports("fma") != 0; }
bool runs_avx512() {
  return runs_avx2() && __builtin_cpu_supports("avx512f") != 0 && __builtin_cpu_supports("avx512vl") != 0 &&
         __builtin_cpu_supports("avx512dq") != 0 && __builtin_cpu_supports("avx512bw") != 0;
}

}  // namespace

const LobeKernels* lobe_kernels(int order, const char* instruction_set) {
  const std::string_view name(instruction_set);
  if (name == "avx512") {
    if (!runs_avx512()) return nullptr;
    return order == 1 ? &lobes_avx512::kOrder1 : &lobes_avx512::kOrder2;
  }
  if (name == "avx2") {
    if (!runs_avx2()) return nullptr;
    return order == 1 ? &lobes_avx2::kOrder1 : &lobes_avx2::kOrder2;
  }
  return order == 1 ? &lobes_baseline::kOrder1 : &lobes_baseline::kOrder2;
}

const LobeKernels& lobe_kernels(int order) {
  for (const char* name : {"avx512", "avx2"}) {
    if (const LobeKernels* kernels = lobe_kernels(order, name)) return *kernels;
  }
  return *lobe_kernels(order, "baseline");
}

}  // namespace volgi
