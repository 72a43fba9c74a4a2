// base/worker_pool.h - a few threads that do the same call with different numbers.
#pragma once

#include <condition_variable>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace kerf {

/// run(f) calls f(0) .. f(threads-1), f(0) on the caller's thread, and returns when all are done.
/// Not re-entrant. An exception of one of the calls is thrown again when all are done.
class WorkerPool {
 public:
  explicit WorkerPool(int threads);
  ~WorkerPool();
  WorkerPool(const WorkerPool&) = delete;
  WorkerPool& operator=(const WorkerPool&) = delete;
  int threads() const { return static_cast<int>(workers_.size()) + 1; }
  void run(const std::function<void(int)>& work);

 private:
  void serve(int number);
  void call(const std::function<void(int)>& work, int number);
  std::mutex mutex_;
  std::condition_variable wake_, done_;
  const std::function<void(int)>* work_ = nullptr;
  unsigned round_ = 0;
  int busy_ = 0;
  bool quit_ = false;
  std::exception_ptr failure_;  ///< the first of this round
  std::vector<std::thread> workers_;
};

}  // namespace kerf
