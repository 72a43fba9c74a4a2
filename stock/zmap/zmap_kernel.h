// stock/zmap/zmap_kernel.h - which instructions cut a Z-map, for those who only choose.
#pragma once

namespace kerf {

/// Which instructions the cutting kernel uses. All give the same bits.
enum class ZMapKernel { kAuto, kScalar, kAvx2 };

/// True if this machine can run the AVX2 kernel.
bool zmap_has_avx2();

}  // namespace kerf
