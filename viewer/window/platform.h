// viewer/window/platform.h - GLFW, and what it says when there is no display or an old OpenGL. For
// the sources of viewer/ only.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "base/result.h"
#include "viewer/window/screen_rect.h"

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
  /// `needs_x11`: no other window system will do.
  Done start(bool needs_x11 = false);
  /// A window with a current OpenGL 3.3 core context, at most as large as the largest screen; sizes
  /// are for a display of ordinary resolution, and grow with that of the screen. Error: the OpenGL
  /// that is there, and the one that is needed.
  /// `is_inside`: it is to be put into another program's window, and is not shown before.
  Result<GLFWwindow*> open_window(int width_px, int height_px, const char* title,
                                  bool is_inside = false);

  /// show() of a few rectangles is worth it: this OpenGL is a software renderer, for which sending
  /// a whole window is a good part of a frame, and it can send less.
  bool can_show_parts() const { return parts_ != nullptr; }
  /// To be called before the first picture of another size is drawn: Mesa looks at the window's
  /// size when buffers are swapped, not when a part of them is copied, and would draw into those of
  /// the old size for ever. Shows what was there once more.
  void take_new_size(GLFWwindow* window) const;
  /// Brings the rectangles of the back buffer to the screen; all of it unless can_show_parts().
  void show(GLFWwindow* window, const std::vector<ScreenRect>& rects) const;

  /// Error: the connection to the display broke. Nothing can be drawn any more then. (A reset of
  /// the graphics card shows when something is drawn: see gl_failure.h.)
  Done check() const;
  /// The connection to the display broke: GLFW must not be called any more.
  static bool is_lost();
  /// Another program has destroyed the window, as `xdotool windowclose` does: it has no size and
  /// cannot be drawn into. Asks the X server, about 50 us.
  static bool is_gone(GLFWwindow* window);
  /// Neither of the two. What GLFW said of the window's size just before is to be believed only
  /// then: it asks the X server, and does not look whether an answer came.
  static bool is_there(GLFWwindow* window) { return !is_gone(window) && !is_lost(); }

  /// What failed for want of a window does not end the program: to be said again after GLFW was
  /// asked for what makes it set Xlib's own way of failing.
  static void survive_destroyed(GLFWwindow* window);

  /// Ends the waiting for events. From any thread, at any time.
  static void wake();

 private:
  /// Of Xlib and GLX, which no other part of the window knows.
  struct Parts;

  void find_parts(GLFWwindow* window);

  bool is_started_ = false;
  std::shared_ptr<const Parts> parts_;  // null: only the whole window can be shown
};

}  // namespace kerf
