#include "viewer/window/scene_pace.h"

#include <gtest/gtest.h>

namespace kerf {
namespace {

using std::chrono::milliseconds;

class ScenePaceTest : public testing::Test {
 protected:
  /// A frame later, for an eye that has moved on.
  int turned() {
    ++eye_.clip_from_world[3][0];
    return still();
  }
  /// A frame later, for the same eye.
  int still(int after_ms = 16) {
    now_ += milliseconds(after_ms);
    return pace_.divisor(eye_, now_);
  }

  ScenePace pace_;
  Projection eye_;
  ScenePace::Clock::time_point now_{};
};

TEST_F(ScenePaceTest, AFastCardDrawsAllPixelsAlways) {
  for (int i = 0; i < 20; ++i) {
    EXPECT_EQ(turned(), 1);
    pace_.took(ScenePace::kSlow_ms - 1);
    EXPECT_FALSE(pace_.has_waiting());
  }
}

TEST_F(ScenePaceTest, ASlowOneDrawsFewerWhileTheEyeMovesAndAllWhenItStands) {
  EXPECT_EQ(still(), 1);
  pace_.took(100);
  EXPECT_EQ(still(), 1) << "it has not moved";
  EXPECT_EQ(turned(), 2);
  pace_.took(50);
  EXPECT_EQ(turned(), 4);
  pace_.took(30);
  EXPECT_EQ(turned(), 4) << "the coarsest";
  EXPECT_TRUE(pace_.has_waiting());
  EXPECT_EQ(still(ScenePace::kStill_ms - 1), 4);
  EXPECT_TRUE(pace_.has_waiting());
  EXPECT_EQ(still(1), 1);
  EXPECT_FALSE(pace_.has_waiting());
  pace_.took(100);
  EXPECT_EQ(turned(), 4) << "what the full one took changes nothing for an eye that moves";
}

/// Whatever the time of a picture is made of, pixels or triangles.
TEST_F(ScenePaceTest, ComesToRestAtOneDivisor) {
  for (const double of_pixels : {1.0, 0.7, 0.4, 0.0}) {
    for (double full_ms = 2; full_ms < 1000; full_ms *= 1.3) {
      pace_ = {};
      const auto turn = [&] {
        const int divisor = turned();
        pace_.took(full_ms * (of_pixels / (divisor * divisor) + 1 - of_pixels));
        return divisor;
      };
      for (int i = 0; i < 5; ++i) turn();
      const int rest = turn();
      for (int i = 0; i < 5; ++i) EXPECT_EQ(turn(), rest) << full_ms << ' ' << of_pixels;
    }
  }
}

TEST_F(ScenePaceTest, WhereFewerPixelsDoNotHelpThereIsNoThirdOfThem) {
  EXPECT_EQ(still(), 1);
  pace_.took(60);
  EXPECT_EQ(turned(), 2);
  pace_.took(58);
  EXPECT_EQ(turned(), 2);
}

TEST_F(ScenePaceTest, FasterAgainItDrawsMoreAgain) {
  turned();
  pace_.took(60);
  EXPECT_EQ(turned(), 2);
  pace_.took(ScenePace::kQuick_ms - 1);
  EXPECT_EQ(turned(), 1);
}

TEST_F(ScenePaceTest, AnotherSizeIsNoMove) {
  turned();
  pace_.took(60);
  eye_.size_px = {10, 10};
  EXPECT_EQ(still(), 1);
}

}  // namespace
}  // namespace kerf
