// twin/process/turning/holder_checks.h - what holds an insert against the workpiece: bar-contact,
// holder-contact.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "stock/turning/turning_stock.h"
#include "twin/findings/finding.h"
#include "twin/process/collision_table.h"
#include "twin/process/turning/turning_checks.h"

namespace kerf {

/// Watches the holders of the tools of one program: parts of a tool none of whose edges cuts. One
/// that lies along the axis is a bar. On feeds the insert goes ahead: what it cuts away before the
/// holder comes there is no contact; so it is looked at in steps of kStep_mm. An event lasts until
/// the first traverse on which the holder touches nothing, or the next tool. How near it comes is
/// measured as far as kMeasured_mm, or twice the clearance that is wished for: on traverses to what
/// is there, on feeds to what the move leaves.
class HolderChecks {
 public:
  HolderChecks(const TurningStock& stock, FindingLog& log) : stock_(stock), log_(log) {}

  void mount(const Cutter& cutter, int tool);
  void unmount() {
    holder_.reset();
    event_.reset();
  }
  /// The tool has one.
  bool active() const { return holder_.has_value(); }
  /// Before the move is cut. `blank_guessed`: CheckOptions.
  void check(const TurnedMove& move, bool blank_guessed);
  /// The move, a feed, has been cut.
  void measure(const TurnedMove& move);
  /// near-miss: what comes nearer without touching; 0: nothing does.
  void set_clearance(double clearance_mm) { clearance_mm_ = clearance_mm; }
  void begin_reporting();
  /// The program is over: what came near without touching is told.
  void finish();
  /// A row for each tool that has a holder.
  const std::vector<CollisionPair>& table() const { return table_; }

  static constexpr double kMeasured_mm = 1;
  /// A least clearance that is less by no more is no new one.
  static constexpr double kGrain_mm = 0.005;
  static constexpr double kStep_mm = 1;
  static constexpr int kMostSteps = 64;  ///< longer ones on longer moves

 private:
  struct Holder {
    TurningTool whole;
    TurningTool thin;    ///< less what a contact may be deep
    TurningTool bare;    ///< less what rounding may be: where a contact begins
    TurningTool insert;  ///< what goes ahead of it
    bool is_bar = false;
    std::size_t row = 0;
  };
  struct Touch {
    TurnContact contact;
    double share = 0;  ///< of the motion
  };
  std::optional<Touch> touch_of_traverse(std::span<const TurnMove> turns) const;
  std::optional<Touch> touch_of_feed(std::span<const TurnMove> turns) const;
  void measure_to(const TurnedMove& move, std::span<const TurnMove> turns);
  void tell(const TurnedMove& move, const Touch& touch, bool blank_guessed);

  const TurningStock& stock_;
  FindingLog& log_;
  std::optional<Holder> holder_;
  std::optional<FindingLog::Handle> event_;
  bool touched_ = false;  ///< on the present move
  double clearance_mm_ = 0;
  std::vector<CollisionPair> table_;
  std::vector<Finding> nearest_;  ///< place of the least clearance, and its text's end, by row
};

}  // namespace kerf
