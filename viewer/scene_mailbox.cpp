#include "viewer/scene_mailbox.h"

#include <utility>

namespace kerf {

void SceneMailbox::publish(SceneUpdate update) {
  const std::lock_guard one_at_a_time(publishers_);
  auto fresh = std::make_unique<SceneUpdate>(std::move(update));
  std::unique_ptr<SceneUpdate> waiting;
  {
    const std::lock_guard lock(slot_mutex_);
    waiting = std::move(slot_);
  }
  if (waiting) {
    // Out of the window's way: if it looks now, it finds nothing and looks again next frame.
    merge(waiting.get(), std::move(*fresh));
    fresh = std::move(waiting);
  }
  {
    const std::lock_guard lock(slot_mutex_);
    slot_ = std::move(fresh);
  }
  if (wake_) wake_();
}

bool SceneMailbox::is_full() {
  const std::lock_guard lock(slot_mutex_);
  return slot_ != nullptr;
}

std::unique_ptr<SceneUpdate> SceneMailbox::take() {
  const std::lock_guard lock(slot_mutex_);
  return std::move(slot_);
}

}  // namespace kerf
