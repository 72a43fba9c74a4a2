#include "twin/cli/kerf_machine/machine_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "base/translate.h"

namespace kerf {
namespace {

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

void understand_modbus(OptionReader& reader, MachineRequest& request) {
  const std::string tcp = reader.text("--modbus-tcp");
  if (!tcp.empty()) {
    request.modbus_tcp = parse_tcp(tcp);
    if (!request.modbus_tcp) {
      reader.fault(
          "--modbus-tcp",
          trf("'{}' is not HOST:PORT with a port from 0 (choose one) to {}", tcp, kMaxPort),
          "127.0.0.1:0, or [::1]:1502");
    }
  }
  if (reader.is_yes("--modbus-rtu")) {
    ModbusRtuEnd end;
    end.link = reader.text("--link");
    end.baud = static_cast<int>(reader.whole_number("--baud"));
    end.unit = static_cast<int>(reader.whole_number("--unit"));
    request.modbus_rtu = std::move(end);
    return;
  }
  for (const char* const option : {"--link", "--baud"}) {
    if (reader.choose(option).is_said()) reader.fault(option, tr("only with --modbus-rtu"));
  }
  if (reader.choose("--unit").is_said()) {
    reader.fault("--unit", tr("only with --modbus-rtu: over TCP every unit id is answered"));
  }
}

void understand_can(OptionReader& reader, MachineRequest& request) {
  request.can = reader.text("--can");
  if (request.can.empty() && reader.choose("--can-layout").is_said()) {
    reader.fault("--can-layout", tr("only with --can"));
  }
  reader.word("--can-layout", {CanLayout::kCia402, CanLayout::kOdrive}, request.can_layout);
}

void understand_faults(OptionReader& reader, MachineRequest& request) {
  const bool modbus = reader.choose("--modbus-tcp").is_said() || reader.is_yes("--modbus-rtu");
  for (const std::string& text : reader.texts("--fault")) {
    const Result<FaultRule> rule = parse_fault(text);
    if (!rule) {
      reader.fault("--fault", rule.error());
      continue;
    }
    const bool answers = rule->kind == FaultKind::kDelay || rule->kind == FaultKind::kException;
    if (answers && !modbus && !request.can.empty()) {
      reader.fault("--fault",
                   trf("{} is a fault of answers, and CAN frames are none", to_string(rule->kind)));
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

MachineRequest understand_machine(const WrittenOptions& options, Diagnostics& diagnostics) {
  OptionReader reader(diagnostics, {kMachine, &options, nullptr, {}});
  MachineRequest request;
  request.source = understand_program("PROGRAM", {}, reader);
  // Here the machine is known: it is this one.
  request.source.program.machine.unknown_places = false;
  // A machine may run for ever: no number of commands, no silence makes a program endless here.
  request.source.program.max_commands = 0;
  request.source.program.max_silent_s = 1e9;
  request.repeat = reader.is_yes("--repeat");
  if (request.source.program.path == "-" && request.repeat) {
    reader.fault("--repeat", tr("standard input can be read once only"));
  }
  if (!options.has("--modbus-tcp") && !options.has("--modbus-rtu") && !options.has("--can")) {
    reader.fault(tr("no way out for the positions"),
                 tr("one of --modbus-tcp, --modbus-rtu and --can is needed"),
                 tr("kerf machine part.ngc --modbus-tcp 127.0.0.1:0"));
  }
  understand_modbus(reader, request);
  understand_can(reader, request);
  understand_faults(reader, request);
  if (const std::string load = reader.text("--load"); !load.empty()) {
    Result<LoadProfile> profile = LoadProfile::parse(load);
    if (profile) {
      request.load = std::move(*profile);
    } else {
      reader.fault("--load", profile.error(), "--load 0:4.5,10:4.5,10.2:31");
    }
  }
  request.rate_hz = reader.number("--rate");
  request.speed = reader.number("--speed");
  request.start_delay_s = reader.number("--start-delay");
  reader.word("--frame", {ServedFrame::kMachine, ServedFrame::kWorkpiece}, request.frame);
  request.wait_for_reader = reader.is_yes("--wait-for-reader");
  if (request.wait_for_reader && options.has("--can")) {
    reader.fault("--wait-for-reader", tr("not with --can: who reads frames does not ask for them"));
  }
  request.hold = reader.is_yes("--hold");
  return request;
}

}  // namespace kerf
