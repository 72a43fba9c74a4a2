#include "twin/machine/machine_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

namespace kerf {
namespace {

constexpr OptionRange kRate{1, 10000, false, "Hz"};
constexpr OptionRange kSpeed{0.001, 1000, false, "times"};
constexpr OptionRange kStartDelay{0, 86400, false, "s"};
constexpr OptionRange kBaud{300, 4e6, false, "bits/s"};
constexpr OptionRange kUnit{1, 247, false, "unit id"};
constexpr int kMaxPort = 65535;

/// "HOST:PORT", "[::1]:PORT".
std::optional<ModbusTcpEnd> parse_tcp(const std::string& text) {
  const std::size_t colon = text.rfind(':');
  if (colon == text.npos) return {};
  ModbusTcpEnd end;
  end.host = text.substr(0, colon);
  if (end.host.size() > 2 && end.host.front() == '[' && end.host.back() == ']') {
    end.host = end.host.substr(1, end.host.size() - 2);
  } else if (end.host.find(':') != end.host.npos) {
    return {};
  }
  const char* const last = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data() + colon + 1, last, end.port);
  const bool good = error == std::errc() && stop == last && end.port >= 0 && end.port <= kMaxPort;
  return good && !end.host.empty() ? std::optional(end) : std::nullopt;
}

void understand_modbus(const MachineArguments& a, OptionReader& reader, MachineRequest& request) {
  if (!a.modbus_tcp.empty()) {
    request.modbus_tcp = parse_tcp(a.modbus_tcp);
    if (!request.modbus_tcp) {
      reader.fault("--modbus-tcp",
                   fmt::format("'{}' is not HOST:PORT with a port from 0 (choose one) to {}",
                               a.modbus_tcp, kMaxPort),
                   "127.0.0.1:0, or [::1]:1502");
    }
  }
  if (a.modbus_rtu) {
    ModbusRtuEnd end;
    end.link = a.link;
    end.baud = static_cast<int>(reader.whole_number("--baud", a.baud, kBaud, end.baud));
    end.unit = static_cast<int>(reader.whole_number("--unit", a.unit, kUnit, end.unit));
    request.modbus_rtu = std::move(end);
    return;
  }
  if (!a.link.empty()) reader.fault("--link", "only with --modbus-rtu");
  if (!a.baud.empty()) reader.fault("--baud", "only with --modbus-rtu");
  if (!a.unit.empty()) {
    reader.fault("--unit", "only with --modbus-rtu: over TCP every unit id is answered");
  }
}

void understand_can(const MachineArguments& a, OptionReader& reader, MachineRequest& request) {
  request.can = a.can;
  if (a.can.empty() && !a.can_layout.empty()) reader.fault("--can-layout", "only with --can");
  if (a.can_layout.empty() || a.can_layout == "cia402") return;
  if (a.can_layout == "odrive") {
    request.can_layout = CanLayout::kOdrive;
    return;
  }
  reader.fault("--can-layout",
               fmt::format("'{}' is no layout; allowed: cia402, odrive", a.can_layout));
}

void understand_faults(const MachineArguments& a, OptionReader& reader, MachineRequest& request) {
  const bool modbus = !a.modbus_tcp.empty() || a.modbus_rtu;
  for (const std::string& text : a.faults) {
    const Result<FaultRule> rule = parse_fault(text);
    if (!rule) {
      reader.fault("--fault", rule.error());
      continue;
    }
    const bool answers = rule->kind == FaultKind::kDelay || rule->kind == FaultKind::kException;
    if (answers && !modbus && !a.can.empty()) {
      reader.fault("--fault", fmt::format("{} is a fault of answers, and CAN frames are none",
                                          to_string(rule->kind)));
      continue;
    }
    request.faults.push_back(*rule);
  }
}

}  // namespace

bool MachineRequest::has_fault(FaultKind kind) const {
  return std::any_of(faults.begin(), faults.end(),
                     [kind](const FaultRule& rule) { return rule.kind == kind; });
}

MachineRequest understand_machine(const MachineArguments& a, Diagnostics& diagnostics) {
  OptionReader reader(diagnostics);
  MachineRequest request;
  request.source = understand_program(a.source, reader);
  // Here the machine is known: it is this one.
  request.source.program.machine.unknown_places = false;
  // A machine may run for ever: no number of commands, no silence makes a program endless here.
  request.source.program.max_commands = 0;
  request.source.program.max_silent_s = 1e9;
  if (a.source.program == "-" && a.repeat) {
    reader.fault("--repeat", "standard input can be read once only");
  }
  if (a.modbus_tcp.empty() && !a.modbus_rtu && a.can.empty()) {
    reader.fault("no way out for the positions",
                 "one of --modbus-tcp, --modbus-rtu and --can is needed",
                 "kerf machine part.ngc --modbus-tcp 127.0.0.1:0");
  }
  understand_modbus(a, reader, request);
  understand_can(a, reader, request);
  understand_faults(a, reader, request);
  request.rate_hz = reader.number("--rate", a.rate, kRate, request.rate_hz);
  request.speed = reader.number("--speed", a.speed, kSpeed, request.speed);
  request.start_delay_s = reader.number("--start-delay", a.start_delay, kStartDelay, 0);
  if (a.frame == "workpiece") {
    request.frame = ServedFrame::kWorkpiece;
  } else if (!a.frame.empty() && a.frame != "machine") {
    reader.fault("--frame", fmt::format("'{}' is no frame; allowed: machine, workpiece", a.frame));
  }
  if (a.wait_for_reader && !a.can.empty()) {
    reader.fault("--wait-for-reader", "not with --can: who reads frames does not ask for them");
  }
  request.wait_for_reader = a.wait_for_reader;
  request.repeat = a.repeat;
  request.hold = a.hold;
  return request;
}

}  // namespace kerf
