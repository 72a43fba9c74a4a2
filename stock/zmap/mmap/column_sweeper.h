// stock/zmap/mmap/column_sweeper.h - moves cut into columns of several intervals.
#pragma once

#include <span>
#include <vector>

#include "stock/zmap/height_sweeper.h"
#include "stock/zmap/mmap/gap_grid.h"
#include "stock/zmap/mmap/headed_tool.h"

namespace kerf {

/// Cuts heights and gaps together. The Z-map's kernels sweep each move into tiles of scratch
/// heights (the upper sides of heads turned over), and what they find over a cell is taken from its
/// column. Made for one call; both grids must outlive it.
class ColumnSweeper final : public OtherTiles {
 public:
  ColumnSweeper(HeightSweeper& heights, GapGrid& gaps) : heights_(heights), gaps_(gaps) {}

  /// Cutters without undercut: the tiles that have gaps at heights that the batch may reach. Above
  /// all gaps of a tile its heights are lowered as those of a Z-map, to the same bits.
  bool take(const SweepBatch& batch) override;
  bool holds(std::size_t tile) const override { return taken_[tile] != 0; }
  void cut(const SweepBatch& batch, std::span<SweepTotals> totals) override;
  /// A cutter with a head, everywhere. totals[i] receives what moves[i] removes.
  void cut_headed(const HeadedTool& tool, std::span<const CutMove> moves,
                  std::span<SweepTotals> totals);

 private:
  template <class Work>
  void share_out(std::span<SweepTotals> totals, const Work& work);

  HeightSweeper& heights_;
  GapGrid& gaps_;
  std::vector<char> taken_;  ///< by tile
  Box taken_mm_;
};

}  // namespace kerf
