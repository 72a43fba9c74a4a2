// twin/process/turning/turning_checks.h - troubles of single moves of a turning tool, joined to
// events: one finding from the first move that shows a trouble to the last one in a row.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "interp_bridge/motion.h"
#include "stock/stock_model.h"
#include "stock/turning/turning_stock.h"
#include "twin/findings/finding.h"
#include "twin/machine/timeline.h"
#include "twin/process/check_options.h"

namespace kerf {

/// A motion with what the checks need to know of it.
struct TurnedMove {
  const Motion& motion;
  const TimedStep& step;
  const Cutter& cutter;
  const Cutter& edges;             ///< the same without what holds the insert
  std::span<const CutMove> moves;  ///< it is cut as these
  int tool = 0;
  bool tool_guessed = false;
  std::span<const double> ends{};  ///< share of the motion at each move's end; empty: evenly

  /// Of the motion, `t` of that move being done.
  double share_of(std::size_t which, double t) const {
    if (ends.empty()) return (static_cast<double>(which) + t) / static_cast<double>(moves.size());
    const double from = which == 0 ? 0 : ends[which - 1];
    return from + t * (ends[which] - from);
  }
};

/// Its moves in the plane of the axis; a thread's, too, go all round.
std::vector<TurnMove> rings_of(const TurnedMove& move);

/// Watches the moves of one program against one workpiece that turns. The caller calls before it
/// cuts the move, except where it says otherwise.
class TurningChecks {
 public:
  /// The model is a TurningStock, or stands before one.
  TurningChecks(const StockModel& stock, FindingLog& log)
      : model_(stock), stock_(*stock.turned()), log_(log) {}

  void set_options(const CheckOptions& options) { options_ = options; }
  const CheckOptions& options() const { return options_; }

  /// Cheap: boxes only.
  bool may_touch(const TurnedMove& move) const;
  /// A move of the tool touches the workpiece.
  bool touches(const TurnedMove& move) const { return first_touch(move).has_value(); }

  /// rapid-contact. An event ends with the first traverse that touches nothing.
  /// `behind_feed`: it begins where a feed has ended. A sliver that it takes from the shoulder
  /// there (kSliver_mm) is a warning.
  void check_traverse(const TurnedMove& move, bool behind_feed);
  void clear_traverse() { rapid_.reset(); }
  /// Of every motion, ahead of its checks. What traverses of one block touch is one event.
  void note_block(const SourceRef& source);
  /// spindle-off-contact. An event lasts until the spindle turns or the tool changes.
  void check_standing(const TurnedMove& move);
  void end_standing() { standing_.reset(); }
  /// flank-contact, of a feed move that has been cut. An event ends with the first one that cuts
  /// with its edges alone.
  void check_sides(const TurnedMove& move, const TurnCut& cut);
  /// past-centre, of a feed move that has been cut. Once a tool change.
  void check_centre(const TurnedMove& move, const TurnCut& cut);
  /// wrong-plane: once.
  void check_plane(const Motion& motion, const TimedStep& step);
  void end_tool();
  /// The program is over: pip-left.
  void finish();
  /// What goes on is forgotten: the next trouble is a new event.
  void forget();

  /// What a flank may be in material beside the edge that leads: corners are rounded, tables give
  /// angles in whole degrees.
  static constexpr double kFlank_mm = 0.05;
  static constexpr double kSliver_mm = 0.5;
  /// A tool may go so much farther beyond the axis than its nose has to.
  static constexpr double kBeyond_mm = 0.5;
  /// A pip is what stands so much above its face, and is no thicker than that.
  static constexpr double kPipHeight_mm = 0.02, kPipWidest_mm = 4;

 private:
  struct Touch {
    double depth_mm = 0;
    double share = 0;       ///< of the motion
    bool by_edges = false;  ///< alone, of a tool that stands still
  };
  /// Where a face was turned towards the axis.
  struct Face {
    double z_mm = 0;
    SourceRef source;
    double time_s = 0;
    int tool = 0;
  };
  std::optional<Touch> first_touch(const TurnedMove& move) const;
  std::optional<Touch> first_milled_touch(const TurnedMove& move) const;
  Finding finding_of(FindingId id, const TurnedMove& move, double share, std::string text) const;
  void note_face(const TurnedMove& move);
  void tell_pip(const Face& face);

  const StockModel& model_;
  const TurningStock& stock_;
  FindingLog& log_;
  CheckOptions options_;
  std::optional<FindingLog::Handle> rapid_, standing_, flank_;
  /// What traverses of one block touch, as those of all passes of G76; and where they only drag.
  std::array<std::optional<FindingLog::Handle>, 2> of_block_;
  SourceRef block_;
  bool centre_told_ = false;
  bool plane_told_ = false;
  std::vector<Face> faces_;  ///< the last of each place, few
};

}  // namespace kerf
