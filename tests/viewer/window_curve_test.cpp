// The curve below the time slider.
#include <cmath>

#include "tests/viewer/window_fixture.h"

namespace kerf {
namespace {

constexpr Rgb kTool{240, 60, 60};

class WindowCurveTest : public WindowTest {
 protected:
  /// 100 columns over the program's time: nothing, then a rate of 10, then of 20 mm3/s.
  void open_with_curve() {
    open();
    SceneUpdate update;
    auto timeline = std::make_shared<ProgramTimeline>();
    timeline->duration_s = kDuration_s;
    timeline->has_curves = true;
    update.timeline = timeline;
    auto curves = std::make_shared<ProgramCurves>();
    curves->step_s = kDuration_s / 100;
    curves->known_until_s = kDuration_s;
    for (int i = 0; i < 100; ++i) {
      curves->mm3_per_s.push_back(i < 50 ? 0.0f : i < 75 ? 10.0f : 20.0f);
      curves->feed_mm_per_min.push_back(600.0f);
      curves->color.push_back(0xff3c3cf0u);
    }
    update.curves = curves;
    mailbox_.publish(std::move(update));
    ASSERT_TRUE(turn_until([&] { return pixels(kStrip) > 1000; }));
    settle();
  }
  int pixels(const PixelBox& box) { return count_pixels(window_->read(), box, kTool); }

  static constexpr double kDuration_s = 400;
  /// Between the slider, which has moved up, and the buttons.
  static constexpr PixelBox kStrip{0, 712, kWidth, 745};
  static constexpr PixelBox kFirstHalf{0, 712, 630, 745};
};

TEST_F(WindowCurveTest, StandsBelowTheTimeAndGoesThereWhenItIsClicked) {
  open_with_curve();
  EXPECT_EQ(pixels(kFirstHalf), 0) << "nothing is removed there";
  const int third = pixels({645, 712, 945, 745}), last = pixels({960, 712, 1260, 745});
  EXPECT_NEAR(static_cast<double>(last) / third, 2, 0.15);
  commands_.take();
  click(960, 735);
  const std::optional<SeekTimeCommand> seek = next<SeekTimeCommand>();
  ASSERT_TRUE(seek);
  EXPECT_NEAR(seek->time_s, 0.75 * kDuration_s, 4);
}

TEST_F(WindowCurveTest, IsChosenWithAKeyAndTakesNoRoomWhereThereIsNone) {
  open_with_curve();
  key("y");  // feed
  ASSERT_TRUE(turn_until([&] { return pixels(kFirstHalf) > 1000; }));
  const Picture feed = window_->read();
  key("y");  // feed per tooth: no tool says how many teeth it has
  ASSERT_TRUE(turn_until([&] { return pixels(kStrip) == 0; }));
  key("y");
  ASSERT_TRUE(turn_until_changed(feed, kScene));
  settle();
  const Picture none = window_->read();
  key("y");
  ASSERT_TRUE(turn_until([&] { return pixels(kStrip) > 1000; }));
  settle();
  EXPECT_GT(mean_difference(none, window_->read(), {0, 690, kWidth, 745}), 1.0);
}

TEST_F(WindowCurveTest, BesideAMachineThereIsNone) {
  open();
  settle();
  const Picture before = window_->read();
  key("y");
  settle();
  EXPECT_EQ(mean_difference(before, window_->read(), kWhole), 0.0);
}

}  // namespace
}  // namespace kerf
