// The window inside another program's: a tab of LinuxCNC's screen.

#include <dlfcn.h>
#include <gtest/gtest.h>
#include <poll.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <sstream>
#include <string>
#include <utility>

#include "tests/viewer/window_fixture.h"
#include "viewer/window/screen_tab.h"
#include "viewer/window/xlib.h"

namespace kerf {
namespace {

/// What LinuxCNC's screen is: a window of its own connection, which listens to keys.
class Container {
 public:
  Container(unsigned width_px, unsigned height_px) {
    x_ = Xlib::find();
    display_ = x_->open_display(nullptr);
    window_ = x_->create_simple_window(display_, x_->default_root_window(display_), 0, 0, width_px,
                                       height_px, 0, 0, 0);
    x_->select_input(display_, window_, KeyPressMask | SubstructureNotifyMask);
    x_->map_window(display_, window_);
    x_->sync(display_, False);
  }
  ~Container() { x_->close_display(display_); }
  Container(const Container&) = delete;
  Container& operator=(const Container&) = delete;

  std::uint32_t id() const { return static_cast<std::uint32_t>(window_); }
  void resize(unsigned width_px, unsigned height_px) {
    x_->move_resize_window(display_, window_, 0, 0, width_px, height_px);
    x_->sync(display_, False);
  }
  void destroy() {
    x_->destroy_window(display_, window_);
    x_->sync(display_, False);
  }
  /// As a socket of GTK: what lies in it outlives it. And then its program dies without a farewell.
  void die_and_leave(std::uint32_t inside) {
    void* const library = dlopen("libX11.so.6", RTLD_NOW);
    ASSERT_NE(library, nullptr);
    const auto add_to_save_set =
        reinterpret_cast<int (*)(Display*, ::Window)>(dlsym(library, "XAddToSaveSet"));
    ASSERT_NE(add_to_save_set, nullptr);
    add_to_save_set(display_, inside);
    x_->sync(display_, False);
    x_->close_display(std::exchange(display_, x_->open_display(nullptr)));
  }
  /// That have come since it was asked last.
  int keys() {
    int keys = 0;
    x_->sync(display_, False);
    while (x_->pending(display_) > 0) {
      XEvent event;
      x_->next_event(display_, &event);
      if (event.type == KeyPress) ++keys;
    }
    return keys;
  }

 private:
  const Xlib* x_ = nullptr;
  Display* display_ = nullptr;
  ::Window window_ = 0;
};

class WindowTabTest : public WindowTest {
 protected:
  void open_in(std::uint32_t id) {
    WindowOptions options;
    options.embed_in = id;
    open(options);
  }
  void expect_size(int width_px, int height_px) {
    EXPECT_TRUE(turn_until([&] {
      const Picture picture = window_->read();
      return picture.width_px == width_px && picture.height_px == height_px;
    })) << "is "
        << window_->read().width_px << "x" << window_->read().height_px;
  }
};

TEST(WindowId, IsDecimalOrHexadecimal) {
  EXPECT_EQ(window_id_from("48234517"), 48234517U);
  EXPECT_EQ(window_id_from("0x2e00015"), 0x2e00015U);
  EXPECT_EQ(window_id_from("0X2E00015"), 0x2e00015U);
  for (const char* const bad : {"", "0", "0x", "x12", "12x", "-4", " 4", "{XID}", "4294967296",
                                "0x20000000", "2e00015", "1.5"}) {
    EXPECT_FALSE(window_id_from(bad)) << bad;
  }
}

TEST_F(WindowTabTest, LiesOverTheWindowAroundItAndFollowsItsSize) {
  Container screen(900, 600);
  open_in(screen.id());
  expect_size(900, 600);
  screen.resize(700, 480);
  expect_size(700, 480);
}

/// ESC stops a machine: it must reach LinuxCNC's screen, wherever the mouse is.
TEST_F(WindowTabTest, KeysGoToTheProgramAroundIt) {
  Container screen(900, 600);
  open_in(screen.id());
  settle();
  static_cast<void>(screen.keys());
  ASSERT_TRUE(xdotool("mousemove 400 300 click 1 key Escape key F1 key p"));
  int keys = 0;
  EXPECT_TRUE(turn_until([&] { return (keys += screen.keys()) >= 3; })) << keys;
}

/// The keyboard is LinuxCNC's: what is to be written is clicked.
TEST_F(WindowTabTest, ABlankIsWrittenByClicks) {
  Container screen(1280, 800);
  open_in(screen.id());
  expect_size(1280, 800);
  ViewedJob job;
  job.program = "/somewhere/part.ngc";
  job.stock = "box:0,0,-5:10,10,0";
  job.models = {"auto"};
  job.fixtures = {"vise:100:60:30"};
  SceneUpdate update;
  update.job = std::make_shared<const ViewedJob>(job);
  mailbox_.publish(std::move(update));
  settle();
  click(1137, 225);  // the job's tab
  settle();
  const Picture without = window_->read();
  click(1100, 270);  // the blank's field
  settle();
  const Picture with_keys = window_->read();
  EXPECT_GT(mean_difference(without, with_keys, kInfo), 1.0) << "there are keys";
  for (const auto& [x, y] : {std::pair(1094, 431), {1028, 302}, {1259, 302}, {1237, 431}}) {
    click(x, y);  // back, 2, 0, OK
    settle();
  }
  const auto asked = next<JobCommand>();
  ASSERT_TRUE(asked);
  EXPECT_EQ(asked->stock, "box:0,0,-5:10,10,20");
  EXPECT_EQ(asked->fixtures, std::vector<std::string>{"vise:100:60:30"});
  EXPECT_EQ(mean_difference(without, window_->read(), {980, 290, 1280, 470}), 0.0)
      << "the keys are gone";
}

/// AXIS's tab, as wide as it is at first, has no room for the panel beside the picture.
TEST_F(WindowTabTest, WhereItIsNarrowTheInfoPanelComesByAButton) {
  Container screen(400, 470);
  open_in(screen.id());
  expect_size(400, 470);
  settle();
  constexpr PixelBox panel{110, 60, 390, 370};
  const Picture without = window_->read();
  click(25, 16);
  settle();
  const Picture with = window_->read();
  EXPECT_GT(mean_difference(without, with, panel), 50.0) << "dark, in the place of the scene";
  click(25, 16);
  settle();
  EXPECT_LT(mean_difference(without, window_->read(), panel), 1.0);
}

TEST_F(WindowTabTest, EndsWithTheWindowAroundIt) {
  Container screen(900, 600);
  open_in(screen.id());
  settle();
  static_cast<void>(commands_.take());
  screen.destroy();
  bool is_open = true;
  for (int i = 0; i < 1000 && is_open; ++i) {
    const Result<bool> frame = window_->frame(0.01);
    ASSERT_TRUE(frame) << frame.error();
    is_open = *frame;
  }
  EXPECT_FALSE(is_open);
  const auto commands = commands_.take();
  ASSERT_FALSE(commands.empty());
  EXPECT_TRUE(std::holds_alternative<CloseCommand>(commands.back()));
}

TEST_F(WindowTabTest, NoSuchWindowIsSaid) {
  SceneMailbox mailbox;
  WindowOptions options;
  options.settings_file.clear();
  options.embed_in = 0x1234567;
  const Result<Window> window = Window::create(options, &mailbox, &commands_);
  ASSERT_FALSE(window);
  EXPECT_EQ(window.error(), "no window: there is no window 19088743");
  const Result<ScreenTab> tab = ScreenTab::open(0x1234567);
  ASSERT_FALSE(tab);
  EXPECT_NE(tab.error().find("there is no window 19088743 on the display :"), std::string::npos)
      << tab.error();
}

TEST_F(WindowTabTest, WithoutX11ThereIsNoTab) {
  unsetenv("DISPLAY");
  const Result<ScreenTab> tab = ScreenTab::open(std::nullopt);
  ASSERT_FALSE(tab);
  EXPECT_EQ(tab.error(), "there is no X11 display (DISPLAY is not set): no tab");
}

/// The guard's window stays when kerf's crashes, takes on the screen's size, and goes with it.
TEST_F(WindowTabTest, ATabFollowsTheScreenAndGoesWithIt) {
  Container screen(900, 600);
  Result<ScreenTab> tab = ScreenTab::open(screen.id());
  ASSERT_TRUE(tab) << tab.error();
  open_in(tab->id());
  expect_size(900, 600);
  screen.resize(640, 400);
  const auto follows = [&] {
    pollfd news{tab->connection_fd(), POLLIN, 0};
    poll(&news, 1, 10);
    return tab->follow();
  };
  EXPECT_TRUE(turn_until([&] {
    EXPECT_TRUE(follows());
    return window_->read().width_px == 640 && window_->read().height_px == 400;
  }));
  window_.reset();
  EXPECT_TRUE(follows());
  screen.destroy();
  bool is_there = true;
  for (int i = 0; i < 500 && is_there; ++i) is_there = follows();
  EXPECT_FALSE(is_there);
}

TEST_F(WindowTabTest, ATabThatASocketLeavesBehindGoesToo) {
  Container screen(900, 600);
  Result<ScreenTab> tab = ScreenTab::open(screen.id());
  ASSERT_TRUE(tab) << tab.error();
  EXPECT_TRUE(tab->follow());
  screen.die_and_leave(tab->id());
  bool is_there = true;
  for (int i = 0; i < 500 && is_there; ++i) {
    pollfd news{tab->connection_fd(), POLLIN, 0};
    poll(&news, 1, 10);
    is_there = tab->follow();
  }
  EXPECT_FALSE(is_there);
}

}  // namespace
}  // namespace kerf
