// twin/machine/machine_options.h - the command line of kerf-machine.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/diagnostic.h"
#include "machine_io/simulator/can_sender.h"
#include "machine_io/simulator/fault.h"
#include "machine_io/simulator/modbus_server.h"
#include "twin/app/program_options.h"
#include "twin/machine/machine_player.h"

namespace kerf {

/// The arguments as written. Empty = not given.
struct MachineArguments {
  ProgramArguments source;
  std::string modbus_tcp;
  bool modbus_rtu = false;
  std::string link;
  std::string baud;
  std::string unit;
  std::string can;
  std::string can_layout;
  std::string rate;
  std::string speed;
  std::string start_delay;
  bool wait_for_reader = false;
  std::string frame;
  bool repeat = false;
  bool hold = false;
  std::vector<std::string> faults;
};

/// The same, understood.
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

  /// Whether the fault may come.
  bool has_fault(FaultKind kind) const;
};

/// All faults of the arguments at once go to `diagnostics`: one each.
MachineRequest understand_machine(const MachineArguments& arguments, Diagnostics& diagnostics);

}  // namespace kerf
