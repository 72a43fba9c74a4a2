// twin/cli/kerf_machine/machine_player.h - where the simulated machine is at each moment of its
// program.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "machine_io/simulator/state_board.h"
#include "twin/cli/kerf_machine/step_feed.h"

namespace kerf {

/// Which coordinates a machine tells.
enum class ServedFrame : std::uint8_t {
  kMachine,    ///< R(rotation) * (tip + g92) + g5x + tool offset; A B C + their offsets
  kWorkpiece,  ///< the tip, as the program writes it
};

/// How fast the machine goes back to where it began when a program is repeated: up to the higher of
/// the two ends, across, and down. mm/s (degrees/s).
inline constexpr double kReturnSpeed = 50;

/// Plays the steps of a feed. Times and path are those of the planner: where it rounds a corner,
/// the positions do so too. The planner tells when a step begins and ends, not how the speed
/// changes within: each step is run at constant speed along its path (A B C: at constant speed).
/// Between steps the machine waits.
///
/// The line is that of the step that is running, 0 while nothing moves. A tool change shows the new
/// number when it is over. Where the program does not say where the machine stands (no INI, or no
/// parameter file in it), it begins at the end of its first move. M0, M1 and M60 do not wait.
class MachinePlayer {
 public:
  /// `feed` must outlive the player.
  MachinePlayer(StepFeed& feed, ServedFrame frame);

  /// Waits for the first steps, and stands where they begin. Not a step: time 0.
  void prepare(const std::stop_token& stop);

  /// Moves on by so much program time; never waits: where the interpreter is behind, the machine
  /// stands and its time with it. False: the program is over, and the machine stands at its end.
  bool advance(double seconds);

  /// Scan counter left at 0.
  const SimulatedState& state() const { return state_; }
  double program_s() const { return time_s_; }

 private:
  using Pose = std::array<double, kSimulatedAxes>;
  /// A straight move that no program line commands.
  struct Leg {
    Pose to{};
    double end_s = 0;
  };

  StepFeed::Next load();
  void begin_pass();
  void plan_return(const Pose& to);
  void stand_between();
  void begin_step();
  void move_to(double fraction);
  void end_step();
  Pose served(const Vec3& tip_mm, const Vec3& tool_offset_mm,
              const std::array<double, 3>& abc_deg) const;
  Pose first_pose(bool& found) const;
  const MachineStep& step() const { return batch_.steps[next_]; }

  StepFeed& feed_;
  ServedFrame frame_;
  StepBatch batch_;
  std::size_t next_ = 0;   ///< of batch_.steps; at its end: nothing is loaded
  bool begun_ = false;     ///< step() is running
  bool any_ = false;       ///< there was a step
  double time_s_ = 0;      ///< program time, over all passes
  double offset_s_ = 0;    ///< where the clock of this pass begins
  double last_end_s_ = 0;  ///< of the last step that is over
  double turn_cos_ = 1;
  double turn_sin_ = 0;
  std::vector<double> lengths_;  ///< of the pieces of step(), summed up
  bool returning_ = false;       ///< on the way back to where a pass begins
  Pose return_from_{};
  std::array<Leg, 3> legs_{};
  double return_start_s_ = 0;
  SimulatedState state_;
};

}  // namespace kerf
