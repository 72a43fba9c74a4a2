// twin/cli/kerf_machine/machine_options.h - the command line of kerf-machine.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/diagnostic.h"
#include "machine_io/simulator/can_sender.h"
#include "machine_io/simulator/fault.h"
#include "machine_io/simulator/load_profile.h"
#include "machine_io/simulator/modbus_server.h"
#include "twin/cli/kerf_machine/machine_player.h"
#include "twin/cli/program_options.h"

namespace kerf {

/// The options, understood.
struct MachineRequest {
  ProgramRequest source;
  std::optional<ModbusTcpEnd> modbus_tcp;
  std::optional<ModbusRtuEnd> modbus_rtu;
  std::string can;  ///< interface; empty: none
  CanLayout can_layout = CanLayout::kCia402;
  double rate_hz = 1000;
  double speed = 1;
  double start_delay_s = 0;
  bool wait_for_reader = false;
  ServedFrame frame = ServedFrame::kMachine;
  bool repeat = false;
  bool hold = false;
  std::vector<FaultRule> faults;
  LoadProfile load;

  /// Whether the fault may come.
  bool has_fault(FaultKind kind) const;
};

/// All faults of the arguments at once go to `diagnostics`: one each.
MachineRequest understand_machine(const WrittenOptions& options, Diagnostics& diagnostics);

}  // namespace kerf
