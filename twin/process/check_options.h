// twin/process/check_options.h - what findings are judged by.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "base/geometry.h"
#include "interp_bridge/motion.h"
#include "stock/blank.h"
#include "stock/cutter/cutter.h"
#include "twin/collision/pair_rules.h"
#include "twin/job/fixtures.h"
#include "twin/job/work_holding.h"
#include "twin/machines/machine_bodies.h"
#include "twin/process/cutting_wish.h"

namespace kerf {

/// What is held against each other, besides the tool and the workpiece.
struct CollisionWishes {
  FixtureList fixtures;  ///< may be null: none
  WorkHolding holding;   ///< of a workpiece that turns, as it is wished
  HoldingList held_by;   ///< the same about the blank there is; may be null
  /// The machine's links; null: nobody has described them. Fixtures that stand on a link stand on
  /// one of these.
  MachineBodiesPointer machine;
  /// Else one that is built around the workpiece, once it is known where that lies; empty: none.
  std::function<MachineBodiesPointer(const WorkpieceFrame&, const Box& blank_mm)> built_in{};
  PairRules rules;
  /// The spindle's sections from its nose upward; empty: nobody described it.
  std::vector<ToolSection> spindle;
  double clearance_mm = 0.5;  ///< near-miss: what comes nearer without touching; 0: nothing does
  bool cut_by_shank = false;  ///< the workpiece, by what of a shank touches it
};

/// What findings are judged by.
struct CheckOptions {
  bool blank_guessed = false;
  /// How far below the floor of the blank the tip may go: into a spoilboard. mm.
  double below_mm = 0;
  /// The blank is a skin that was guessed over the only level that is fed, and the program never
  /// starts a spindle: a pen, a knife. What stands in that skin is no fault.
  bool is_drawn = false;
  CollisionWishes collisions{};
  double spindle_max_rpm = 0;  ///< of a spindle that turns the workpiece; 0: not known
  /// Without bodies or a mesh nobody knows more of it than the stock's box.
  Blank blank{};
  CuttingWish cutting{};
};

/// Where the blank of a run comes from, and so what it means that nothing of it is cut.
enum class BlankKind : std::uint8_t {
  kUnjudged,  ///< a part of a program, a machine that is watched: nothing is said
  kGiven,     ///< by the user or by the program
  kGuessed,   ///< from the moves
  kSaved,     ///< a workpiece that has been cut before: a second pass may find nothing
};

}  // namespace kerf
