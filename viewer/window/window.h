// viewer/window/window.h - the window: picture, panels, player.
//
//     SceneMailbox mailbox(Window::wake);                  the owner of the workpiece, on its
//     CommandQueue commands;                               own thread:
//     Result<Window> window =                                for each command of commands.take() ..
//         Window::create({}, &mailbox, &commands);           cut ..
//     window->run();                                         mailbox.publish(update);
//
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "base/result.h"
#include "viewer/picture.h"
#include "viewer/scene_mailbox.h"
#include "viewer/viewer_command.h"
#include "viewer/window/scene_renderer.h"
#include "viewer/window/settings.h"

namespace kerf {

struct WindowOptions {
  std::string settings_file = settings_path();  ///< Empty: nothing is remembered.
  int width_px = 0;                             ///< 0: as remembered; both
  int height_px = 0;
  int max_frames_per_s = 60;
  bool is_local = true;               ///< false: local drawing is off, whatever is remembered
  std::optional<DrawMode> draw_mode;  ///< Instead of the one that is remembered, which stays so.
  std::optional<LengthUnit> units;    ///< As `draw_mode`.
  std::optional<ColorBy> color_by;    ///< As `draw_mode`.
  std::optional<ColorTarget> color_on;
  SectionKind section = SectionKind::kNone;  ///< That the workpiece is first seen in.
  float scale = 0.0f;          ///< Of letters and panels, 1 to 4; 0: that of the display.
  std::string picture_folder;  ///< Where screenshots go; empty: the current folder.
  /// An X11 window of another program, over all of which this one lies; it takes no keys then, and
  /// no focus, and is over when that one goes. `width_px` and `height_px` do not count.
  std::optional<std::uint32_t> embed_in;
};

/// All calls from the main thread, which is the one that GLFW wants; wake() from any. One window at
/// a time. It draws only when something came, moved or is being touched; the rest of the time it
/// sleeps.
class Window {
 public:
  /// Error: no display (the message names it, and --png as the way without one); an OpenGL below
  /// 3.3 (what is there, what is needed). Faulty settings are no error: see settings_faults().
  /// `mailbox` and `commands` must outlive the window.
  static Result<Window> create(const WindowOptions& options, SceneMailbox* mailbox,
                               CommandQueue* commands);
  Window(Window&&) noexcept;
  Window& operator=(Window&&) noexcept;
  /// Remembers the settings.
  ~Window();

  /// Turns until the user closes it; the last command is then a CloseCommand.
  Done run();
  /// One turn: waits for news or input, at most `longest_wait_s`; draws if needed. False after the
  /// window was closed. Error: the display or the graphics card went away while it was open; the
  /// last command is then a CloseCommand, too, and the window does nothing any more.
  Result<bool> frame(double longest_wait_s);
  /// Ends run() as if the user had closed the window. From the window's thread.
  void close();
  /// Makes frame() return from its waiting. From any thread, also when there is no window.
  static void wake();

  /// What is on the screen now, panels included.
  Picture read() const;
  /// Without panels.
  Picture read_scene() const;
  /// The picture of the scene is that of the eye, in all of its pixels; none of fewer pixels, or of
  /// where the eye was before.
  bool is_full() const;
  /// In which draw mode the workpiece in it was drawn.
  DrawMode drawn_mode() const;
  const DrawCounters& counters() const;
  const ViewSettings& settings() const;
  /// What was wrong with the settings file; empty if nothing.
  const Diagnostics& settings_faults() const;

 private:
  class Impl;
  explicit Window(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace kerf
