// twin/process/milling/load_meter.h - where along a motion material is removed, and how fast: a
// motion that is partly in the air is no cutting for so long, and its mean rate is no peak.
#pragma once

#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "stock/stock_model.h"
#include "twin/job/tool_use.h"

namespace kerf {

/// What one motion did.
struct MotionLoad {
  double cut_s = 0;           ///< of its time, while material was removed
  double peak_mm3_per_s = 0;  ///< greatest rate: LoadMeter
};

/// What geometry alone says of a motion.
struct MotionReach {
  FeedPart part;  ///< of it, while the cutter is where the blank was
  /// Its greatest speed a mm of that way: times what the motion removes it is the rate of its mean
  /// cross-section. 0: the way is shorter than a window.
  double speed_per_mm = 0;
  /// Nothing removes more in a second than its width times this, for each mm of depth, ..
  double side_mm2_per_s = std::numeric_limits<double>::infinity();
  /// .. and its disc times its speed up or down. Of upright tools.
  double disc_mm3_per_s = 0;
};

/// Works out what a feed move is going to do to the workpiece as it is. When it cuts is told by a
/// few lanes along the way: by heights (EngagementScan::run_lanes), by points where these do not
/// say it (LaneScan: octrees). A rate that may be the greatest so far is looked at closely: by all
/// heights about the windows that may have it (EngagementScan::run_part), by the material before
/// the cutter's front (FrontSection); else, as all of a move that none of them takes (undercuts in
/// an M-map, arcs that are none about Z, peaks of tilted tools), by cutting in pieces, in a
/// snapshot that is thrown away. The workpiece is cut as a whole, and keeps its bits. Costs are
/// limited by counts, not by a clock, so results are the same for any threads and batches:
/// kFreeCells (kFreeBlocks of models for tilted tools) and kShare of what was cut, in cells. When
/// these are spent lanes are fewer and their steps longer. What is not measured counts by its
/// reach().
///
/// By heights: begins and ends at the sides of a blank are exact, at walls that were cut before
/// they are good to half a cell (to cell / 2 + sqrt(D * cell / 2) where the cutter runs along such
/// a wall with its widest). Air of less than three eighths of a window is not seen; where little is
/// left to spend, stretches of less than two windows may be missed. Then only a rate that exceeds
/// what is known by 4 % is looked at closely; when much more than that has been spent one that does
/// by 30 %, and others count by lanes, less 4 % (half, by points). By points: ends are good to a
/// fortieth of a cell, of what is thicker than a twentieth of one.
///
/// In pieces (PieceMeter): ends are searched by halves, to 0.2 % of the way that cuts or half a
/// cell, whichever is more. A sliver thinner than half a cell is not there to be cut: cutting seems
/// over up to cell / 2 + sqrt(D * cell / 2) before a round cutter leaves a wall beside it, and it
/// may seem to begin half a cell late.
///
/// Peaks that are looked at closely are good to 1 % of closed forms in slots, ramps and plunges,
/// and beside or below an earlier pass, but for what cells cannot tell: by heights, beside a wall
/// that was cut before along a row of cells, up to a cell of a flat cutter's width of cut (half a
/// cell of others'); of grooves of two or three cells' width 3 %; in an octree cell^2 / 8r of the
/// thickness of a layer left by a round of radius r. What is removed within fewer than 10 cells of
/// the way counts as spread over these. Speeds are the planner's: a motion that is blended with
/// others has less time than its way takes, and is no faster for that.
///
/// A rate is the mean cross-section over a window of the way times the greatest speed there;
/// neighbouring windows that are less than 2 % below the greatest are averaged with it. A window is
/// a quarter of the cutter's diameter, at least 20 cells but straight up and down (the whole
/// stretch that is cut where it is shorter; longer where the pieces that the move is cut in are).
/// Where in its time the machine is: WayProfile. One thread.
class LoadMeter {
 public:
  /// Moves that last so long are always measured; affords_short() is for others.
  static constexpr double kLasting_s = 0.5;
  static const double kFreeCells, kFreeBlocks, kShare;

  explicit LoadMeter(const StockModel& stock);
  ~LoadMeter();

  /// Of each feed move that is going to be cut (is_one_piece()) and lasts so long.
  /// `speed_mm_per_s`: the greatest on the way, 0: not known.
  /// `reach` is a fresh one.
  void look(const Cutter& cutter, const CutMove& move, double duration_s, double speed_mm_per_s,
            MotionReach& reach);
  MotionReach reach(const Cutter& cutter, const CutMove& move, double duration_s,
                    double speed_mm_per_s) {
    MotionReach reach;
    look(cutter, move, duration_s, speed_mm_per_s, reach);
    return reach;
  }
  /// Moves that last are always measured, short ones while half of what is free is left.
  bool affords_short() const;
  /// Of the move that reach() was asked about last; all before it has been given to the model.
  /// Rates that cannot exceed `known_mm3_per_s` are not looked at closely.
  MotionLoad measure(const Cutter& cutter, const CutMove& move, double known_mm3_per_s);
  /// Of a motion that is cut as several moves, or while the spindle turns: for each of them the
  /// part of its way on which it cuts. All before the motion has been given to the model. Of models
  /// that do not tell all is taken to cut.
  void cut_parts(const Cutter& cutter, std::span<const CutMove> moves, std::vector<double>& parts);
  /// Of the way, over which rates are taken.
  double window_mm(const Cutter& cutter) const;
  /// The spindle does not turn about on the way.
  static bool is_one_piece(const CutMove& move) { return move.axis_from == move.axis_to; }

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace kerf
