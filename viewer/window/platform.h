// viewer/window/platform.h - GLFW, and what it says when there is no display or an old OpenGL. For
// the sources of viewer/ only.
#pragma once

#include <string>

#include "base/result.h"

struct GLFWwindow;

namespace kerf {

/// GLFW is started for as long as this object lives. One at a time, on the main thread.
class Platform {
 public:
  Platform() = default;
  Platform(const Platform&) = delete;
  Platform& operator=(const Platform&) = delete;
  ~Platform();

  /// Error: "no window: cannot open display ':7' (...); pictures need no display: --png FILE".
  Done start();
  /// A window with a current OpenGL 3.3 core context. Error: the OpenGL that is there, and the one
  /// that is needed.
  Result<GLFWwindow*> open_window(int width_px, int height_px, const char* title);

  /// Error: the connection to the display broke, or the graphics card was reset and lost what was
  /// drawn. Nothing can be drawn any more then.
  Done check() const;
  /// The connection to the display broke: GLFW must not be called any more.
  static bool is_lost();

  /// Ends the waiting for events. From any thread, at any time.
  static void wake();

 private:
  bool is_started_ = false;
};

}  // namespace kerf
