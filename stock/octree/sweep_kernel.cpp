#include "stock/octree/sweep_kernel.h"

#include <cassert>

namespace kerf::octree {

#if defined(__x86_64__)
bool has_avx2() {
  return __builtin_cpu_supports("avx2") != 0 && __builtin_cpu_supports("bmi") != 0 &&
         __builtin_cpu_supports("popcnt") != 0;
}
bool has_avx512() {
  return has_avx2() && __builtin_cpu_supports("avx512f") != 0 &&
         __builtin_cpu_supports("avx512dq") != 0 && __builtin_cpu_supports("avx512vl") != 0 &&
         __builtin_cpu_supports("avx512bw") != 0;
}
#else
bool has_avx2() { return false; }
bool has_avx512() { return false; }
SweepKernel avx2_kernel() { return scalar_kernel(); }
SweepKernel avx512_kernel() { return scalar_kernel(); }
#endif

SweepKernel pick_kernel(KernelChoice choice) {
  assert(choice != KernelChoice::kAvx2 || has_avx2());
  assert(choice != KernelChoice::kAvx512 || has_avx512());
  if (choice == KernelChoice::kAuto)
    choice = has_avx512() ? KernelChoice::kAvx512
             : has_avx2() ? KernelChoice::kAvx2
                          : KernelChoice::kScalar;
  switch (choice) {
    case KernelChoice::kAvx512:
      return avx512_kernel();
    case KernelChoice::kAvx2:
      return avx2_kernel();
    default:
      return scalar_kernel();
  }
}

}  // namespace kerf::octree
