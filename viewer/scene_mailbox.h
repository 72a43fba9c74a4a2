// viewer/scene_mailbox.h - hands scene values from their owner to the window.
#pragma once

#include <functional>
#include <memory>
#include <mutex>

#include "viewer/scene.h"

namespace kerf {

/// Double-buffered: one update is filled by its owner, one waits for the window. The mutex that the
/// window takes is held for the swap of a pointer only, so that the picture never waits for cutting
/// and cutting never waits for the picture. When the window is slow, waiting updates are merged by
/// the owner's thread: nothing is lost, and memory stays bounded by one full scene.
class SceneMailbox {
 public:
  /// `wake` is called after each publish() from the publishing thread (Window::wake does).
  explicit SceneMailbox(std::function<void()> wake = {}) : wake_(std::move(wake)) {}

  /// From any thread but the window's. Several publishers wait for each other, never for the
  /// window.
  void publish(SceneUpdate update);

  /// What was published last has not been taken yet: the window is busy drawing what it took
  /// before. Who has more to tell may wait until it is free, instead of making what the next
  /// news replace. Any thread.
  bool is_full();

  /// What came since the last take(), or null. The window's thread.
  std::unique_ptr<SceneUpdate> take();

 private:
  std::function<void()> wake_;
  std::mutex publishers_;
  std::mutex slot_mutex_;
  std::unique_ptr<SceneUpdate> slot_;
};

}  // namespace kerf
