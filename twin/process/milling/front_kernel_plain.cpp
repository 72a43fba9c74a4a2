// The loops of front_kernel.h for every machine.
#define KERF_FRONT_NAMESPACE front_plain
#include "twin/process/milling/front_kernel_loops.h"

namespace kerf {

#if defined(__x86_64__)
namespace front_avx2 {
extern const FrontKernel kKernel;
}
#endif

namespace {

constexpr FrontKernel kPlain{"plain",
                             front_plain::lay_ray,
                             front_plain::look_along,
                             front_plain::collect,
                             front_plain::take_cells,
                             front_plain::place_cells};

}  // namespace

std::span<const FrontKernel> front_kernels() {
#if defined(__x86_64__)
  static const FrontKernel kernels[] = {front_avx2::kKernel, kPlain};
  static const bool has_avx2 = __builtin_cpu_supports("avx2");
  return std::span(kernels).subspan(has_avx2 ? 0 : 1);
#else
  return {&kPlain, 1};
#endif
}

}  // namespace kerf
