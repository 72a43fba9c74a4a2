// stock/octree/sweep_kernel.h - F of a sweep at many points at once, and what a brick loses by it.
#pragma once

#include "stock/octree/brick_work.h"
#include "stock/octree/kernel_choice.h"
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
  /// Takes the sweep from an open brick; false if nothing has changed. Else work has what was
  /// removed, and in lost_edges where there may be films, with F and its gradient.
  bool (*remove)(BrickWork& work, const Sweep& sweep, OpenBrick& brick);
  /// Would it take something? Changes nothing of the brick.
  bool (*meets)(BrickWork& work, const Sweep& sweep, const OpenBrick& brick);
};
inline constexpr double kSweepSlack_mm = 1e-7;

/// kAuto: the fastest this machine has. Others must not be asked for where has_avx2() or
/// has_avx512() is false.
SweepKernel pick_kernel(KernelChoice choice);

/// One for each instruction set (sweep_lanes.h and brick_lanes.h compiled for each).
SweepKernel scalar_kernel();
SweepKernel avx2_kernel();
SweepKernel avx512_kernel();

}  // namespace kerf::octree
