// twin/live/look_ahead_guard.h - what the next seconds of the program would do to the workpiece as
// it is.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "stock/stock_model.h"
#include "twin/beam_settings.h"
#include "twin/cut_stage.h"
#include "twin/finding.h"
#include "twin/live/program_ahead.h"
#include "twin/tools.h"
#include "twin/turret.h"

namespace kerf {

/// A finding that has not happened yet.
struct AheadWarning {
  Finding finding;  ///< its time_s is that of the program
  double in_s = 0;  ///< from now, by the plan; 0 if it is overdue
};

/// Runs the program ahead of the machine, on a copy of the workpiece that the machine has really
/// left, with the tool that it really has in the spindle. While the machine keeps to the program
/// the copy only needs what comes next; when it has done something else, the owner calls restart().
class LookAheadGuard {
 public:
  /// `horizon_s`: how far it looks. `beam`, `turret`: of a sheet, as LiveCutOptions has them.
  LookAheadGuard(ToolSources tools, TimelineOptions timeline, double horizon_s,
                 std::optional<BeamSettings> beam = {}, TurretPointer turret = {});
  ~LookAheadGuard();

  /// As CutStage::check_by(). Before the first restart().
  void check_by(const CheckOptions& options) { checks_ = options; }

  /// Begins anew from the workpiece as it is. `stage`: what has cut it.
  void restart(const StockModel& stock, const CutStage& stage, const WorkpieceFrame& frame);
  /// Of a torch program, all that the motions name so far.
  void set_materials(std::span<const TorchMaterial> materials);
  bool started() const { return stage_ != nullptr; }

  /// Brings the copy to `now_s` + horizon of program time, and appends what it would bring;
  /// nothing twice, restarts included. `real_tool`: in the machine's spindle now, where the program
  /// has `program_tool`; -1: not known.
  void look(const ProgramAhead& program, double now_s, int program_tool, int real_tool,
            std::vector<AheadWarning>& out);

  double horizon_s() const { return horizon_s_; }

 private:
  void collect(double now_s, std::vector<AheadWarning>& out);

  ToolSources tools_;
  TimelineOptions timeline_;
  double horizon_s_;
  std::optional<BeamSettings> beam_;
  TurretPointer turret_;
  CheckOptions checks_;
  std::unique_ptr<StockModel> stock_;
  std::unique_ptr<ToolBook> book_;
  std::unique_ptr<FindingLog> log_;
  std::unique_ptr<CutStage> stage_;
  std::uint64_t next_ = 0;  ///< number of the program's motion that comes next
  double base_s_ = 0;       ///< program time at which the stage's clock began
  bool begun_ = false;
  bool finished_ = false;
  std::size_t collected_ = 0;
  std::map<std::pair<int, std::uint64_t>, double> told_;  ///< finding id, file and line: when
};

}  // namespace kerf
