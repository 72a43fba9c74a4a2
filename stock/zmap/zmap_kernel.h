// stock/zmap/zmap_kernel.h - which instructions cut a Z-map, for those who only choose.
#pragma once

#include <string_view>
#include <vector>

namespace kerf {

/// Which instructions the cutting kernel uses. All give the same bits. A machine that cannot run
/// one is given what kAuto is there.
enum class ZMapKernel {
  kAuto,    ///< the fastest that this machine runs
  kScalar,  ///< of no instructions in particular
  kSse2,    ///< four numbers at a time: every x86-64
  kAvx2,    ///< eight at a time
  kNeon,    ///< four at a time: every arm64
};

std::string_view to_string(ZMapKernel kernel);  ///< "auto", "scalar", "sse2", ...

/// Those that this machine runs, the fastest first, kScalar last.
std::vector<ZMapKernel> zmap_kernels();
bool zmap_can_run(ZMapKernel kernel);

}  // namespace kerf
