// twin/machine/kinematics/tool_path.h - motions of a program as moves of the tool in the workpiece,
// on machines that tilt the tool or turn the workpiece.
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "base/result.h"
#include "interp_bridge/motion.h"
#include "stock/stock_model.h"
#include "twin/machine/kinematics/machine_kinematics.h"
#include "twin/machine/kinematics/tool_chain.h"
#include "twin/machine/kinematics/work_frame.h"

namespace kerf {

/// How far the moves may be from the true path.
struct ToolPathTolerance {
  double tip_mm = 0.01;  ///< of the tip, at equal times
  double top_mm = 0.01;  ///< of the spindle's line at the top of the cutting part
  /// Of a motion of many turns those are left out that are no farther than this from one that is
  /// not, tip and top, at equal angles; 0: none. Ridges between turns may stand by so much.
  double turn_mm = 0;

  /// A tenth of a cell, of tip and top at most 0.01 mm; of turns a fifth.
  static ToolPathTolerance of_cell(double cell_mm);
};

/// The tool's way in the frame of the workpiece: the frame in which the blank is given, fixed to
/// the part, and equal to the program's coordinates under its first work offset while A, B and C
/// are 0 (program coordinates). Where X Y Z follow the tip (KinematicsMode::kTip) it is the
/// program's frame at any A, B, C.
///
///     program --offsets--> machine axes --chain--> tool seen from the workpiece link
///                                                        \--> seen from the workpiece frame
///
/// Along one motion X Y Z go straight (or round an arc) and A B C turn evenly with them, as
/// LinuxCNC interpolates; what the tip does in the workpiece is curved where a table turns under X
/// Y Z, straight where they follow it. Cuts the motion into moves (straight tip, spindle turning
/// along a great circle) no longer than the tolerance asks, and no shorter: the error of every
/// piece is bounded by the second derivative of the true path (exact at its middle, widened by a
/// bound on the third), not sampled. Motions on which nothing turns stay one move, bit for bit what
/// cut_move_from() gives where the spindle is upright, else moved rigidly (arcs stay arcs).
///
/// The tool is as long as the tool length offset in force says. U, V and W move what the chain has
/// for them, or the tool along its own axes (MachineKinematics::uvw_by_xyz); the workpiece frame is
/// that of the program with U, V, W at 0. Axes that the chain does not have count as 0.
///
/// Owns all it needs; const calls from any number of threads.
class ToolPath {
 public:
  /// Error: the slides of the chain are not at right angles ("the machine's X, Y and Z are not at
  /// right angles: the program's frame has no place on it").
  static Result<ToolPath> create(MachineKinematics machine, const WorkpieceFrame& frame,
                                 const ToolPathTolerance& tolerance);

  const MachineKinematics& machine() const { return machine_; }
  const ToolPathTolerance& tolerance() const { return tolerance_; }

  /// Is the spindle upright along the whole motion, and the workpiece as it lay? No other motions
  /// need a model for tilted tools.
  bool stays_upright(const Motion& motion) const;
  /// Stays it upright, and is the motion what cut_move_from() makes of it? Not where U, V or W have
  /// taken the tool aside.
  bool is_upright(const Motion& motion) const;

  /// Appends the moves of a motion that moves the tip, in order; each begins where the one before
  /// ends, bit for bit, also from one motion to the next. `reach_mm`: from the tip to the top of
  /// what cuts. All get `id`. A motion whose start is not known makes none. About a microsecond a
  /// piece. False, and nothing is appended: it would be more than kMostPieces (wild turns far from
  /// what they turn about), which bounds memory and time.
  ///
  /// Of a motion with turns in plenty (ToolPathTolerance::turn_mm) the tool goes from the end of
  /// one that is kept straight to the beginning of the next, at the same angle. The first and the
  /// last are kept.
  ///
  /// A planned path (PathPiece) is other than the motion where nothing turns only: call with a copy
  /// of the motion that has the piece's from_mm, to_mm and arc.
  /// `ends`, if given, gets the fraction of the motion at which each move ends, 1 last: its share
  /// of the time.
  bool moves_of(const Motion& motion, double reach_mm, std::uint64_t id, std::vector<CutMove>& out,
                std::vector<double>* ends = nullptr) const;
  /// 1000 turns to 5 um at 100 mm, 3000 to 10 um.
  static constexpr std::size_t kMostPieces = 1'000'000;

  /// The tool at `fraction` in [0, 1] of the motion (of the angle, for arcs): the tip is the
  /// origin. Exact. The spindle goes along `pose.direction(machine().nose_from_tip)`.
  Pose pose_at(const Motion& motion, double fraction) const;
  Vec3 spindle_at(const Motion& motion, double fraction) const;

  /// Machine coordinates commanded there (X Y Z and U V W with the tool length offset, A B C with
  /// theirs), and where the machine stands for it: what axis limits and pictures want. No position
  /// of robots.
  AxisValues axes_at(const Motion& motion, double fraction) const;
  std::optional<MachinePosition> machine_at(const Motion& motion, double fraction) const;
  /// Where the workpiece frame lies on the chain's workpiece link, to draw the part on it.
  const Pose& link_from_workpiece() const { return link_from_workpiece_; }

  /// The program switches kinematics (MachineKinematics::type_of) while the machine stands turned:
  /// it stays where it is, and X Y Z are other numbers from there on. Sets next.from_mm to them.
  /// The interpreter knows nothing of this: SwitchedMotions sees to what follows from it.
  void take_up(const Motion& before, Motion& next) const;

 private:
  /// How one type of kinematics gets from the numbers of a motion to the tool.
  struct Track {
    ToolChain chain;         ///< its first three inputs, the slides, are ..
    glm::dmat3 slides{1.0};  ///< .. slides * (tip in the workpiece frame) + shift_mm + tool
    Vec3 shift_mm{0};
    Pose workpiece_from_chain;
    glm::dmat3 last_turn{1.0};    ///< of the tool link in the chain's last frame
    std::size_t offset_step = 0;  ///< kTip, kArm: step that shifts by what the tool is longer than
                                  ///< the controller is told
    std::array<bool, 3> turned_by{};  ///< A, B, C take part
    std::array<bool, 3> slid_by{};    ///< U, V, W do
    bool upright_at_zero = false;
  };
  /// A motion's inputs, ready to be evaluated.
  struct Run;
  struct End;

  ToolPath() = default;
  Result<Pose> place_workpiece();
  Vec3 shift_of_offset() const;
  Track track_of(const KinematicsType& type) const;
  bool is_upright_at_zero(const Track& track) const;
  const Track& track(const Motion& motion) const;
  Run run_of(const Motion& motion) const;
  static End end_of(const Run& run, double t);
  double error_of(const Run& run, double t, double h, const End& from, const End& to,
                  double reach_mm) const;
  void rigid_move(const Run& run, const Motion& motion, CutMove& move) const;
  /// Parts of a motion that are kept, in turns of its fastest axis from the start; empty: all of
  /// it.
  struct Kept {
    double turns = 0;  ///< of the whole motion
    std::vector<std::pair<double, double>> parts;
  };
  Kept kept_turns(const Run& run, double reach_mm) const;
  static CutMove move_of(const End& from, const End& to, std::uint64_t id);
  template <class Add>
  bool divide(const Run& run, double begin, double end, double reach_mm, std::uint64_t id,
              End& from, const Add& add) const;

  MachineKinematics machine_;
  WorkpieceFrame frame_;
  ToolPathTolerance tolerance_;
  Pose machine_from_workpiece_;
  Pose link_from_workpiece_;
  std::vector<Track> tracks_;  ///< of machine_.types
};

}  // namespace kerf
