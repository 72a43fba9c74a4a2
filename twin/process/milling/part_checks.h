// twin/process/milling/part_checks.h - shank, holder and spindle against the workpiece:
// holder-contact, shank-contact, flute-too-short, spindle-contact.
#pragma once

#include <algorithm>
#include <optional>
#include <span>
#include <vector>

#include "interp_bridge/motion_kinds.h"
#include "stock/stock_model.h"
#include "twin/findings/finding.h"
#include "twin/process/collision_table.h"
#include "twin/process/milling/checks.h"

namespace kerf {

/// Watches what a tool carries above its cutting edges along one program. For upright tools, and
/// for models that look (StockModel::checks_parts()). One event of an id lasts until the first
/// traverse on which no part of that id touches anything, or the next tool.
class PartChecks {
 public:
  PartChecks(const StockModel& stock, FindingLog& log) : stock_(stock.bare()), log_(log) {}

  void set_blank_guessed(bool guessed) { blank_guessed_ = guessed; }
  /// What is known of the tool that goes into the spindle. Nothing is looked for of a
  /// shank where nobody gave the length of the flutes, nor of a holder that nobody described.
  /// `spindle`: its sections from the nose upward; the nose is `nose_mm` above the tip, or where
  /// the holder ends, if that is higher; neither: the spindle is not looked at.
  void mount(const Cutter& cutter, int tool, std::span<const ToolSection> spindle, double nose_mm);
  void unmount() { parts_.clear(); }
  /// Of the tool in the spindle.
  bool checks_shank() const {
    return has(FindingId::kShankContact) || has(FindingId::kFluteTooShort);
  }
  bool checks_holder() const { return has(FindingId::kHolderContact); }
  /// False: all of it stays above the workpiece, as far as boxes tell. Moves that the model holds
  /// back may be among what has been cut.
  bool may_touch(const Motion& motion) const;
  /// Before the move is cut, and if it may touch: all before it is in the model.
  void check(const CheckedMove& move);
  /// The motion may not touch.
  void pass(const Motion& motion) {
    if (is_traverse(motion)) forget();
  }
  /// A row for each tool's shank and holder that were looked at.
  const std::vector<CollisionPair>& table() const { return table_; }
  /// What goes on is forgotten: the next trouble is a new event.
  void forget() {
    for (Part& part : parts_) part.event.reset();
  }

  bool has(FindingId id) const {
    return std::ranges::any_of(parts_, [&](const Part& part) { return part.id == id; });
  }

 private:
  struct Part {
    CarriedPart body;
    FindingId id;
    double width_mm;  ///< of it
    /// What would have to be longer, so that it clears: flutes, neck, or the stick-out.
    double length_mm;
    double depth_mm = 0;  ///< of the event
    std::optional<FindingLog::Handle> event;
    bool above_neck = false;  ///< a shank that does not begin where the flutes end
  };
  void meet(std::size_t index, const CheckedMove& move, const PartContact& contact,
            double fraction);
  CollisionPair& row_of(FindingId id);
  Part* open_event(FindingId id);
  /// So deep an event is known to go already: on a feed only what is deeper is new.
  double known_mm(const Part& part, const Motion& motion) const;

  const StockModel& stock_;
  FindingLog& log_;
  bool blank_guessed_ = false;
  std::vector<Part> parts_;
  std::vector<CollisionPair> table_;
  int tool_ = 0;
};

}  // namespace kerf
