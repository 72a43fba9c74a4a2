#include "stock/octree/sweep_lanes.h"

namespace kerf::octree {

SweepKernel scalar_kernel() { return {&lanes_distance, &lanes_gradient, &lanes_turn_bound}; }

}  // namespace kerf::octree
