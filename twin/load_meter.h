// twin/load_meter.h - where along a motion material is removed, and how fast: a motion that is
// partly in the air is no cutting for so long, and its mean rate is no peak.
#pragma once

#include <cstddef>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "stock/stock_model.h"

namespace kerf {

/// What one motion did.
struct MotionLoad {
  double cut_s = 0;           ///< of its time, while material was removed
  double peak_mm3_per_s = 0;  ///< greatest rate: LoadMeter
};

/// What geometry alone says of a motion.
struct MotionReach {
  double seconds = 0;  ///< of its time, while the cutter is where the blank was
  /// Its greatest speed a mm of that way: times what the motion removes it is the rate of its mean
  /// cross-section. 0: the way is shorter than a window.
  double speed_per_mm = 0;
  /// Nothing removes more in a second than its width times this, for each mm of depth, ..
  double side_mm2_per_s = std::numeric_limits<double>::infinity();
  /// .. and its disc times its speed up or down. Of upright tools.
  double disc_mm3_per_s = 0;
};

/// Cuts motions in pieces, in a snapshot that is thrown away: the workpiece is cut as a whole, and
/// keeps its bits. What that costs is limited by counts, not by a clock, so the results are the
/// same for any threads and batches: a measurement is made while those before have swept no more
/// cells than kFreeCells and kShare of what was cut, so all of them take about that share of the
/// cutting time, and one measurement more. What is not measured is known by its reach().
///
/// The way is cut in up to kPieces; where cutting begins and ends among them is searched by
/// halves, to 0.2 % of the way that cuts or half a cell, whichever is more. Cells have bounds: a
/// sliver thinner than half a cell is not there to be cut. It matters where a round cutter leaves
/// the material on both sides of its way: cutting seems over up to cell / 2 + sqrt(D * cell / 2)
/// before it is, and it may seem to begin half a cell late.
///
/// A rate is the mean cross-section over a window of the way times the greatest speed there;
/// neighbouring windows that differ by less than 2 % are averaged, so that cells do not make a
/// peak. A window is a quarter of the cutter's diameter, at least 20 cells (the whole way where it
/// is shorter; longer where kPieces of them are shorter than the way). Where in its time the
/// machine is follows from duration and greatest speed, as if it started and ended at rest; moves
/// that are run through at one speed have no such ramps. One thread.
class LoadMeter {
 public:
  static constexpr int kPieces = 16;
  static constexpr double kFreeCells = 5e5;
  static constexpr double kShare = 0.03;

  explicit LoadMeter(const StockModel& stock) : stock_(stock) {}

  /// Of each feed move that is going to be cut (is_one_piece()) and lasts so long.
  /// `speed_mm_per_s`: the greatest on the way, 0: not known.
  MotionReach reach(const Cutter& cutter, const CutMove& move, double duration_s,
                    double speed_mm_per_s);
  /// There is something left to spend.
  bool affords() const { return left_cells_ >= 0; }
  /// Of the move that reach() was asked about last; all before it has been given to the model.
  MotionLoad measure(const Cutter& cutter, const CutMove& move);
  /// The spindle does not turn about on the way.
  static bool is_one_piece(const CutMove& move) { return move.axis_from == move.axis_to; }

 private:
  struct Span {
    double from = 0, to = 0;  ///< fraction of the way
    double removed_mm3 = 0;
    bool cuts() const { return removed_mm3 > 0; }
  };
  /// Time and speed at a fraction of the way.
  struct Profile {
    double length_mm = 0, duration_s = 0, speed_mm_per_s = 0, ramp_mm = 0, ramp_s = 0;
    double at(double part) const;
    double speed_at(double part) const;
    double greatest_speed(double from, double to) const;
  };
  double window_mm(const Cutter& cutter) const;
  void clip(const Cutter& cutter, const CutMove& move);
  double cut_part(StockModel& stock, double from, double to);
  void cut_spans(const StockModel& before, double from, double to, int pieces);
  double find_begin(const Span& span, const StockModel& before, double least);
  double find_end(const Span& span, const StockModel& before, double least);
  void add_run(std::size_t first, std::size_t end, double window, MotionLoad& load);
  double peak(std::size_t first, std::size_t end, double window) const;

  const StockModel& stock_;
  double left_cells_ = kFreeCells;
  Profile profile_;
  double from_ = 0, to_ = 1;  ///< of the way, where the cutter is where the blank was
  const Cutter* cutter_ = nullptr;
  const CutMove* move_ = nullptr;
  std::vector<Span> spans_;
  std::vector<std::unique_ptr<StockModel>> before_;  ///< the workpiece before each of them
  std::vector<CutMove> moves_;
  std::vector<CutReport> reports_;
};

}  // namespace kerf
