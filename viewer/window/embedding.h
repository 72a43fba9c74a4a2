// viewer/window/embedding.h - kerf's window inside another program's. For window.cpp and
// window_frame.cpp only.
#pragma once

#include <cstdint>
#include <memory>

#include "base/result.h"

struct GLFWwindow;

namespace kerf {

/// The window lies over all of `around` and goes with it. It asks for no keys: what is typed while
/// the mouse is over it goes to the program around it, as if kerf was not there: ESC stops
/// LinuxCNC. It takes no focus.
class Embedding {
 public:
  /// Of a window that has not been shown yet; shows it. Error: GLFW does not speak X11 here, or
  /// there is no such window.
  static Result<Embedding> into(std::uint32_t around, GLFWwindow* window);
  Embedding(Embedding&&) noexcept;
  Embedding& operator=(Embedding&&) noexcept;
  ~Embedding();

  /// Once a turn: takes on the size. Some 50 us.
  void follow();
  /// Nobody can see it: another tab is shown.
  bool is_covered() const;

 private:
  struct Impl;
  explicit Embedding(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace kerf
