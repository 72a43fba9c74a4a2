// twin/process/turning/holding_checks.h - the tool against what holds a workpiece that turns:
// chuck-contact, jaw-contact, fixture-contact of a tailstock, near-miss.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "stock/turning/turned_part.h"
#include "twin/collision/pair_rules.h"
#include "twin/findings/finding.h"
#include "twin/job/work_holding.h"
#include "twin/process/near_pair.h"
#include "twin/process/turning/turning_checks.h"

namespace kerf {

/// Holds a tool's insert (or drill) and its holder against chuck, jaws and tailstock on all moves
/// of one program, and keeps how near they came. These turn, or are rings as if they did: it makes
/// no difference whether the spindle stands. Exact, along the whole of each move. One event of a
/// pair lasts until the first traverse on which they do not touch, or the next tool.
class HoldingChecks {
 public:
  explicit HoldingChecks(FindingLog& log) : log_(log) {}

  /// There is something that holds it: CollisionWishes::held_by.
  void set_wishes(const CollisionWishes& wishes);
  bool active() const { return !bodies_.empty(); }
  void mount(const Cutter& cutter, int tool, bool guessed);
  void unmount() { mounted_.clear(); }
  bool is_mounted() const { return !mounted_.empty(); }
  void check(const TurnedMove& move);
  /// What has been found is forgotten, and how near anything came.
  void begin_reporting();
  /// The program is over: what came near without touching is told.
  void finish();
  /// Rows of all tools so far, in the order of their first use.
  std::vector<CollisionPair> table() const;

 private:
  struct Pair : NearPair {
    std::size_t body = 0;
  };
  /// A part of the tool that is in use.
  struct Mounted {
    ToolPart part = ToolPart::kCutter;
    TurningTool whole;
    TurningTool thin;  ///< less what a contact may be deep
    TurningTool bare;  ///< less what rounding may be: where a contact begins
    Vec2 low_mm{0}, high_mm{0};
    std::vector<std::size_t> pairs{};  ///< by body
  };
  std::size_t pair_of(int tool, ToolPart part, std::size_t body);
  void check_pair(const Mounted& part, Pair& pair, const TurnedMove& move,
                  std::span<const TurnMove> turns, double apart_mm);
  void meet(const Mounted& part, Pair& pair, const TurnedMove& move,
            std::span<const TurnMove> turns);

  FindingLog& log_;
  CollisionWishes wishes_;
  std::vector<HoldingBody> bodies_;
  std::vector<Mounted> mounted_;
  std::vector<Pair> pairs_;
  int tool_ = 0;
  bool guessed_ = false;
};

}  // namespace kerf
