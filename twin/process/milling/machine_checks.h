// twin/process/milling/machine_checks.h - what a machine carries against what else it carries:
// machine-collision, and fixtures that stand on its links.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "stock/stock_model.h"
#include "twin/findings/finding.h"
#include "twin/machine/kinematics/work_frame.h"
#include "twin/machine/timeline.h"
#include "twin/machines/machine_run.h"
#include "twin/process/check_options.h"
#include "twin/process/milling/machine_pairs.h"
#include "twin/process/milling/workpiece_surface.h"

namespace kerf {

/// Holds links, fixtures, the workpiece as it is, and what the spindle carries against each other,
/// as far as they can move against each other, on all motions of one program: on the way that the
/// machine runs, which is curved where its kinematics follow the tip. One event of a pair lasts
/// until the first traverse on which they do not touch, or the next tool.
///
///     motion --MachineRuns--> axes over time --chain--> one link as the other one sees it
///                                                   \--> LinkWay --tree against tree--> t, depth
///
/// What lies far apart costs next to nothing: of each pair it is known how near it was when it was
/// last looked at and where the axes stood then, and a bound on how far it may have come since.
///
/// Not looked at: robots; links of which the tool is not carried where the kinematics have it; a
/// tool of which nobody says how long it is. Each is told once. The workpiece is what it is before
/// the motion.
class MachineChecks {
 public:
  /// `complete` makes the model take in all moves that it has been given.
  MachineChecks(const StockModel& stock, FindingLog& log, std::function<void()> complete);

  /// Before the first motion.
  void set_options(const CheckOptions& options);
  bool active() const { return wishes_.machine || wishes_.built_in; }
  /// Null: nobody has said how the machine moves; then its axes go as the program says.
  void set_place(std::shared_ptr<const MachineKinematics> kinematics, const WorkpieceFrame& frame);
  void mount(const Cutter& cutter, int tool, bool guessed, double nose_mm);
  /// Nothing is known of what is in the spindle now, but that it is this tool.
  void unmount();
  /// Any motion, in program order, before it is cut.
  void check(const Motion& motion, const TimedStep& step);
  /// What goes on is forgotten: the next trouble is a new event, and counts begin anew.
  void forget();
  /// The program is over: what came near without touching is told.
  void finish();
  std::vector<CollisionPair> table() const;

 private:
  bool prepare(const Motion& motion);
  bool knows_length(const Motion& motion);
  bool carries_the_tool(const Motion& motion);
  void give_up(const std::string& why);
  void check_beside_blank();
  bool is_far() const;
  void renew_far();
  void look(WorkingPair& pair);
  void stand(WorkingPair& pair, const LinkWay& way);
  bool is_apart(WorkingPair& pair, double counts_mm) const;
  void look_near(WorkingPair& pair, const LinkWay& way);
  void look_at_workpiece(WorkingPair& pair, const LinkWay& way);
  double gap(const WorkingPair& pair, const Pose& pose, double cutoff_mm);
  std::optional<double> touch(const WorkingPair& pair, const LinkWay& way, double thinner_mm);
  void note_least(WorkingPair& pair, const LeastGap& gap);
  void meet(WorkingPair& pair, const LinkWay& way, double t);
  void deepen(WorkingPair& pair, const LinkWay& way);
  void end_events();
  Finding finding_of(const WorkingPair& pair, double t) const;
  LinkWay way_of(const WorkingPair& pair) const;

  FindingLog& log_;
  WorkpieceSurface surface_;
  CollisionWishes wishes_;
  bool blank_guessed_ = false;
  MachinePairs pairs_;
  std::shared_ptr<const MachineKinematics> kinematics_;
  bool moves_are_known_ = false;  ///< kinematics_ is somebody's word
  WorkpieceFrame frame_;
  bool placed_ = false;
  std::optional<MachineRuns> runs_;
  ToolChain tool_chain_;  ///< from the workpiece's link to the tool's
  Pose program_from_link_;
  bool given_up_ = false;
  Blank blank_;                  ///< what is known of it
  bool beside_told_ = false;     ///< what stands in it has been told
  std::vector<int> told_tools_;  ///< of which it is not known how long they are

  MachineRun run_;
  Motion stands_;  ///< in the place of a motion of which only the end is known
  const Motion* motion_ = nullptr;
  const TimedStep* step_ = nullptr;
  AxisValues end_{};
  std::uint64_t number_ = 0;  ///< of the motion
  std::size_t open_events_ = 0;
  /// While the axes are so near to `far_at_` (by weights, in mm), none but `close_` may touch.
  AxisValues far_at_{}, far_weight_{};
  double far_mm_ = -1;
  std::vector<WorkingPair*> close_;
};

}  // namespace kerf
