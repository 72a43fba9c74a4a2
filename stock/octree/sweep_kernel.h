// stock/octree/sweep_kernel.h - F of a sweep at many points at once.
#pragma once

#include "stock/octree/sweep.h"

namespace kerf::octree {

/// Points handed to the kernels come in arrays whose room is a multiple of this; what lies behind
/// the last point is read (it must be finite) and overwritten.
inline constexpr int kLanes = 8;

/// F, and on request its gradient, at n points. All variants give the same bits, for each point the
/// same whatever the others are. F of a sweep found by iteration is too great by at most
/// kSweepSlack_mm, never too small.
struct SweepKernel {
  void (*distance)(const Sweep& sweep, int n, const double* x, const double* y, const double* z,
                   double* f);
  void (*gradient)(const Sweep& sweep, int n, const double* x, const double* y, const double* z,
                   double* f, double* gx, double* gy, double* gz);
  /// Of a turning piece of any bend: what F is not less than. As close as telling it from `level`
  /// takes, within sixteenths of the bend.
  void (*turn_bound)(const Sweep& sweep, double level, int n, const double* x, const double* y,
                     const double* z, double* f);
};
inline constexpr double kSweepSlack_mm = 1e-7;

enum class KernelChoice { kAuto, kScalar, kAvx2 };
/// kAuto: the fastest this machine has. kAvx2 must not be asked for where has_avx2() is false.
SweepKernel pick_kernel(KernelChoice choice);
bool has_avx2();

/// One for each instruction set (sweep_lanes.h compiled twice).
SweepKernel scalar_kernel();
SweepKernel avx2_kernel();

}  // namespace kerf::octree
