// stock/zmap/height_mesh_parallel.h - a loop divided among threads.
#pragma once

#include <algorithm>
#include <cstddef>
#include <exception>
#include <thread>
#include <vector>

namespace kerf {

/// Calls body(begin, end) for adjoining parts of [0, count), each in its own thread and none
/// shorter than `least_part` unless there is only one. Returns when all are done; an exception of a
/// part is thrown again here. The result must not depend on how the range is divided.
template <class Body>
void parallel_parts(std::size_t count, std::size_t least_part, int threads, const Body& body) {
  const std::size_t wanted = count / std::max<std::size_t>(least_part, 1);
  const std::size_t parts = std::clamp<std::size_t>(wanted, 1, std::size_t(std::max(threads, 1)));
  std::vector<std::exception_ptr> failures(parts);
  const auto run_part = [&](std::size_t part) {
    try {
      body(count * part / parts, count * (part + 1) / parts);
    } catch (...) {
      failures[part] = std::current_exception();
    }
  };
  std::vector<std::jthread> others;
  for (std::size_t part = 1; part < parts; ++part) others.emplace_back(run_part, part);
  run_part(0);
  others.clear();  // joins
  for (const std::exception_ptr& failure : failures) {
    if (failure) std::rethrow_exception(failure);
  }
}

}  // namespace kerf
