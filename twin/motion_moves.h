// twin/motion_moves.h - motions as the stock model takes them: one move each, several where the
// machine turns the tool or the workpiece.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "interp_bridge/motion.h"
#include "stock/stock_model.h"
#include "twin/kinematics/tool_path.h"
#include "twin/punch_moves.h"
#include "twin/torch_moves.h"

namespace kerf {

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
  /// From now on the moves are those of a torch.
  void burn(TorchMoves torch) { torch_ = std::move(torch); }
  /// Null: a tool, which cuts on every motion that moves.
  const TorchMoves* torch() const { return torch_ ? &*torch_ : nullptr; }
  /// From now on they are the strokes of a punch.
  void punch(PunchMoves punch) { punch_ = std::move(punch); }
  /// Null: none.
  const PunchMoves* punch() const { return punch_ ? &*punch_ : nullptr; }
  /// Appends the moves of a motion that moves the tip, all with this id. Not of a torch or a punch:
  /// whether that pierces or strikes the motions before tell (TorchMoves, PunchMoves). False, and
  /// nothing is appended: there are too many (ToolPath::moves_of()).
  bool append(const Motion& motion, const Cutter& cutter, std::uint64_t id,
              std::vector<CutMove>& out) const;

  /// Of a machine over this model: as the machine moves, while nothing turns if the model does not
  /// take tilted tools (null: every motion is upright). The machine can have that frame.
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
  std::optional<TorchMoves> torch_;
  std::optional<PunchMoves> punch_;
};

}  // namespace kerf
