#include "stock/octree/brick_lanes.h"

namespace kerf::octree {

SweepKernel scalar_kernel() {
  return {&lanes_distance, &lanes_gradient, &brick_remove, &brick_meets};
}

}  // namespace kerf::octree
