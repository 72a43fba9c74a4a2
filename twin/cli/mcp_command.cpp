#include "twin/cli/mcp_command.h"

#include <sys/eventfd.h>
#include <unistd.h>

#include <filesystem>
#include <stop_token>
#include <system_error>

#include "base/exit_code.h"
#include "base/translate.h"
#include "interp_bridge/private_folder.h"
#include "twin/cli/console.h"
#include "twin/cli/option_reader.h"
#include "twin/cli/run_options.h"
#include "twin/cli/stop_signals.h"
#include "twin/mcp/mcp_server.h"

namespace kerf {

int mcp_command(const Arguments& arguments) {
  Diagnostics diagnostics;
  OptionReader reader(diagnostics, layers_of(arguments, nullptr));
  McpOptions options{.folder = reader.text("--folder"), .bounds = {}, .version = KERF_VERSION};
  options.bounds.seconds = reader.number("--each-seconds");
  options.bounds.memory_mb = reader.number("--each-memory");
  std::error_code failed;
  const std::filesystem::path folder = std::filesystem::canonical(options.folder, failed);
  if (!failed) std::filesystem::current_path(folder, failed);
  if (failed) {
    reader.fault("--folder", trf("{}: {}", options.folder.string(), failed.message()));
  }
  print_diagnostics(diagnostics, false);
  if (has_error(diagnostics)) return kExitUsage;
  options.folder = folder;
  const int stopped = eventfd(0, EFD_CLOEXEC);
  std::stop_source stop;
  const StopSignals signals(stop, remove_private_folders);
  const std::stop_callback wakes(stop.get_token(), [&] { eventfd_write(stopped, 1); });
  serve_mcp(options, STDIN_FILENO, STDOUT_FILENO, stopped);
  return kExitGood;
}

}  // namespace kerf
