// kerf-machine - a simulated machine: executes a program in time and serves its positions. A
// program of its own, so that kerf holds no code that could write to a device.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <csignal>
#include <cstdio>
#include <memory>
#include <sstream>
#include <string>
#include <utility>

#include "base/exit_code.h"
#include "base/suggest.h"
#include "base/translate.h"
#include "machine_io/simulator/register_layout.h"
#include "twin/cli/cli_options.h"
#include "twin/cli/console.h"
#include "twin/cli/kerf_machine/machine_loop.h"
#include "twin/cli/kerf_machine/machine_options.h"
#include "twin/cli/stop_signals.h"

namespace kerf {
namespace {

constexpr const char* kFaultHelp = tr_noop(
    "Faults (--fault KIND[:PERIOD[:DURATION]], seconds since the start; default 10:1; 0: always):\n"
    "  drop         requests get no answer, no CAN frames\n"
    "  delay:MS     answers come late (delay:200:10:1)\n"
    "  garbage      random bytes\n"
    "  exception:N  Modbus exception N\n"
    "  restart      socket closed or pty removed, and there again afterwards\n"
    "  nan          positions are NaN, or -2147483648\n"
    "  freeze       nothing changes any more, the scan counter neither\n"
    "  jump         X Y Z are off by 50 mm\n");

constexpr const char* kCanHelp = tr_noop(
    "CAN frames, little endian, a set with each update:\n"
    "  cia402  X .. C are nodes 1 .. 6: id 0x380 + node, u16 status word, i32 position 0.001 mm\n"
    "  odrive  X .. C are nodes 0 .. 5: id node << 5 | 9, f32 turns (5 mm, 360 degrees), f32 "
    "turns/s\n"
    "  both    0x6f0: u16 tool, u32 line, u16 scan counter; 0x6f1: i16 rpm, i32 tool offset Z\n");

constexpr const char* kOutputHelp = tr_noop(
    "Standard output, a line each: listening modbus-tcp HOST:PORT | listening modbus-rtu DEVICE\n"
    "[link PATH] | sending can IFACE; started; fault KIND on|off at S s; finished after S s |\n"
    "stopped after S s; can-sent N; and at the end what went wrong, if it did: skipped-updates N,\n"
    "refused-requests N, can-not-sent N REASON.\n");

constexpr const char* kExits = tr_noop(
    "Exit codes: 0 finished or stopped by a signal, 2 usage, 3 CAN frames could not be sent,\n"
    "4 file, interpreter or device failure\n");

void add_all_options(CLI::App& app, WrittenOptions& options) {
  add_options(app, kMachine, options);
  app.footer(fmt::format("{}\n{}\n{}\n{}\n{}", tr(kFaultHelp), tr(kRegisterHelp), tr(kCanHelp),
                         tr(kOutputHelp), tr(kExits)));
}

void say(const std::string& line) {
  kerf::print(stdout, "{}\n", line);
  flush_console();
}

void print(const Diagnostics& diagnostics) {
  for (const Diagnostic& d : diagnostics) kerf::print(stderr, "{}", to_string(d));
}

int refuse(const std::string& message) {
  Diagnostic d;
  d.message = message;
  d.hint = tr("kerf-machine --help lists what there is");
  kerf::print(stderr, "{}", to_string(d));
  return kExitUsage;
}

int refuse_argument(const CLI::App& app, const std::string& argument) {
  if (argument.empty() || argument[0] != '-') {
    return refuse(trf("'{}': one argument too many", argument));
  }
  std::vector<std::string> known;
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_lnames()) known.push_back("--" + name);
  }
  const std::string found = argument.substr(0, argument.find('='));
  const std::string near = nearest_word(found, known);
  const std::string advice = near.empty() ? "" : trf("; did you mean {}?", near);
  return refuse(trf("unknown option {}{}", found, advice));
}

int fail(const std::string& message) {
  Diagnostic d;
  d.message = message;
  kerf::print(stderr, "{}", to_string(d));
  return kExitFailure;
}

/// All that goes out of the process.
struct Outlets {
  StateBoard board;
  std::unique_ptr<ModbusServer> tcp;
  std::unique_ptr<ModbusServer> rtu;
  std::unique_ptr<CanSender> can;

  std::uint64_t asked() const { return (tcp ? tcp->asked() : 0) + (rtu ? rtu->asked() : 0); }
  std::uint64_t refused() const { return (tcp ? tcp->refused() : 0) + (rtu ? rtu->refused() : 0); }
};

/// Empty, or why not.
std::string open_outlets(const MachineRequest& request, Outlets& out) {
  const bool restarts = request.has_fault(FaultKind::kRestart);
  if (request.modbus_tcp) {
    auto server = ModbusServer::open_tcp(
        *request.modbus_tcp, out.board, restarts,
        [](const std::string& address) { say("listening modbus-tcp " + address); });
    if (!server) return server.error();
    out.tcp = std::move(*server);
    say("listening modbus-tcp " + out.tcp->address());
  }
  if (request.modbus_rtu) {
    auto server = ModbusServer::open_rtu(
        *request.modbus_rtu, out.board, restarts,
        [](const std::string& address) { say("listening modbus-rtu " + address); });
    if (!server) return server.error();
    out.rtu = std::move(*server);
    say("listening modbus-rtu " + out.rtu->address());
  }
  if (!request.can.empty()) {
    auto sender = CanSender::open(request.can, request.can_layout);
    if (!sender) return sender.error();
    out.can = std::move(*sender);
    say("sending can " + request.can);
  }
  return "";
}

int run_machine(const MachineRequest& request) {
  std::stop_source stop;
  const StopSignals signals(stop, [] {});
  Diagnostics diagnostics;
  auto program = Program::open(request.source.program, diagnostics);
  if (!program) {
    print(diagnostics);
    return kExitFailure;
  }
  StepFeed feed({request.source.program, request.source.timeline, request.repeat},
                std::move(program));
  MachinePlayer player(feed, request.frame);
  player.prepare(stop.get_token());
  Outlets out;
  MachineLoopOptions options{request.rate_hz, request.speed,  request.start_delay_s, {},
                             request.hold,    request.faults, request.load};
  if (request.wait_for_reader) options.has_reader = [&out] { return out.asked() > 0; };
  publish_start(player, options, out.board);
  if (const std::string why = open_outlets(request, out); !why.empty()) return fail(why);
  const MachineLoopResult result =
      run_machine_loop(options, player, out.board, out.can.get(), say, stop.get_token());
  if (!result.finished) say(fmt::format("stopped after {:.3f} s", result.elapsed_s));
  if (result.skipped > 0) say(fmt::format("skipped-updates {}", result.skipped));
  if (out.refused() > 0) say(fmt::format("refused-requests {}", out.refused()));
  const std::uint64_t lost = out.can ? out.can->not_sent() : 0;
  if (out.can) say(fmt::format("can-sent {}", out.can->sent()));
  if (lost > 0) say(fmt::format("can-not-sent {} {}", lost, out.can->trouble()));
  if (result.finished) {
    print(feed.diagnostics());
    if (has_error(feed.diagnostics())) return kExitFailure;
  }
  return lost > 0 ? kExitLossy : kExitGood;
}

int run(int argc, char** argv) {
  CLI::App app(tr("kerf-machine: executes a program in time and serves its positions"),
               "kerf-machine");
  speak_language(app, std::string("kerf-machine ") + KERF_VERSION);
  app.allow_extras();
  WrittenOptions options;
  add_all_options(app, options);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& success) {
    std::ostringstream text;
    const int code = app.exit(success, text, text);  // --help, --version
    kerf::print(stdout, "{}", text.str());
    return code;
  } catch (const CLI::ParseError& error) {
    return refuse(words_of(error));
  }
  const std::vector<std::string> left = app.remaining();
  if (!left.empty()) return refuse_argument(app, left.front());
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& value : option->results()) {
      if (value.empty()) return refuse(option->get_name() + tr(": the value is empty"));
    }
  }
  Diagnostics diagnostics;
  const MachineRequest request = understand_machine(options, diagnostics);
  if (has_error(diagnostics)) {
    print(diagnostics);
    return kExitUsage;
  }
  return run_machine(request);
}

}  // namespace
}  // namespace kerf

int main(int argc, char** argv) {
  // A reader of the output that has seen enough must not stop the machine.
  std::signal(SIGPIPE, SIG_IGN);
  kerf::use_language(kerf::language_of_environment());
  return kerf::end_console(kerf::run(argc, argv));
}
