#include "twin/app/program_options.h"

#include <fmt/format.h>

namespace kerf {
namespace {

constexpr OptionRange kMaxCommands{1, 1e12, false, "commands"};
constexpr OptionRange kMaxSeconds{0, 1e6, true, "s"};

}  // namespace

ProgramOptions understand_program(const ProgramArguments& a, OptionReader& reader) {
  ProgramOptions options;
  options.path = a.program;
  options.tool_table_path = a.tool_table;
  if (a.interp == "bridge") {
    options.interpreter = InterpreterChoice::kBridge;
  } else if (a.interp == "text") {
    options.interpreter = InterpreterChoice::kText;
  } else if (!a.interp.empty()) {
    reader.fault("--interp",
                 fmt::format("'{}' is no interpreter; allowed: bridge, text", a.interp));
  }
  options.block_delete = reader.on_off("--block-delete", a.block_delete, options.block_delete);
  options.max_commands = static_cast<std::uint64_t>(reader.whole_number(
      "--max-commands", a.max_commands, kMaxCommands, static_cast<double>(options.max_commands)));
  options.max_silent_s =
      reader.number("--max-seconds", a.max_seconds, kMaxSeconds, options.max_silent_s);
  return options;
}

}  // namespace kerf
