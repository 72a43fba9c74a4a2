// Kernel of vectors of 16 bytes: SSE2, which every x86-64 has, or NEON, which every arm64 has.
#define KERF_LANES_NAMESPACE zmap_vector
#define KERF_LANES_VECTOR 1
#include "stock/zmap/sweep_walk.h"

namespace kerf::zmap_vector {

void run_sweeps(GridView& grid, const ConvexTool& tool, const SweepOp* ops, std::size_t count,
                int first_band, int band_step, SweepTotals* totals) {
  run_all(grid, tool, ops, count, first_band, band_step, totals);
}

}  // namespace kerf::zmap_vector
