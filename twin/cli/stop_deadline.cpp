#include "twin/cli/stop_deadline.h"

#include <unistd.h>

#include <algorithm>
#include <ctime>
#include <utility>

#include "base/atomic_file.h"
#include "interp_bridge/private_folder.h"
#include "twin/cli/console.h"

namespace kerf {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kLook{10};

double process_s() {
  timespec spent{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &spent);
  return static_cast<double>(spent.tv_sec) + 1e-9 * static_cast<double>(spent.tv_nsec);
}

}  // namespace

StopDeadline::StopDeadline(std::stop_token stop, int exit_code)
    : exit_code_(exit_code), thread_([this, stop = std::move(stop)] { watch(stop); }) {}

StopDeadline::~StopDeadline() {
  {
    const std::lock_guard lock(mutex_);
    over_ = true;
  }
  wake_.notify_one();
  thread_.join();
}

void StopDeadline::set_last_words(std::function<void()> words, std::chrono::milliseconds patience) {
  const std::lock_guard lock(mutex_);
  words_ = std::move(words);
  patience_ = patience;
}

void StopDeadline::watch(const std::stop_token& stop) {
  std::unique_lock lock(mutex_);
  wake_.wait(lock, stop, [this] { return over_; });
  const double spent_s = process_s();
  const Clock::time_point asked = Clock::now();
  while (!over_) {
    const std::chrono::duration<double> passed = Clock::now() - asked;
    const double moment_s = std::min(process_s() - spent_s, passed.count());
    if (moment_s >= kMoment_s || passed >= patience_) break;
    wake_.wait_for(lock, kLook, [this] { return over_; });
  }
  if (over_) return;
  // The lock is kept: nobody gets past this any more.
  remove_uncommitted_files();
  remove_private_folders();
  if (words_) words_();
  flush_console();
  _exit(exit_code_);
}

}  // namespace kerf
