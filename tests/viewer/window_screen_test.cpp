// What is on the screen: the window draws and sends only the rectangles that changed, and nobody
// may see it.

#include <gtest/gtest.h>

#include <array>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "tests/viewer/window_fixture.h"

namespace kerf {
namespace {

constexpr int kCells_x = 200, kCells_y = 180;

/// The upper left part of the screen of a server with -fbdir, which keeps it in a file as xwd
/// writes it: a header of words with the high byte first, colours, rows of 32-bit pixels.
Picture screen_of(const std::string& folder, int width_px, int height_px) {
  std::ifstream file(folder + "/Xvfb_screen0", std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(file), {}};
  const auto byte = [&bytes](std::size_t at) { return static_cast<unsigned char>(bytes.at(at)); };
  const auto word = [&byte](std::size_t index) {
    std::size_t value = 0;
    for (std::size_t k = 4 * index; k < 4 * index + 4; ++k) value = value << 8 | byte(k);
    return value;
  };
  constexpr std::size_t kHeaderSize = 0, kBytesPerRow = 12, kColors = 19, kColorBytes = 12;
  const std::size_t pixels = word(kHeaderSize) + word(kColors) * kColorBytes;
  Picture picture{width_px, height_px, {}};
  for (std::size_t y = 0; y < static_cast<std::size_t>(height_px); ++y) {
    for (std::size_t x = 0; x < static_cast<std::size_t>(width_px); ++x) {
      const std::size_t at = pixels + y * word(kBytesPerRow) + 4 * x;
      for (const std::size_t channel : {2u, 1u, 0u}) picture.rgb.push_back(byte(at + channel));
    }
  }
  return picture;
}

class WindowScreenTest : public WindowTest {
 protected:
  void SetUp() override {
    WindowTest::SetUp();
    if (IsSkipped()) return;
    Result<VirtualDisplay> display = VirtualDisplay::start({"-fbdir", folder_.path(), "-nocursor"});
    ASSERT_TRUE(display) << display.error();
    display_.emplace(std::move(*display));
    open();
  }

  void TearDown() override {
    window_.reset();  // before its display
  }

  void play(int step) {
    workpiece_.dent(40.0 + 11.0 * step, 60.0 + 5.0 * step, 10.0, 4.0);
    Moment moment = test_moment();
    moment.time_s = 60.0 + 7.9 * step;
    moment.line = 40 + 9 * step;
    moment.past_vertices = 9 + static_cast<std::uint64_t>(step);
    moment.feed_mm_per_min = 900 + 333 * step;
    moment.tool_pose = ToolPose{Vec3(40.0 + 11.0 * step, 60.0 + 5.0 * step, -4.0)};
    moment.axes[0].work = 40.0 + 11.0 * step;
    SceneUpdate update;
    update.patches = workpiece_.take_patches();
    update.moment = std::make_shared<const Moment>(moment);
    mailbox_.publish(std::move(update));
  }

  void expect_screen_is_window(int step) {
    const Picture window = window_->read();
    const Picture screen = screen_of(folder_.path(), kWidth, kHeight);
    EXPECT_EQ(mean_difference(window, screen, kWhole), 0.0) << step;
  }

  TemporaryFolder folder_;
  std::optional<VirtualDisplay> display_;
  TestWorkpiece workpiece_{kCells_x, kCells_y};
};

TEST_F(WindowScreenTest, EveryChangeReachesTheScreen) {
  expect_screen_is_window(-1);
  Picture before = window_->read();
  for (int step = 0; step < 8; ++step) {
    play(step);
    settle();
    EXPECT_GT(mean_difference(before, window_->read(), kWhole), 0.0) << step;
    before = window_->read();
    expect_screen_is_window(step);
  }
}

TEST_F(WindowScreenTest, TipsOverThePictureComeAndGo) {
  const Picture before = window_->read();
  move_to(330, 18);  // a button of the toolbar; its tip reaches into the picture
  settle();
  EXPECT_GT(mean_difference(before, window_->read(), kScene), 0.0);
  expect_screen_is_window(0);
  play(1);  // below the tip
  settle();
  expect_screen_is_window(1);
  move_to(320, 60);
  settle();
  expect_screen_is_window(2);
}

/// The content of a window is kept by the driver in buffers of the window's size, which it asks for
/// when it likes.
TEST_F(WindowScreenTest, AResizedWindowShowsWhatAFreshOneOfThatSizeDoes) {
  struct Size {
    int width, height;
  };
  constexpr std::array<Size, 10> kSizes{{{900, 600},
                                         {1300, 900},
                                         {700, 500},
                                         {1100, 950},
                                         {1500, 600},
                                         {1281, 801},
                                         {640, 990},
                                         {1600, 1000},
                                         {333, 444},
                                         {1280, 800}}};
  // The program's first line, to which every height scrolls alike.
  Moment at_start = test_moment();
  at_start.line = 1;
  publish(at_start);
  settle();
  std::vector<Picture> resized;
  for (const Size& size : kSizes) {
    ASSERT_TRUE(xdotool("search --onlyvisible --name kerf windowsize " +
                        std::to_string(size.width) + " " + std::to_string(size.height) +
                        " >/dev/null"));
    ASSERT_TRUE(turn_until([&] {
      const Picture picture = window_->read();
      return picture.width_px == size.width && picture.height_px == size.height;
    }));
    settle();
    resized.push_back(screen_of(folder_.path(), size.width, size.height));
  }
  for (std::size_t i = 0; i < kSizes.size(); ++i) {
    const auto [width, height] = kSizes[i];
    window_.reset();
    WindowOptions options;
    options.width_px = width;
    options.height_px = height;
    open(options);
    publish(at_start);
    settle();
    const Picture fresh = screen_of(folder_.path(), width, height);
    EXPECT_EQ(mean_difference(fresh, resized[i], {0, 0, width, height}), 0.0)
        << width << " x " << height;
  }
}

TEST_F(WindowScreenTest, ChangedRectanglesGiveTheSamePixelsAsAllOfTheWindow) {
  for (int step = 0; step < 8; ++step) {
    play(step);
    settle();
  }
  const Picture in_parts = window_->read();
  for (const auto& size : {std::pair{1270, 790}, std::pair{kWidth, kHeight}}) {
    const int width = size.first, height = size.second;
    ASSERT_TRUE(xdotool("search --onlyvisible --name kerf windowsize " + std::to_string(width) +
                        " " + std::to_string(height) + " >/dev/null"));
    ASSERT_TRUE(turn_until([&] { return window_->read().width_px == width; }));
    settle();
  }
  EXPECT_EQ(mean_difference(in_parts, window_->read(), kWhole), 0.0);
}

}  // namespace
}  // namespace kerf
