// twin/cli/window_host.h - a window on the main thread, the work in another.
#pragma once

#include <functional>
#include <stop_token>
#include <string>

#include "base/result.h"
#include "viewer/scene_mailbox.h"
#include "viewer/viewer_command.h"
#include "viewer/window/window.h"

namespace kerf {

/// A display is there to be tried: X11's or Wayland's variable is set.
bool has_display();

/// Opens a window and runs `work` in a thread until both are over: the window is closed when the
/// work is done, and the work is asked to stop when the user closes the window: by a CloseCommand,
/// and unless there is `on_loss` by `stop`. Returns what `work` returned. Error: there can be no
/// window (the work has not been started then), or the display or OpenGL has failed since. The work
/// was stopped then, unless there is `on_loss`: that gets the reason, the work gets a CloseCommand,
/// and goes on without a window.
Result<int> work_beside_window(const WindowOptions& options, SceneMailbox& mailbox,
                               CommandQueue& commands, std::stop_source& stop,
                               const std::function<int()>& work,
                               const std::function<void(const std::string&)>& on_loss = {});

}  // namespace kerf
