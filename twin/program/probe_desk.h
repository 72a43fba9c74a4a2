// twin/program/probe_desk.h - a question from the interpreter's thread to the one that cuts, and
// its answer.
#pragma once

#include <condition_variable>
#include <mutex>
#include <optional>

#include "interp_bridge/program.h"
#include "twin/program/batch_queue.h"

namespace kerf {

/// One question at a time. It travels behind the motions before it, as a mark in their queue
/// (an empty batch), so that whoever answers has cut them all.
class ProbeDesk {
 public:
  explicit ProbeDesk(BatchQueue& queue) : queue_(queue) {}

  /// The interpreter's thread: waits for the answer. Unknown, without a reason, where nobody
  /// answers any more.
  ProbeAnswer ask(const ProbeQuestion& question);
  /// The other one, for every mark that it takes from the queue.
  template <typename Answer>
  void serve(Answer answer) {
    std::optional<ProbeQuestion> question;
    {
      const std::lock_guard lock(mutex_);
      question = question_;
    }
    if (question) give(answer(*question));
  }
  /// Nobody answers any more.
  void close();

 private:
  void give(ProbeAnswer answer);

  BatchQueue& queue_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::optional<ProbeQuestion> question_;
  std::optional<ProbeAnswer> answer_;
  bool closed_ = false;
};

}  // namespace kerf
