#include "twin/program/probe_desk.h"

#include <utility>

namespace kerf {

ProbeAnswer ProbeDesk::ask(const ProbeQuestion& question) {
  {
    const std::lock_guard lock(mutex_);
    if (closed_) return {};
    question_ = question;
    answer_.reset();
  }
  if (!queue_.push_mark()) return {};
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return closed_ || answer_.has_value(); });
  question_.reset();
  return std::exchange(answer_, std::nullopt).value_or(ProbeAnswer{});
}

void ProbeDesk::give(ProbeAnswer answer) {
  {
    const std::lock_guard lock(mutex_);
    answer_ = std::move(answer);
  }
  changed_.notify_one();
}

void ProbeDesk::close() {
  {
    const std::lock_guard lock(mutex_);
    closed_ = true;
  }
  changed_.notify_one();
}

}  // namespace kerf
