// twin/machine/motion_moves.h - motions as the stock model takes them: one move each, several where
// the machine turns the tool or the workpiece.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "interp_bridge/motion.h"
#include "stock/stock_model.h"
#include "twin/machine/kinematics/tool_path.h"
#include "twin/machine/live_paths.h"

namespace kerf {

/// Of a process whose moves depend on the motions before (a beam that pierces first, strokes): what
/// a motion of a program is cut as. Immutable; any number of threads.
class OrderedMoves {
 public:
  using MotionAt = std::function<Motion(std::size_t)>;
  virtual ~OrderedMoves() = default;
  /// Appends the moves of the way of motion `i` up to `fraction`, all with this id; none where
  /// nothing cuts. `motion_at`: the program.
  virtual void append(std::size_t i, const MotionAt& motion_at, double fraction,
                      const Cutter& cutter, std::uint64_t id, std::vector<CutMove>& out) const = 0;
};

/// Until follow() every motion is that of an upright tool over a workpiece that lies still,
/// whatever A, B, C, U, V and W do. Values; const calls from any number of threads.
class MotionMoves {
 public:
  MotionMoves() = default;

  /// From now on as this machine moves. `cell_mm`: of the model, for the tolerance
  /// (ToolPathTolerance::of_cell). True: something has changed; false: machine and frame are those
  /// of before. path() stays where it is. Error: as ToolPath::create(); then nothing has changed.
  Result<bool> follow(std::shared_ptr<const MachineKinematics> machine, const WorkpieceFrame& frame,
                      double cell_mm);

  /// Null: every motion is upright.
  const ToolPath* path() const { return path_ ? &*path_ : nullptr; }
  /// The model takes tilted tools; false: A, B and C turn nothing.
  bool tilts() const { return tilts_; }
  /// The motion is one move of an upright tool: cut_move_from().
  bool is_upright(const Motion& motion) const { return !path_ || path_->is_upright(motion); }
  /// The same, with this tool.
  bool is_upright(const Motion& motion, const Cutter& cutter) const {
    return live_path(cutter) == nullptr && is_upright(motion);
  }
  /// A lathe that mills: driven tools (Cutter::live()) go in the workpiece as LivePaths say,
  /// whatever path() is.
  bool mills() const { return live_ != nullptr; }
  /// Of such a tool; null: any other.
  const ToolPath* live_path(const Cutter& cutter) const {
    return live_ && cutter.live() ? &live_->path(*cutter.live()) : nullptr;
  }
  /// From now on the moves are these. Null: those of a tool, which cuts on every motion that moves.
  void set_ordered(std::shared_ptr<const OrderedMoves> moves) { ordered_ = std::move(moves); }
  const OrderedMoves* ordered() const { return ordered_.get(); }
  /// Appends the moves of a motion that moves the tip, all with this id. Not where the motions
  /// before count: ordered(). False, and nothing is appended: there are too many
  /// (ToolPath::moves_of()). `ends`, if given: as there, and nothing for an upright motion.
  bool append(const Motion& motion, const Cutter& cutter, std::uint64_t id,
              std::vector<CutMove>& out, std::vector<double>* ends = nullptr) const;

  /// The same, divided so that all that is within `reach_mm` of the tip is within the tolerance.
  bool append_reaching(const Motion& motion, double reach_mm, std::uint64_t id,
                       std::vector<CutMove>& out, std::vector<double>* ends = nullptr) const;

  /// Of a machine over this model: as the machine moves, while nothing turns if the model does not
  /// take tilted tools (null: every motion is upright), and its driven tools if it is a lathe's
  /// that mills. The machine can have that frame.
  static MotionMoves of(const StockModel& stock, std::shared_ptr<const MachineKinematics> machine,
                        const WorkpieceFrame& frame);

  /// From the tip to where the tolerance holds: the flutes, as far as their length is known, else
  /// four diameters.
  static double reach_mm(const Cutter& cutter);

 private:
  std::shared_ptr<const MachineKinematics> machine_;
  WorkpieceFrame frame_;
  std::optional<ToolPath> path_;
  bool tilts_ = false;
  std::shared_ptr<const OrderedMoves> ordered_;
  std::shared_ptr<const LivePaths> live_;
};

}  // namespace kerf
