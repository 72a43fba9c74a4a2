// Kernel for any machine.
#define KERF_LANES_NAMESPACE zmap_scalar
#include "stock/zmap/sweep_walk.h"

namespace kerf::zmap_scalar {

void run_sweeps(GridView& grid, const ConvexTool& tool, const SweepOp* ops, std::size_t count,
                int first_band, int band_step, SweepTotals* totals) {
  run_all(grid, tool, ops, count, first_band, band_step, totals);
}

}  // namespace kerf::zmap_scalar
