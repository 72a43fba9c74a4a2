// base/helper_thread.h - a thread that works for the one that made it, and whose failures are that
// one's.
#pragma once

#include <exception>
#include <functional>
#include <thread>
#include <utility>

namespace kerf {

/// An exception of `work` (memory that ran out) does not end the process: it comes out of join().
/// `release` must bring both sides' waits to an end (close a queue, request a stop): it is called
/// when `work` has failed, and when the owner drops a thread that it has not joined, as when it
/// fails itself. Any number of times, from either thread.
class HelperThread {
 public:
  HelperThread() = default;
  HelperThread(std::function<void()> work, std::function<void()> release)
      : release_(std::move(release)), thread_([this, work = std::move(work)] { run(work); }) {}
  HelperThread(const HelperThread&) = delete;
  HelperThread& operator=(const HelperThread&) = delete;
  ~HelperThread() {
    if (!thread_.joinable()) return;
    release_();
    thread_.join();
  }

  /// Waits for the end of `work`; throws what it threw.
  void join() {
    thread_.join();
    if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
  }
  bool joinable() const { return thread_.joinable(); }

 private:
  void run(const std::function<void()>& work) {
    try {
      work();
    } catch (...) {
      failure_ = std::current_exception();
      release_();
    }
  }
  std::function<void()> release_;
  std::exception_ptr failure_;
  std::thread thread_;  // last: it uses the others
};

}  // namespace kerf
