// machine_io/hal/loaded_file.h - which program the LinuxCNC on this computer has loaded.
#pragma once

#include <chrono>
#include <optional>
#include <string>

#include "machine_io/hal/hal_child.h"
#include "machine_io/hal/status_lines.h"

namespace kerf {

/// Asks kerf-status, which reads LinuxCNC's status and commands nothing. It is started again where
/// it ends, as it does with LinuxCNC. For one thread.
class LoadedFile {
 public:
  static constexpr std::chrono::milliseconds kRetry{1000};

  /// `executable`: of find_kerf_status(). `nml_file`: the INI's [EMC]NML_FILE; empty: LinuxCNC's.
  LoadedFile(std::string executable, std::string nml_file);

  /// Waits for news, at most so long.
  void wait(std::chrono::milliseconds patience);
  /// Nothing: no LinuxCNC runs, or it has not answered yet. Empty: it has no program.
  const std::optional<std::string>& path() const { return lines_.program(); }

 private:
  using Clock = std::chrono::steady_clock;
  void take_lines();

  std::string executable_;
  std::string nml_file_;
  std::optional<HalChild> child_;
  Clock::time_point retry_at_{};
  StatusLines lines_;
};

/// Beside this executable, in ../lib/kerf beside it, or in PATH; empty: it is not there.
std::string find_kerf_status();

}  // namespace kerf
