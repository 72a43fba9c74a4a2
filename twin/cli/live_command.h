// twin/cli/live_command.h - `kerf shadow` and `kerf replay`.
#pragma once

#include <functional>
#include <optional>
#include <stop_token>
#include <string>

#include "twin/cli/live_options.h"
#include "twin/serve/served_scene.h"
#include "viewer/scene_mailbox.h"
#include "viewer/viewer_command.h"

namespace kerf {

/// Opens the source, watches it until it ends or somebody stops, writes what was asked for. Returns
/// the exit code.
int live_command(const Arguments& arguments);

struct ShownLog {
  Diagnostics diagnostics;            ///< with an error: nothing of it was shown
  std::optional<std::string> opened;  ///< what the user wants to see instead; none: it was closed
};

/// Replays a log in a window that is there already, until it is closed or something else is opened.
/// `on_start` is called before the window is told anything. `served`: pages show it, too; may be
/// null.
ShownLog show_log(const Arguments& arguments, SceneMailbox& mailbox, CommandQueue& commands,
                  std::stop_source& stop, ServedScene* served, std::function<void()> on_start);

}  // namespace kerf
