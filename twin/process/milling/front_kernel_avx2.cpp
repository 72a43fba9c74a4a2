// The loops of front_kernel.h for machines with AVX2.
#define KERF_FRONT_NAMESPACE front_avx2
#include "twin/process/milling/front_kernel_loops.h"

namespace kerf::front_avx2 {

extern const FrontKernel kKernel;
constinit const FrontKernel kKernel{"avx2", lay_ray, look_along, collect, take_cells, place_cells};

}  // namespace kerf::front_avx2
