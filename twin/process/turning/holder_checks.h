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
/// the first traverse on which the holder touches nothing, or the next tool.
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
  void begin_reporting();
  /// A row for each tool that has a holder. How near one came is not known.
  const std::vector<CollisionPair>& table() const { return table_; }

  static constexpr double kStep_mm = 1;
  static constexpr int kMostSteps = 64;  ///< longer ones on longer moves

 private:
  struct Holder {
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
  void tell(const TurnedMove& move, const Touch& touch, bool blank_guessed);

  const TurningStock& stock_;
  FindingLog& log_;
  std::optional<Holder> holder_;
  std::optional<FindingLog::Handle> event_;
  std::vector<CollisionPair> table_;
};

}  // namespace kerf
