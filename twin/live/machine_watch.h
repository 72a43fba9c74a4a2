// twin/live/machine_watch.h - findings about what a watched machine is and tells: beyond its
// limits, a tool of no length, axes, a beam or a trigger that nobody sees.
#pragma once

#include <array>
#include <optional>

#include "machine_io/position_source.h"
#include "stock/stock_model.h"
#include "twin/findings/finding.h"
#include "twin/live/live_cut_options.h"
#include "twin/live/reading.h"
#include "twin/live/seen_strokes.h"
#include "twin/machine/kinematics/tool_path.h"

namespace kerf {

/// Takes readings in their order and adds to the log what follows from them alone, each once. One
/// thread.
class MachineWatch {
 public:
  /// The references must outlive it.
  MachineWatch(const StockModel& stock, const LiveCutOptions& options, FindingLog& log);

  /// Nothing tells the length of the tool; once a tool. With no tool in the spindle, or none that
  /// is known of, nothing is taken for granted.
  void note_length(int tool, double t_s);
  /// Positions of another machine, or in another unit. One that is not homed may be anywhere for a
  /// while; while it says that it runs no program (`line` 0), for as long as it likes.
  void note_limits(const Vec3& machine_mm, int line, double t_s);
  /// A, B or C stand elsewhere than where they were first seen, and the model knows upright tools
  /// over a workpiece that lies still. `line`: of the program, where the machine was last.
  void note_turn(const Reading& now, SourceRef line);
  /// An axis that the machine turns, and whose positions do not come. `path` null: it turns none.
  void note_unseen_axes(const Reading& now, const ToolPath* path);
  /// Without a program: a sheet is cut by whoever knows when the beam is on; and punched.
  void note_unseen_beam(const Reading& now);
  void note_unseen_trigger(const Reading& now, const SeenStrokes& strokes);

 private:
  const StockModel& stock_;
  const LiveCutOptions& options_;
  FindingLog& log_;
  std::optional<double> beyond_since_s_;  ///< the positions lie beyond the machine's limits
  bool beyond_told_ = false;
  std::optional<std::array<double, 3>> first_abc_deg_;
  bool turn_told_ = false;
  bool unseen_told_ = false;
  bool beam_told_ = false;  ///< or that of the trigger
  int length_told_ = 0;     ///< tool whose length is not known
};

}  // namespace kerf
