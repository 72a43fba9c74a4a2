#include "stock/octree/sweep_lanes.h"

namespace kerf::octree {

SweepKernel avx2_kernel() { return {&lanes_distance, &lanes_gradient, &lanes_turn_bound}; }

}  // namespace kerf::octree
