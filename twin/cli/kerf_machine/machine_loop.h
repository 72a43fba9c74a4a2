// twin/cli/kerf_machine/machine_loop.h - the clock of the simulated machine.
#pragma once

#include <cstdint>
#include <functional>
#include <stop_token>
#include <string>
#include <vector>

#include "machine_io/simulator/can_sender.h"
#include "machine_io/simulator/fault.h"
#include "machine_io/simulator/load_profile.h"
#include "machine_io/simulator/state_board.h"
#include "twin/cli/kerf_machine/machine_player.h"

namespace kerf {

struct MachineLoopOptions {
  double rate_hz = 1000;
  double speed = 1;  ///< seconds of the program in one of the clock
  double start_delay_s = 0;
  /// If set, start_delay_s counts from when it says yes.
  std::function<bool()> has_reader;
  bool hold = false;  ///< go on at the end, until stopped
  std::vector<FaultRule> faults;
  LoadProfile load;  ///< by the time of the program
};

struct MachineLoopResult {
  bool finished = false;      ///< false: stopped before the end of the program
  double elapsed_s = 0;       ///< from the start of the program to its end (or to the stop)
  std::uint64_t updates = 0;  ///< of the positions
  std::uint64_t skipped = 0;  ///< that this computer was too late for
};

/// Calls once a line, without a line feed: "started", "fault drop on at 5.000 s", "fault drop off
/// at 5.200 s", "finished after 12.345 s" (seconds of the clock since the start).
using SayLine = std::function<void(const std::string&)>;

/// Where the machine is before it has moved: for answers before the loop.
void publish_start(const MachinePlayer& player, const MachineLoopOptions& options,
                   StateBoard& board);

/// Runs the program: at absolute deadlines (clock_nanosleep), so that errors do not add up, the
/// positions of that deadline are computed, published and sent. An update that comes too late by a
/// period or more is skipped and counted; the positions stay those of the clock. The faults' time
/// is that of the clock since the start of the program, whatever the speed.
MachineLoopResult run_machine_loop(const MachineLoopOptions& options, MachinePlayer& player,
                                   StateBoard& board, CanSender* can, const SayLine& say,
                                   const std::stop_token& stop);

}  // namespace kerf
