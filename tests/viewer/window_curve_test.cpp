// The curve below the time slider.
#include <cmath>
#include <optional>
#include <vector>

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

TEST_F(WindowCurveTest, LoadsComeAfterFeedsWhereTheyAreMeasured) {
  open();
  SceneUpdate update;
  auto timeline = std::make_shared<ProgramTimeline>();
  timeline->duration_s = kDuration_s;
  timeline->has_curves = timeline->has_loads = timeline->has_forces = true;
  update.timeline = timeline;
  auto curves = std::make_shared<ProgramCurves>();
  curves->step_s = kDuration_s / 500;
  curves->known_until_s = kDuration_s;
  curves->mm3_per_s.assign(500, 1.0f);
  curves->feed_mm_per_min.assign(500, 600.0f);
  curves->color.assign(500, 0xff3c3cf0u);
  SceneLoadCurve& power = curves->loads[static_cast<std::size_t>(CutLoadKind::kPower)];
  power.nominal.assign(500, 1.0f);
  power.nominal[250] = 90.0f;  // for a moment
  power.high.assign(500, 1.5f);
  power.high[250] = 95.0f;
  power.limit = 1.2;
  update.curves = curves;
  mailbox_.publish(std::move(update));
  ASSERT_TRUE(turn_until([&] { return pixels(kStrip) > 1000; }));
  constexpr Rgb kLimit{235, 165, 50}, kPeak{240, 90, 110};
  const auto has = [&](const Rgb& color) {
    return count_pixels(window_->read(), kStrip, color) > 0;
  };
  EXPECT_FALSE(has(kLimit)) << "the rate has none";
  for (int presses = 0; presses < 6;
       ++presses) {  // feed, per tooth, engagement, chip, force, torque
    key("y");
    settle();
  }
  EXPECT_EQ(pixels(kStrip), 0) << "nothing is known of torques";
  key("y");
  ASSERT_TRUE(turn_until([&] { return pixels(kStrip) > 1000; })) << "the peak has not flattened it";
  EXPECT_TRUE(has(kLimit));
  EXPECT_TRUE(has(kPeak));
}

/// Colours that need a material are offered where there is one, and by the key in the same order.
TEST_F(WindowCurveTest, ColoursOfLoadsAreOfferedWithTheirCurves) {
  open_with_curve();
  const auto modes_of_key = [&] {
    std::vector<ColorBy> modes;
    for (int presses = 0; presses < 14; ++presses) {
      commands_.take();
      key("v");
      settle();
      const std::optional<ColorCommand> command = next<ColorCommand>();
      if (!command) break;
      modes.push_back(command->mode);
      if (command->mode == ColorBy::kPlain) break;
    }
    return modes;
  };
  EXPECT_EQ(modes_of_key(),
            (std::vector{ColorBy::kHeight, ColorBy::kTool, ColorBy::kRemovalRate, ColorBy::kFeed,
                         ColorBy::kFeedPerTooth, ColorBy::kLineRange, ColorBy::kPlain}));
  SceneUpdate update;
  auto timeline = std::make_shared<ProgramTimeline>();
  timeline->duration_s = kDuration_s;
  timeline->has_curves = timeline->has_loads = true;
  update.timeline = timeline;
  mailbox_.publish(std::move(update));
  settle();
  EXPECT_EQ(modes_of_key(), (std::vector{ColorBy::kHeight, ColorBy::kTool, ColorBy::kRemovalRate,
                                         ColorBy::kFeed, ColorBy::kFeedPerTooth, ColorBy::kAngle,
                                         ColorBy::kChip, ColorBy::kLineRange, ColorBy::kPlain}));
}

/// Whichever tab is open; and with plain colours it is gone.
TEST_F(WindowCurveTest, WhatColoursMeanStandsInThePicture) {
  open_with_curve();
  key("v"), key("v");
  settle();
  ASSERT_EQ(window_->settings().drawing.color_by, ColorBy::kTool);
  constexpr Rgb kOfTool{10, 200, 30};
  constexpr PixelBox kCorner{290, 560, 500, 684};
  EXPECT_EQ(count_pixels(window_->read(), kCorner, kOfTool), 0);
  SceneUpdate update;
  CutColors colors;
  colors.mode = ColorBy::kTool;
  colors.is_of_path = true;
  colors.of_move = {0xff808080};
  colors.legend = {{0x001ec80a, "T1 flat 10"}, {0x001ec80a, "T2 ball 6"}};
  update.colors = std::make_shared<const CutColors>(std::move(colors));
  mailbox_.publish(std::move(update));
  EXPECT_TRUE(turn_until([&] { return count_pixels(window_->read(), kCorner, kOfTool) > 300; }))
      << "two swatches";
  for (int presses = 0; presses < 14; ++presses) {
    if (window_->settings().drawing.color_by == ColorBy::kPlain) break;
    key("v");
    settle();
  }
  EXPECT_EQ(count_pixels(window_->read(), kCorner, kOfTool), 0);
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
