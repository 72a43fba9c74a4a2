// twin/live/way_cutter.h - what a watched machine removes between two samples: along the path of
// its program, or by the chord.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "stock/stock_model.h"
#include "twin/findings/finding.h"
#include "twin/job/tools.h"
#include "twin/live/driven_run.h"
#include "twin/live/live_cut_options.h"
#include "twin/live/path_follower.h"
#include "twin/live/program_ahead.h"
#include "twin/live/reading.h"
#include "twin/live/spindle_memory.h"
#include "twin/process/cut_stage.h"
#include "twin/process/engagement_log.h"
#include "twin/report/live_facts.h"

namespace kerf {

/// The way lies over the blank, within boxes; of a tool so wide. With a beam: however high it is,
/// since a torch is above what it cuts.
bool is_near_blank(const StockModel& stock, bool has_beam, const Vec3& from_mm, const Vec3& to_mm,
                   double radius_mm);

/// What else is needed to cut a way.
struct WayState {
  SpindleNow spindle;
  int kinematics_type = 0;  ///< PathMatcher's
  int program_tool = -1;    ///< PathMatcher's
};

/// The cutter's place, and the stage that cuts from there to the next one. In a model that takes
/// tilted tools ways are cut together (DrivenRun), in others at once; when depends on the samples
/// alone. One thread.
class WayCutter {
 public:
  /// The references must outlive it. `facts` gets the ways that are cut.
  WayCutter(StockModel& stock, const ToolSources& tools, FindingLog& log,
            const LiveCutOptions& options, LiveFacts& facts);

  CutStage& stage() { return stage_; }
  const CutStage& stage() const { return stage_; }
  /// Whose materials the torch is to have; may be null.
  void set_program(ProgramAhead* program) { program_ = program; }
  /// Of a torch: all that its program names so far, for the stage as well.
  std::span<const TorchMaterial> update_materials();

  /// Where the cutter has come to.
  const ProgramPose& place() const { return place_; }
  void stand_at(const ProgramPose& place) { place_ = place; }
  /// The tip of the tool that stands there is elsewhere: its length is another one.
  void move_tip(const Vec3& by_mm) { place_.tip_mm += by_mm; }
  /// Where the tool is, with all that has turned. `type`: of the kinematics in force.
  Pose pose_in_workpiece(const Reading& at, int type) const;

  /// The straight way from place() to `to` (ToolState says what is straight). Nothing: it has no
  /// length, or lies beside the blank.
  std::optional<Motion> chord_to(const Reading& to, double duration_s, const WayState& state);
  /// The machine came along the path from `before` to `now`: what was driven is cut, with the tool
  /// and the spindle that it really has, and with what the program has not turned where it really
  /// is. A beam is switched within the way, at places that only the program knows. `driven` is
  /// changed.
  void cut_path(std::span<PathFollower::DrivenPart> driven, const Reading& before,
                const Reading& now, const PathMatch& point, double duration_s,
                const SpindleNow& spindle);
  /// A way that ends at `t_s`: together with those before and behind it, where a move costs much
  /// however short it is.
  void cut(const Motion& motion, DrivenRun::Way way, double duration_s, double t_s);
  /// By itself; it begins at `t_s`.
  void cut_now(const Motion& motion, double duration_s, double t_s);
  /// Ways that wait are cut: all; or if they have waited for DrivenRun::kLongest_s.
  void cut_run();
  void cut_long_run(double t_s) {
    if (run_.is_long(t_s)) cut_run();
  }

 private:
  void place_idle_axes(const Reading& now, const PathMatch& point, Motion& motion) const;

  StockModel& stock_;
  const bool is_beam_;
  LiveFacts& facts_;
  ToolResolver resolver_;
  EngagementLog engagement_{false};  ///< where the material is known
  CutStage stage_;
  DrivenRun run_;  ///< not yet cut
  ProgramAhead* program_ = nullptr;
  std::vector<TorchMaterial> materials_;
  ProgramPose place_;
};

}  // namespace kerf
