#include "stock/octree/sweep_kernel.h"

#include <cassert>

namespace kerf::octree {

#if defined(__x86_64__)
bool has_avx2() { return __builtin_cpu_supports("avx2") != 0; }
#else
bool has_avx2() { return false; }
SweepKernel avx2_kernel() { return scalar_kernel(); }
#endif

SweepKernel pick_kernel(KernelChoice choice) {
  assert(choice != KernelChoice::kAvx2 || has_avx2());
  const bool avx2 = choice == KernelChoice::kAuto ? has_avx2() : choice == KernelChoice::kAvx2;
  return avx2 ? avx2_kernel() : scalar_kernel();
}

}  // namespace kerf::octree
