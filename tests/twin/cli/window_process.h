// tests/twin/cli/window_process.h - kerf with a window on a virtual display, and hands to use it.
#pragma once

#include <functional>
#include <string>

#include "tests/twin/cli/kerf_process.h"
#include "tests/viewer/png_reader.h"
#include "viewer/picture.h"

namespace kerf {

/// The display that all tests of a program share. Empty: there is one, and DISPLAY names it; else
/// which Debian package is missing.
const std::string& display_trouble();

/// Pixels that differ by more than 8 of 255 in a channel; all of them if the sizes differ.
std::size_t different_pixels(const Picture& a, const Picture& b);

/// A kerf that opens a window, in a folder of its own: where it keeps its settings and where its
/// screenshots go.
class WindowedKerf {
 public:
  /// `settings` is what its settings file says.
  explicit WindowedKerf(KerfCall call, const std::string& settings = {});

  /// The window is on the screen and draws: it takes a picture of itself when asked to.
  bool opens();
  /// Its title begins so; false after half a minute.
  bool is_titled(const std::string& begin) const;
  /// As xdotool names them: "space", "Q".
  void key(const std::string& name) const;
  /// The mouse there, from the window's upper left corner: 1 is its left button, 3 the right one.
  void click(int x_px, int y_px, int button = 1) const;
  /// A row of the menu that the right button opens there, until a picture (by "S") satisfies: a
  /// menu that is not drawn yet takes no click. False after two minutes.
  bool choose(int x_px, int y_px, int row_x_px, int row_y_px,
              const std::function<bool(const Picture&)>& wanted);
  /// One character after the other.
  void type(const std::string& text) const;
  /// By the dialog that asks for a name: typed when it is there, else its letters would be keys of
  /// the window.
  void open_file(const std::string& path) const;
  /// The picture in the window, by its own key; or what another key of it saves: "S" is the whole
  /// window.
  Picture screenshot(const std::string& by_key = "s");
  /// Takes pictures (screenshot()) until one satisfies; false after a minute.
  bool shows(const std::function<bool(const Picture&)>& wanted, const std::string& by_key = "s");
  /// The picture when nothing in it moves any more.
  Picture settled();
  bool changes_from(const Picture& before, std::size_t pixels = 300);
  void send(int signal) const { kerf_.send(signal); }
  const RunningKerf& process() const { return kerf_; }
  /// Where it keeps its settings; its screenshots go there, too.
  const std::string& home() const { return home_.path(); }
  /// It does nothing any more.
  bool has_ended() const { return !kerf_.catches_interrupts(); }
  /// Waits half a minute for its end.
  bool waits_for_end() const;
  /// Waits, and kills it if it goes on.
  KerfResult finish();

 private:
  TestFolder home_;
  RunningKerf kerf_;
};

}  // namespace kerf
