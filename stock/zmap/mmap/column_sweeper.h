// stock/zmap/mmap/column_sweeper.h - moves cut into columns of several intervals.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "stock/zmap/height_sweeper.h"
#include "stock/zmap/mmap/gap_grid.h"
#include "stock/zmap/mmap/headed_tool.h"

namespace kerf {

/// Cuts heights and gaps together. Made for one call; both grids must outlive it.
///
/// Cutters without undercut lower the heights as in a Z-map, to the same bits; a kernel that knows
/// of gaps sees where that breaks into one, and open() then lowers the cell through it. Of cutters
/// with a head the Z-map's kernels sweep each move into tiles of scratch heights (the upper sides
/// of heads turned over), and what they find over a cell is taken from its column.
class ColumnSweeper final : public HollowColumns {
 public:
  ColumnSweeper(HeightSweeper& heights, GapGrid& gaps) : heights_(heights), gaps_(gaps) {}

  std::optional<GapView> begin(const SweepBatch& batch) override;
  void end() override;
  bool any() const override { return gaps_.any(); }
  /// A cutter with a head, everywhere. totals[i] receives what moves[i] removes.
  void cut_headed(const HeadedTool& tool, std::span<const CutMove> moves,
                  std::span<SweepTotals> totals);

 private:
  bool comes_near_gaps(const SweepBatch& batch) const;
  GapTile& writable_gaps(std::size_t tile);
  float open(GapTile& gaps, std::size_t cell, float* height, float before, std::uint32_t report);
  template <class Work>
  void share_out(std::span<SweepTotals> totals, const Work& work);

  HeightSweeper& heights_;
  GapGrid& gaps_;
  std::vector<const float*> tops_;  ///< GapView::tops
  const std::uint32_t* cut_ids_ = nullptr;
};

}  // namespace kerf
