// twin/load_meter.h - where along a motion material is removed, and how fast: a motion that is
// partly in the air is no cutting for so long, and its mean rate is no peak.
#pragma once

#include <cstddef>
#include <vector>

#include "stock/stock_model.h"

namespace kerf {

/// What one motion did.
struct MotionLoad {
  double cut_s = 0;           ///< of its time, while material was removed
  double peak_mm3_per_s = 0;  ///< greatest rate over a window of its way: LoadMeter
};

/// Cuts a motion in pieces, in a snapshot that is thrown away: the workpiece is cut as a whole, and
/// keeps its bits. Costs about two to four cuts of that motion; the first division is into at most
/// kPieces, and only where the cutter enters or leaves material it is made finer. Where in its time
/// the machine is where follows from duration and greatest speed, as if it started and ended at
/// rest; moves that are run through at one speed have no such ramps.
///
/// A rate is that over a window of the way: a quarter of the cutter's diameter, at least 20 cells
/// (the whole way where it is shorter); neighbouring windows that differ by less than 2 % are
/// averaged, so that cells do not make a peak. One thread; nothing is allocated in steady state but
/// what the snapshot takes.
class LoadMeter {
 public:
  static constexpr int kPieces = 32;

  explicit LoadMeter(const StockModel& stock) : stock_(stock) {}

  /// Of a move that is going to be cut (is_one_piece()) and lasts so long; all before it has been
  /// given to the model. `speed_mm_per_s`: the greatest on the way, 0: not known.
  MotionLoad measure(const Cutter& cutter, const CutMove& move, double duration_s,
                     double speed_mm_per_s);
  /// The spindle does not turn about on the way.
  static bool is_one_piece(const CutMove& move) { return move.axis_from == move.axis_to; }

 private:
  struct Span {
    double from = 0, to = 0;  ///< fraction of the way
    double removed_mm3 = 0;
    bool cuts() const { return removed_mm3 > 0; }
    double density() const { return removed_mm3 / (to - from); }
  };
  void cut_pieces(const Cutter& cutter, const CutMove& move);
  bool is_end(std::size_t i) const;
  bool refine(double least_part, double cell_part);
  double peak(double window_part) const;

  const StockModel& stock_;
  /// Time at a fraction of the way.
  struct Profile {
    double length_mm = 0, duration_s = 0, speed_mm_per_s = 0, ramp_mm = 0, ramp_s = 0;
    double at(double part) const;
  };
  Profile profile_;
  std::vector<Span> spans_, finer_;
  std::vector<CutMove> moves_;
  std::vector<CutReport> reports_;
};

}  // namespace kerf
