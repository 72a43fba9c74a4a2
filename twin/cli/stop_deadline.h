// twin/cli/stop_deadline.h - a stop that is obeyed in time, whatever is under way.
#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <stop_token>
#include <thread>

namespace kerf {

/// What is cut or read looks at its stop token itself; what fills a blank, makes a mesh or draws a
/// picture does not. While this lives, a stop that has been requested leaves it a moment; then last
/// words are said, temporary files removed, and the process ends with `exit_code`, at most 0.3 s
/// after the request. The moment is kMoment_s of the process's own time, so that a busy computer
/// does not cut it short, but no more than `patience` by the clock.
class StopDeadline {
 public:
  static constexpr double kMoment_s = 0.2;

  StopDeadline(std::stop_token stop, int exit_code);
  /// What was to be done is done: nothing is cut short any more.
  ~StopDeadline();
  StopDeadline(const StopDeadline&) = delete;
  StopDeadline& operator=(const StopDeadline&) = delete;

  /// From now on these are said, in a thread of their own: of what they look at nobody else may
  /// change anything. Temporary files are gone by then; they may write others.
  void set_last_words(std::function<void()> words, std::chrono::milliseconds patience);

 private:
  void watch(const std::stop_token& stop);
  std::mutex mutex_;
  std::condition_variable_any wake_;
  std::function<void()> words_;
  std::chrono::milliseconds patience_{10'000};
  int exit_code_;
  bool over_ = false;
  std::thread thread_;
};

}  // namespace kerf
