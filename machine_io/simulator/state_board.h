// machine_io/simulator/state_board.h - what the simulated machine says of itself, handed from the
// thread that moves it to those that answer for it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <mutex>

namespace kerf {

/// X Y Z in mm, A B C in degrees.
inline constexpr std::size_t kSimulatedAxes = 6;

/// The machine at one moment.
struct SimulatedState {
  std::array<double, kSimulatedAxes> position{};
  std::uint32_t line = 0;  ///< of the program; 0: nothing moves, as LinuxCNC's program-line
  int tool = 0;            ///< in the spindle, 0 = none
  double spindle_rpm = 0;  ///< negative: counterclockwise
  double tool_offset_z_mm = 0;
  double load = 0;         ///< of the spindle, as kerf machine --load has it
  std::uint16_t scan = 0;  ///< counts the updates, 65535 is followed by 0: tells a dead source
};

/// What can be wrong with a machine on demand.
enum class FaultKind : std::uint8_t {
  kDrop,       ///< requests get no answer; no CAN frames
  kDelay,      ///< answers come late (Modbus)
  kGarbage,    ///< answers and frames are random bytes
  kException,  ///< requests get an exception (Modbus)
  kRestart,    ///< the machine is gone and comes back: socket closed, pty removed
  kNan,        ///< positions are NaN (floats) or the lowest number there is (integers)
  kFreeze,     ///< everything stands still, the scan counter too, while the machine goes on
  kJump,       ///< positions of X Y Z are off by kJump_mm
};
inline constexpr std::size_t kFaultKinds = 8;
inline constexpr double kJump_mm = 50;

/// The faults of one moment.
struct ActiveFaults {
  unsigned mask = 0;
  int delay_ms = 0;
  int exception_code = 0;

  bool has(FaultKind kind) const { return (mask >> static_cast<unsigned>(kind) & 1U) != 0; }
  void add(FaultKind kind) { mask |= 1U << static_cast<unsigned>(kind); }
  bool operator==(const ActiveFaults&) const = default;
};

/// What goes out: a state, and how it goes out.
struct ServedState {
  SimulatedState state;
  ActiveFaults faults;
};

/// One writer, any number of readers; a reader gets all of one moment or all of another, so that no
/// answer mixes two positions. A copy of about 100 bytes under a lock, nothing is allocated.
class StateBoard {
 public:
  void publish(const ServedState& served);
  ServedState read() const;

 private:
  mutable std::mutex mutex_;
  ServedState served_;
};

}  // namespace kerf
