#include "interp_bridge/motion_kinds.h"

#include <gtest/gtest.h>

namespace kerf {
namespace {

Motion of(MotionKind kind, bool rapid = false) {
  Motion motion;
  motion.kind = kind;
  motion.rapid = rapid;
  return motion;
}

TEST(MotionKinds, AMoveIsATraverseAFeedOrAProbeAndNoTwoOfThem) {
  for (int kind = 0; kind <= static_cast<int>(MotionKind::kSignal); ++kind) {
    for (const bool rapid : {false, true}) {
      const Motion m = of(static_cast<MotionKind>(kind), rapid);
      const int kinds = is_traverse(m) + is_feed(m) + (m.kind == MotionKind::kProbe);
      EXPECT_EQ(kinds, is_move(m) ? 1 : 0) << kind;
    }
  }
}

TEST(MotionKinds, EachIsWhatItsKindSays) {
  EXPECT_TRUE(is_traverse(of(MotionKind::kTraverse)));
  EXPECT_TRUE(is_feed(of(MotionKind::kFeed)));
  EXPECT_TRUE(is_feed(of(MotionKind::kThread)));
  EXPECT_TRUE(is_feed(of(MotionKind::kArc)));
  EXPECT_TRUE(is_traverse(of(MotionKind::kArc, true)));
  EXPECT_TRUE(is_move(of(MotionKind::kProbe)));
  for (const MotionKind kind : {MotionKind::kDwell, MotionKind::kToolChange, MotionKind::kStop,
                                MotionKind::kProgramEnd, MotionKind::kSignal}) {
    EXPECT_FALSE(is_move(of(kind)));
  }
}

}  // namespace
}  // namespace kerf
