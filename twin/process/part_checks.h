// twin/process/part_checks.h - shank, holder and spindle against the workpiece:
// holder-contact, shank-contact, flute-too-short, spindle-contact, near-miss.
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "interp_bridge/motion_kinds.h"
#include "stock/stock_model.h"
#include "twin/findings/finding.h"
#include "twin/process/checked_move.h"
#include "twin/process/collision_table.h"

namespace kerf {

/// Watches what a tool carries above its cutting edges along one program, and keeps how near it
/// came. For models that look (StockModel::checks_parts()). One event of an id lasts until the
/// first traverse on which no part of that id touches anything, or the next tool.
class PartChecks {
 public:
  PartChecks(const StockModel& stock, FindingLog& log) : stock_(stock.bare()), log_(log) {}

  void set_blank_guessed(bool guessed) { blank_guessed_ = guessed; }
  /// near-miss: what comes nearer without touching; 0: nothing does. Clearances are measured below
  /// twice that, or 1 mm if that is more.
  void set_clearance(double clearance_mm);
  /// What is known of the tool that goes into the spindle. Nothing is looked for of a
  /// shank where nobody gave the length of the flutes, nor of a holder that nobody described.
  /// `spindle`: its sections from the nose upward; the nose is `nose_mm` above the tip, or where
  /// the holder ends, if that is higher; neither: the spindle is not looked at.
  void mount(const Cutter& cutter, int tool, std::span<const ToolSection> spindle, double nose_mm);
  void unmount() { parts_.clear(); }
  /// What is known of clearances, too, is forgotten.
  void begin_reporting();
  /// Of the tool in the spindle.
  bool checks_shank() const {
    return has(FindingId::kShankContact) || has(FindingId::kFluteTooShort);
  }
  bool checks_holder() const { return has(FindingId::kHolderContact); }
  /// From the tip to the highest place of it that can come near the workpiece; 0: nothing.
  double reach_mm() const;
  /// False: none of it comes near enough to matter on these moves, the next of the program. Cheap:
  /// how far away it was at least is remembered. Moves that the model holds back may be among what
  /// has been cut.
  bool may_matter(std::span<const CutMove> moves);
  /// Before the moves are cut, and if they may matter: all before them is in the model.
  void check(const CheckedMove& move);
  /// The motion does not matter.
  void pass(const Motion& motion) {
    if (is_traverse(motion)) forget();
  }
  /// A row for each tool's shank and holder that were looked at.
  const std::vector<CollisionPair>& table() const { return table_; }
  /// The program is over: what came near without touching is told.
  void finish();
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
    std::size_t row;          ///< of table_ and nearest_
    bool measured = false;    ///< its clearance counts
    bool above_neck = false;  ///< a shank that does not begin where the flutes end
    double depth_mm = 0;      ///< of the event
    std::optional<FindingLog::Handle> event{};
    double spare_mm = -1;  ///< no nearer than this at the end of the last move; < 0: not known
    bool matters = false;  ///< on the present motion
  };
  void add(Part part);
  std::size_t row_of(FindingId id);
  Part* open_event(FindingId id);
  /// How deep it is known to be on feeds; a traverse is looked at by itself.
  double known_mm(const Part& part, const Motion& motion) const;
  double most_mm() const;
  double counts_mm(const Part& part) const;
  bool comes_near(Part& part, const CutMove& move) const;
  void meet(std::size_t index, const CheckedMove& move, const PartContact& contact,
            double fraction);
  void measure(const Part& part, const CheckedMove& move, std::size_t which);

  const StockModel& stock_;
  FindingLog& log_;
  bool blank_guessed_ = false;
  double clearance_mm_ = 0;
  std::vector<Part> parts_;
  std::optional<CutMove> last_;  ///< where it ended is where Part::spare_mm counts from
  std::vector<CollisionPair> table_;
  std::vector<Finding> nearest_;  ///< text and place of the least clearance, by row
  int tool_ = 0;
};

}  // namespace kerf
