#include "stock/zmap/zmap_kernel.h"

#include <algorithm>

namespace kerf {

std::string_view to_string(ZMapKernel kernel) {
  switch (kernel) {
    case ZMapKernel::kAuto:
      return "auto";
    case ZMapKernel::kScalar:
      return "scalar";
    case ZMapKernel::kSse2:
      return "sse2";
    case ZMapKernel::kAvx2:
      return "avx2";
    case ZMapKernel::kNeon:
      return "neon";
  }
  return "";
}

std::vector<ZMapKernel> zmap_kernels() {
  std::vector<ZMapKernel> kernels;
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx2")) kernels.push_back(ZMapKernel::kAvx2);
  kernels.push_back(ZMapKernel::kSse2);
#elif defined(__aarch64__)
  kernels.push_back(ZMapKernel::kNeon);
#endif
  kernels.push_back(ZMapKernel::kScalar);
  return kernels;
}

bool zmap_can_run(ZMapKernel kernel) {
  const std::vector<ZMapKernel> kernels = zmap_kernels();
  return kernel == ZMapKernel::kAuto ||
         std::find(kernels.begin(), kernels.end(), kernel) != kernels.end();
}

}  // namespace kerf
