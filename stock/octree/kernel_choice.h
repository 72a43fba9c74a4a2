// stock/octree/kernel_choice.h - which instructions cut an octree, for those who only choose.
#pragma once

namespace kerf::octree {

/// Which instructions the kernels use. All give the same bits.
enum class KernelChoice { kAuto, kScalar, kAvx2, kAvx512 };

/// True if this machine can run these kernels.
bool has_avx2();
bool has_avx512();

}  // namespace kerf::octree
