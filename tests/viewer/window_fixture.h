// tests/viewer/window_fixture.h - a window on a virtual display, with a scene in it, and hands.
#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <functional>
#include <glm/vec2.hpp>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "tests/base/temporary_folder.h"
#include "tests/viewer/test_scene.h"
#include "tests/viewer/virtual_display.h"
#include "viewer/window/window.h"

namespace kerf {

struct Rgb {
  int r, g, b;
};

/// Half-open, from the upper left corner.
struct PixelBox {
  int left, top, right, bottom;
};

/// Number of pixels of this colour, which may be off by 3 in each channel.
int count_pixels(const Picture& picture, const PixelBox& box, Rgb color);
/// The first of them, row by row.
std::optional<glm::ivec2> find_pixel(const Picture& picture, const PixelBox& box, Rgb color);
/// Of channels, in the box; -1 if the pictures are of different size.
double mean_difference(const Picture& a, const Picture& b, const PixelBox& box);

Moment test_moment();
/// A main program of 500 lines and a subroutine of 50.
std::shared_ptr<const ProgramText> test_program();

/// All wait for what they expect by turning the window, and give up after a minute.
class WindowTest : public testing::Test {
 protected:
  static constexpr int kWidth = 1280, kHeight = 800;
  // Where things are at scale 1.
  static constexpr PixelBox kCode{0, 36, 290, 716};
  static constexpr PixelBox kScene{290, 36, 980, 716};
  static constexpr PixelBox kInfo{980, 0, 1280, 716};
  static constexpr PixelBox kWhole{0, 0, kWidth, kHeight};
  static constexpr int kSliderY = 733, kButtonsY = 758;

  void SetUp() override;
  /// With the scene of these tests, drawn and settled. The mouse is over the background.
  void open(WindowOptions options = {});
  int most_frames_per_s_ = 1000;  ///< of the next one that is opened
  void publish(Moment moment);
  /// Turns until nothing is left to be drawn.
  void settle();
  /// Turns until `is_done`; false after a minute.
  bool turn_until(const std::function<bool()>& is_done);
  bool turn_until_changed(const Picture& before, const PixelBox& box);

  void move_to(int x, int y);
  void click(int x, int y, int button = 1);
  void drag(glm::ivec2 from, glm::ivec2 to, int button = 1);
  void key(const std::string& name);

  /// Turns until a command of this kind comes. Others that come before it are dropped.
  template <class Command>
  std::optional<Command> next() {
    std::optional<Command> found;
    turn_until([&] {
      for (const ViewerCommand& command : commands_.take()) {
        if (const auto* match = std::get_if<Command>(&command); match && !found) found = *match;
      }
      return found.has_value();
    });
    return found;
  }

  /// Frames drawn so far.
  std::uint64_t frames() const;

  SceneMailbox mailbox_{Window::wake};
  CommandQueue commands_;
  std::string settings_file_;
  std::optional<Window> window_;
};

}  // namespace kerf
