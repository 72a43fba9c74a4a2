// viewer/window/screen_tab.h - kerf's place in another program's window: a tab of LinuxCNC's
// screen.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "base/result.h"

namespace kerf {

/// The id of an X11 window, as it is written: "48234517" or "0x2e00015". Nothing: it is none.
std::optional<std::uint32_t> window_id_from(const std::string& text);

/// An empty window, in which the real one is opened (WindowOptions::embed_in) by a process that may
/// end and come again: some screens close a tab for good when the window in it is destroyed.
/// Takes no keys and no focus. X11 only.
class ScreenTab {
 public:
  /// With `parent` in that window, over all of it. Without one it is shown by who takes it (XEmbed
  /// the other way round: who embeds is told id()). Error: no X11 display, or no such window.
  static Result<ScreenTab> open(std::optional<std::uint32_t> parent);
  ScreenTab(ScreenTab&&) noexcept;
  ScreenTab& operator=(ScreenTab&&) noexcept;
  /// Destroys the window.
  ~ScreenTab();

  std::uint32_t id() const;
  /// To be polled for input; follow() then.
  int connection_fd() const;
  /// Takes on the size of the parent. False: the window is gone, with its parent or with the
  /// display.
  bool follow();
  /// After a fork(), in the child: the connection is the parent's alone.
  void forget();

 private:
  struct Impl;
  explicit ScreenTab(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace kerf
