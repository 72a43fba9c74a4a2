#include "viewer/viewer_command.h"

#include <utility>

namespace kerf {
namespace {

/// Only the last of a row of these matters.
bool replaces_same(const ViewerCommand& command) {
  return std::holds_alternative<SpeedCommand>(command) ||
         std::holds_alternative<SeekTimeCommand>(command) ||
         std::holds_alternative<DetailCommand>(command);
}

}  // namespace

void CommandQueue::push(ViewerCommand command) {
  {
    const std::lock_guard lock(mutex_);
    if (!commands_.empty() && replaces_same(command) &&
        commands_.back().index() == command.index()) {
      commands_.back() = std::move(command);
    } else {
      commands_.push_back(std::move(command));
    }
  }
  filled_.notify_one();
}

std::vector<ViewerCommand> CommandQueue::take() {
  const std::lock_guard lock(mutex_);
  return std::exchange(commands_, {});
}

std::vector<ViewerCommand> CommandQueue::wait_for(std::chrono::milliseconds longest) {
  std::unique_lock lock(mutex_);
  filled_.wait_for(lock, longest, [this] { return !commands_.empty(); });
  return std::exchange(commands_, {});
}

}  // namespace kerf
