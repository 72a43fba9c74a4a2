#include "twin/config/setting_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>

namespace kerf {
namespace {

constexpr std::array kCommands{
    CommandRow{kRun, "run", tr_noop("cut a program and report")},
    CommandRow{kView, "view", tr_noop("a program, a log or a saved workpiece in a window")},
    CommandRow{kShadow, "shadow", tr_noop("follow a machine that runs")},
    CommandRow{kReplay, "replay", tr_noop("run a log of a machine again")},
    CommandRow{kDiff, "diff", tr_noop("what differs between two programs or workpieces")},
    CommandRow{kOptimize, "optimize", tr_noop("give a program the feeds that its cuts allow")},
    CommandRow{kBatch, "batch",
               tr_noop("run many programs, each by itself; goes on where it stopped")},
    CommandRow{kJob, "job", tr_noop("a part in several setups, one after the other")},
    CommandRow{kCanon, "canon", tr_noop("print what a program commands as JSON lines")},
    CommandRow{kConfig, "config", tr_noop("check or print a configuration, or list every key")},
    CommandRow{kMachine, "machine", tr_noop("a simulated machine that serves its positions")},
    CommandRow{kSetup, "setup", tr_noop("a tab with the machine twin in LinuxCNC's screen")},
    CommandRow{kModels, "models", tr_noop("list the workpiece models")},
    CommandRow{kSources, "sources", tr_noop("list where positions may come from")},
    CommandRow{kTools, "tools",
               tr_noop("list the tool shapes, the holders, or the tools of a library")},
    CommandRow{kMcp, "mcp", tr_noop("dry runs as tools of an assistant (Model Context Protocol)")},
};

}  // namespace

std::span<const Setting> setting_table() {
  static const std::vector<Setting> table = [] {
    std::vector<Setting> all;
    for (const auto topic :
         {call_settings, machine_settings, workpiece_settings, sheet_settings, follow_settings,
          output_settings, batch_settings, job_settings, optimize_settings, view_settings,
          source_settings, map_settings, simulator_settings}) {
      const std::span<const Setting> rows = topic();
      all.insert(all.end(), rows.begin(), rows.end());
    }
    for (Setting& row : all) {
      if (is_passed_on(row)) row.commands |= kBatch;
    }
    return all;
  }();
  return table;
}

bool is_passed_on(const Setting& setting) {
  constexpr std::array<std::string_view, 22> kOfOneRun{
      "--json",    "--junit",    "--sarif",          "--csv",  "--png",  "--finding-png",
      "--stl",     "--ply",      "--state",          "--dxf",  "--svg",  "--mesh-tolerance",
      "--html",    "--pdf",      "--compare-png",    "--view", "--draw", "--quiet",
      "--verbose", "--rest-png", "--engagement-png", "--serve"};
  return (setting.commands & kRun) != 0 && !setting.option.empty() && !setting.is_positional() &&
         std::find(kOfOneRun.begin(), kOfOneRun.end(), setting.option) == kOfOneRun.end();
}

const Setting& setting_of(std::string_view option, Command command) {
  const std::span<const Setting> table = setting_table();
  const auto find = [&](unsigned commands) {
    return std::find_if(table.begin(), table.end(), [&](const Setting& row) {
      return row.option == option && (row.commands & commands) != 0;
    });
  };
  auto found = find(command);
  if (found == table.end()) found = find(~0U);
  assert(found != table.end() && "an option that the table does not have");
  return *found;
}

std::string help_of(const Setting& setting) {
  // Lengths are in --units, the table's are mm.
  std::string fallback(setting.fallback);
  if (setting.is_length() && fallback != "0") fallback += " mm";
  return formatted(setting.help, tr(setting.help), fmt::make_format_args(fallback));
}

std::span<const CommandRow> command_table() { return kCommands; }

const char* name_of(Command command) {
  const auto* const row = std::find_if(kCommands.begin(), kCommands.end(),
                                       [&](const auto& one) { return one.command == command; });
  return row == kCommands.end() ? "" : row->name;
}

std::vector<std::string> parts_of(std::string_view words) {
  std::vector<std::string> parts;
  for (std::size_t start = 0; start < words.size();) {
    const std::size_t end = std::min(words.find('|', start), words.size());
    parts.emplace_back(words.substr(start, end - start));
    start = end + 1;
  }
  return parts;
}

}  // namespace kerf
