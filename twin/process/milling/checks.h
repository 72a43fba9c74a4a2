// twin/process/milling/checks.h - troubles of single moves, joined to events: one finding from the
// first move that shows a trouble to the last one in a row.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "interp_bridge/motion.h"
#include "stock/stock_model.h"
#include "stock/way_contact.h"
#include "twin/findings/finding.h"
#include "twin/machine/timeline.h"
#include "twin/process/check_options.h"
#include "twin/process/checked_move.h"
#include "twin/process/contact_grounds.h"

namespace kerf {

class BlankShadow;

/// Watches the moves of one program against one workpiece. The caller calls before it cuts the
/// move; wherever a `first_contact` is asked, the model must have been finished
/// (StockModel::finish).
class Checks {
 public:
  Checks(const StockModel& stock, FindingLog& log)
      : stock_(stock), bounds_mm_(stock.bounds_mm()), log_(log) {}

  void set_options(const CheckOptions& options);
  const CheckOptions& options() const { return options_; }
  /// Whom a search for the contacts of a traverse tells how far it is; and once a stop is
  /// requested, it ends with nothing.
  void watch_by(WayWatch watch) { watch_ = std::move(watch); }

  /// False if the cutter stays clear of the blank on the whole way. Cheap: boxes only.
  bool may_touch(const Motion& motion, double radius_mm) const;
  /// The same for tilted tools.
  bool may_touch(std::span<const CutMove> moves, const Cutter& cutter) const;

  /// It meets material.
  bool touches(const CheckedMove& move) const { return first_touch(move).has_value(); }

  /// rapid-contact. An event ends with the first traverse that touches nothing. True if it touches.
  bool check_traverse(const CheckedMove& move);
  void clear_traverse() { rapid_.reset(); }

  /// spindle-off-contact. An event lasts until the spindle turns or the tool changes; after it is
  /// open the depths of its moves come from their cut reports (no need to ask the model before each
  /// of them).
  bool spindle_event_open() const { return spindle_.has_value(); }
  /// `text`: how it stands. The finding, if an event begins.
  std::optional<FindingLog::Handle> check_standing_spindle(const CheckedMove& move,
                                                           std::string_view text,
                                                           Severity severity);
  void deepen_spindle_event(double depth_mm);
  void end_spindle_event() { spindle_.reset(); }

  /// What goes on is forgotten: the next trouble is a new event.
  void forget_events() { rapid_ = spindle_ = below_ = std::nullopt; }

  /// below-stock: the tip below the floor of the blank, by more than CheckOptions allow, inside the
  /// blank's outline from above (round ones are, along Z; else its box): the tool cuts the table.
  /// An event ends with the first move that stays above. For upright tools: of a machine that turns
  /// the workpiece nobody knows what is below it.
  void check_floor(const CheckedMove& move);

 private:
  struct Below {
    Vec3 first_mm{0};
    double fraction = 0;
    double depth_mm = 0;
  };
  std::optional<Below> below_floor(const Motion& motion) const;
  struct Touch {
    Contact contact;
    double fraction = 0;  ///< of the motion
  };
  std::optional<Touch> first_touch(const CheckedMove& move) const;
  /// `text` without the doubts that there are about it.
  Finding finding_at(FindingId id, const CheckedMove& move, const Vec3& place, double fraction,
                     std::string text) const;

  const StockModel& stock_;
  Box bounds_mm_;
  FindingLog& log_;
  CheckOptions options_;
  std::shared_ptr<const BlankShadow> shadow_;  ///< of a blank from a mesh
  WayWatch watch_;
  std::optional<FindingLog::Handle> rapid_;
  std::optional<FindingLog::Handle> spindle_;
  std::optional<FindingLog::Handle> below_;
};

}  // namespace kerf
