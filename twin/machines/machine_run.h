// twin/machines/machine_run.h - a machine on one motion: where its axes stand, how fast and how
// sharply they go at most, and the way of any of its links as another one sees it.
#pragma once

#include <array>
#include <vector>

#include "base/result.h"
#include "interp_bridge/motion.h"
#include "twin/collision/sweep.h"
#include "twin/machine/kinematics/machine_kinematics.h"
#include "twin/machine/kinematics/tool_chain.h"
#include "twin/machine/kinematics/tool_path.h"

namespace kerf {

/// The lowest and the highest value of each axis.
struct AxisSpan {
  AxisValues low{};
  AxisValues high{};
};

class MachineRun;

/// Motions of a program as a machine makes them. LinuxCNC goes straight in X Y Z A B C U V W of the
/// program; where the kinematics follow the tip, the slides go another way, and that is the one
/// here. Values; const calls from any number of threads.
class MachineRuns {
 public:
  /// Error: as ToolPath::create().
  static Result<MachineRuns> create(MachineKinematics machine, const WorkpieceFrame& frame);

  const ToolPath& path() const { return path_; }
  /// Where the machine stands is known: no robot, and of kinematics that follow the tip X, Y and Z
  /// slide one after the other, nothing turning between them.
  bool knows(const Motion& motion) const;
  /// The machine on a motion that it knows, whose start is known; `motion` outlives it. `tool_mm`:
  /// of a tool for which no offset is in force (G43), so long is what hangs below the nose.
  void follow(const Motion& motion, double tool_mm, MachineRun& run) const;
  /// From the nose to the tip, in the frame of the tool's link.
  Vec3 tip_from_nose(const Motion& motion, double tool_mm) const;

 private:
  friend class MachineRun;
  explicit MachineRuns(ToolPath path) : path_(std::move(path)) {}
  void take_apart();
  const MachineKinematics& machine() const { return path_.machine(); }

  ToolPath path_;
  WorkpieceFrame frame_;
  Pose machine_from_workpiece_;
  // Kinematics that follow the tip. Where the slides stand, times `slides`, is where the first of
  // these chains has the point that is commanded less where the second has it:
  bool slides_are_together_ = false;
  ToolChain to_slides_;  ///< from the slides over the workpiece to the point: X Y Z are its inputs
  ToolChain from_slides_;  ///< from the slides to the nose
  glm::dmat3 axes_from_slides_{1.0};
};

/// One motion. To be used again: follow() allocates nothing.
class MachineRun {
 public:
  /// Machine axes: what the links of its chain go by.
  AxisValues axes_at(double t) const;
  /// Of axes_at() over all t.
  const InputBounds& bounds() const { return bounds_; }
  const AxisSpan& span() const { return span_; }

 private:
  friend class MachineRuns;
  AxisValues program_at(double t) const;
  Vec3 slides_at(const AxisValues& program) const;
  void bound_program();
  void bound_axes();
  void bound_slides();

  const MachineRuns* runs_ = nullptr;
  const Motion* motion_ = nullptr;
  const KinematicsType* type_ = nullptr;
  Vec3 offset_mm_{0};         ///< of the tool, as machine coordinates have it
  Vec3 told_tool_mm_{0};      ///< from the tip to the nose, as the kinematics take it
  AxisValues from_{}, to_{};  ///< of the program, A to W with offsets
  InputBounds program_;
  InputBounds bounds_;
  AxisSpan span_;
};

/// A body that hangs on one link, as seen from the frame of what hangs on another one.
class LinkWay final : public RigidWay {
 public:
  /// `run` and `chain` (from the link of what counts as still to that of the moving body) outlive
  /// it.
  LinkWay(const MachineRun& run, const ToolChain& chain, const Pose& still_from_its_link,
          const Pose& link_from_body)
      : run_(run),
        chain_(chain),
        still_from_(still_from_its_link),
        link_from_body_(link_from_body) {}
  Pose pose(double t) const override;
  double slack_mm(double from, double to, double reach_mm) const override;
  double turning_mm(double from, double to, double reach_mm) const override;
  double travel_mm(double from, double to, double reach_mm) const override;

 private:
  PathBounds bounds(double from, double to, double reach_mm) const;

  const MachineRun& run_;
  const ToolChain& chain_;
  Pose still_from_, link_from_body_;
};

/// No point within `reach_mm` of `end_mm` (last frame of the chain) moves farther, seen from the
/// chain's first frame, while the axes go from `from` to anywhere within the span.
double most_way_mm(const ToolChain& chain, const AxisValues& from, const AxisSpan& span,
                   const Vec3& end_mm, double reach_mm);

}  // namespace kerf
