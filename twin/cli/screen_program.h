// twin/cli/screen_program.h - the program that LinuxCNC has loaded is followed by itself: it is
// dry-run when it is opened or changed on the disk, and the watch goes on along it.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "machine_io/hal/loaded_file.h"
#include "twin/cli/dry_run.h"
#include "twin/config/written_options.h"

namespace kerf {

/// What is known now.
struct ScreenProgramState {
  std::string program;                 ///< that LinuxCNC has loaded; empty: none
  std::uint32_t number = 0;            ///< of its dry run; another one where it has changed
  std::optional<DryRunResult> result;  ///< none: not done yet
};

/// A thread of its own looks ten times a second.
class ScreenProgram {
 public:
  /// `options_of`: of a program, as its dry run is to have them. `on_load` is called by the thread
  /// when the watch is to go on along another program, or along the same one as it is now on the
  /// disk (empty: along none); false: it cannot now, and is asked again. Not while `runs()`, unless
  /// none is followed yet: LinuxCNC goes on with what it has read.
  ScreenProgram(std::string kerf_status, std::string nml_file,
                std::function<WrittenOptions(const std::string&)> options_of,
                std::function<bool()> runs, std::function<bool(const std::string&)> on_load);
  ~ScreenProgram();
  ScreenProgram(const ScreenProgram&) = delete;
  ScreenProgram& operator=(const ScreenProgram&) = delete;

  ScreenProgramState state() const;
  /// The options of the program are others now: as if its file had changed. From any thread.
  void look_again() { is_changed_ = true; }

 private:
  void watch(const std::stop_token& stop);

  LoadedFile file_;
  std::function<WrittenOptions(const std::string&)> options_of_;
  std::function<bool()> runs_;
  std::function<bool(const std::string&)> on_load_;
  std::atomic<bool> is_changed_{false};
  mutable std::mutex mutex_;  // of state_
  ScreenProgramState state_;
  std::jthread thread_;  // last: it uses all of the above
};

}  // namespace kerf
