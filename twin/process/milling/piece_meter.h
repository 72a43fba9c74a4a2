// twin/process/milling/piece_meter.h - what a move removes, found out by cutting it in pieces.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "stock/stock_model.h"
#include "twin/process/milling/load_meter.h"
#include "twin/process/milling/way_profile.h"
#include "twin/process/milling/way_spans.h"

namespace kerf {

/// For models, cutters and moves that nothing quicker takes. Cuts in snapshots, which are thrown
/// away; LoadMeter says how exact that is. Costs some twenty times what cutting the move does.
class PieceMeter {
 public:
  /// Pieces of a move, at first.
  static constexpr int kPieces = 16;

  explicit PieceMeter(const StockModel& stock) : stock_(stock) {}

  /// `way`: of the move, on which something can be cut. `window`: the part of the whole way that a
  /// rate is taken over.
  MotionLoad measure(const Cutter& cutter, const CutMove& move, const WayProfile& profile,
                     WaySpan way, double window);
  /// Of the last measure(), in cells that were cut.
  double cost_cells() const { return cost_cells_; }

 private:
  struct Piece {
    double from = 0, to = 0;  ///< fraction of the way
    double removed_mm3 = 0;
    bool cuts() const { return removed_mm3 > 0; }
  };
  double cut_part(StockModel& stock, double from, double to);
  void cut_pieces(const StockModel& before, double from, double to, int pieces);
  double find_begin(const Piece& piece, const StockModel& before, double least);
  double find_end(const Piece& piece, const StockModel& before, double least);
  void add_run(std::size_t first, std::size_t end, double window, MotionLoad& load) const;
  double peak(std::size_t first, std::size_t end, double window) const;

  const StockModel& stock_;
  double cost_cells_ = 0;
  const Cutter* cutter_ = nullptr;
  const CutMove* move_ = nullptr;
  WayProfile profile_;
  std::vector<Piece> pieces_;
  std::vector<std::unique_ptr<StockModel>> before_;  ///< the workpiece before each of them
  std::vector<CutMove> moves_;
  std::vector<CutReport> reports_;
};

}  // namespace kerf
