#include "twin/cli/screen_program.h"

#include <utility>

#include "twin/cli/file_watch.h"

namespace kerf {
namespace {

constexpr std::chrono::milliseconds kPeriod{100};

}  // namespace

ScreenProgram::ScreenProgram(std::string kerf_status, std::string nml_file,
                             std::function<WrittenOptions(const std::string&)> options_of,
                             std::function<bool()> runs,
                             std::function<bool(const std::string&)> on_load)
    : file_(std::move(kerf_status), std::move(nml_file)),
      options_of_(std::move(options_of)),
      runs_(std::move(runs)),
      on_load_(std::move(on_load)),
      thread_([this](const std::stop_token& stop) { watch(stop); }) {}

ScreenProgram::~ScreenProgram() {
  thread_.request_stop();
  thread_.join();
}

ScreenProgramState ScreenProgram::state() const {
  const std::lock_guard lock(mutex_);
  return state_;
}

void ScreenProgram::watch(const std::stop_token& stop) {
  FileWatch on_disk;
  std::optional<DryRun> run;
  std::string followed;  // by the watch
  bool is_due = false;   // the watch is to follow it anew
  std::uint32_t number = 0;
  std::string program;
  while (!stop.stop_requested()) {
    file_.wait(kPeriod);
    const std::string now = file_.path().value_or("");
    const bool is_other = now != program;
    const bool is_changed = is_changed_.exchange(false);
    if (is_other || is_changed || on_disk.has_changed()) {
      program = now;
      on_disk.clear();
      on_disk.add(program);
      run.reset();
      {
        const std::lock_guard lock(mutex_);
        state_ = {program, ++number, std::nullopt};
      }
      is_due = true;
      if (!program.empty()) {
        Result<DryRun> started = DryRun::start(program, options_of_(program));
        if (started) {
          run = std::move(*started);
        } else {
          DryRunResult failed;
          failed.program = program;
          failed.trouble = started.error();
          const std::lock_guard lock(mutex_);
          state_.result = std::move(failed);
        }
      }
    }
    // A LinuxCNC that has ended leaves the workpiece where it is.
    const bool is_away = program.empty() && !file_.path().has_value();
    // Where nothing is followed, as after a crash, a program that runs already is joined.
    const bool may_go_on = followed.empty() || !runs_();
    if (is_due && !is_away && may_go_on && !(program.empty() && followed.empty())) {
      is_due = !on_load_(program);
      if (!is_due) followed = program;
    }
    if (!run) continue;
    if (std::optional<DryRunResult> result = run->look()) {
      run.reset();
      const std::lock_guard lock(mutex_);
      state_.result = std::move(*result);
    }
  }
}

}  // namespace kerf
