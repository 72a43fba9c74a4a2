// viewer/raycast/parallel.h - work in equal pieces on a few threads.
#pragma once

#include <atomic>
#include <cstddef>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace kerf {

/// Calls work(n) for n = 0 .. count - 1, in any order, on at most `threads` threads of which this
/// is one. Starts no thread for fewer than `least_for_two` pieces: that takes some 20 us. A worker
/// takes several pieces at once where there are many. An exception of a piece is thrown again when
/// all threads are done.
template <class Work>
void for_each_piece(std::size_t count, int threads, std::size_t least_for_two, const Work& work) {
  constexpr std::size_t kTakes = 64;  // of all threads together
  const std::size_t at_once = count / kTakes + 1;
  std::atomic<std::size_t> next{0};
  std::mutex mutex;  // of failure
  std::exception_ptr failure;
  const auto run = [&] {
    try {
      for (;;) {
        const std::size_t begin = next.fetch_add(at_once, std::memory_order_relaxed);
        if (begin >= count) return;
        for (std::size_t n = begin; n < begin + at_once && n < count; ++n) work(n);
      }
    } catch (...) {
      const std::lock_guard lock(mutex);
      failure = std::current_exception();
    }
  };
  std::vector<std::jthread> others;
  if (count >= least_for_two) {
    for (int k = 1; k < threads; ++k) others.emplace_back(run);
  }
  run();
  others.clear();  // joins
  if (failure) std::rethrow_exception(failure);
}

}  // namespace kerf
