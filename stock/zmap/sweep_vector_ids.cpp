// Kernel of vectors of 16 bytes that also notes which move lowered each cell (sweep_vector.cpp
// does not).
#define KERF_LANES_NAMESPACE zmap_vector_ids
#define KERF_LANES_VECTOR 1
#define KERF_LANES_CUT_IDS 1
#include "stock/zmap/sweep_walk.h"

namespace kerf::zmap_vector_ids {

void run_sweeps(GridView& grid, const ConvexTool& tool, const SweepOp* ops, std::size_t count,
                int first_band, int band_step, SweepTotals* totals) {
  run_all(grid, tool, ops, count, first_band, band_step, totals);
}

}  // namespace kerf::zmap_vector_ids
