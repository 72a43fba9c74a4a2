// Gaps, jumps, restarts and wild readings of a source.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/twin/live/cutter_shop.h"

namespace kerf {
namespace {

TEST(SourceWatch, GapsAreMarkedCutOrIgnored) {
  struct Case {
    GapPolicy policy;
    bool cut;
    std::size_t findings;
  };
  for (const Case& c : {Case{GapPolicy::kMark, false, 1}, Case{GapPolicy::kCut, true, 1},
                        Case{GapPolicy::kIgnore, false, 0}}) {
    LiveCutOptions options;
    options.gap = c.policy;
    Watch watch(options);
    watch.see({10, 20, -1}, 0);
    watch.see({10.01, 20, -1}, 0.7);  // too little to speak of
    const double before = watch.removed_mm3();
    watch.see({30, 20, -1}, 1.3, 2);
    EXPECT_EQ(watch.removed_mm3() > before + 1, c.cut);
    ASSERT_EQ(watch.log().kept().size(), c.findings);
    EXPECT_EQ(watch.cutter().facts().gaps, 1U);
    if (c.findings == 0) continue;
    EXPECT_EQ(watch.log().kept()[0].id, FindingId::kSourceGap);
    const std::string& text = watch.log().kept()[0].text;
    EXPECT_EQ(text.substr(0, 60), "no positions for 0.600 s, the machine is 19.99 mm further on");
    EXPECT_NE(text.find("the tool was changed meanwhile, from 1 to 2"), text.npos) << text;
  }
}

TEST(SourceWatch, AControllerThatIsStartedAgainWhileNothingRanHasLostNothing) {
  for (const ProgramState before : {ProgramState::kIdle, ProgramState::kRunning}) {
    const bool ran = before == ProgramState::kRunning;
    Watch watch;
    const auto see = [&](const Vec3& tip, double t_s, ProgramState program, bool restarted) {
      AxisSample sample;
      for (int i = 0; i < 3; ++i) sample.set(static_cast<std::size_t>(i), tip[i]);
      sample.tool = 1;
      sample.program = program;
      sample.restarted = restarted;
      watch.cutter().take(sample, t_s, false);
    };
    see({10, 20, -1}, 0, before, false);
    see({10, 20, -1}, 0.01, before, false);
    const double removed = watch.removed_mm3();
    // Through the workpiece, if it were a way.
    see({30, 20, -1}, 9, ProgramState::kIdle, true);
    see({30, 20, -1}, 9.01, ProgramState::kIdle, false);
    EXPECT_EQ(watch.removed_mm3(), removed);
    ASSERT_EQ(watch.ids(), std::vector<FindingId>{FindingId::kSourceRestarted});
    const Finding& told = watch.log().kept()[0];
    EXPECT_EQ(told.severity, ran ? Severity::kWarning : Severity::kNote);
    EXPECT_EQ(told.text.substr(0, ran ? 54 : 52),
              ran ? "the controller ended in the middle of the program and "
                  : "the controller ended and was started again, 9.0 s wi");
    EXPECT_EQ(watch.cutter().facts().gaps, ran ? 1U : 0U);
  }
}

TEST(SourceWatch, LostSamplesAndImpossibleJumpsAreGapsToo) {
  LiveCutOptions options;
  options.most_mm_per_s = 100;
  Watch watch(options);
  watch.see({10, 20, -1}, 0);
  watch.see({11, 20, -1}, 0.01);  // 100 mm/s
  EXPECT_TRUE(watch.ids().empty());
  watch.see({21, 20, -1}, 0.02);  // 1000 mm/s
  ASSERT_EQ(watch.ids().size(), 1U);
  EXPECT_EQ(watch.log().kept()[0].text.substr(0, 45),
            "positions jump by 10.00 mm within 0.010 s, fa");
  EXPECT_EQ(watch.log().kept()[0].severity, Severity::kWarning);
  watch.see({21.5, 20, -1}, 0.03, 1, true);
  EXPECT_EQ(watch.ids().size(), 1U) << "one sample in a quick row is no gap";
  watch.see({22.5, 20, -1}, 0.14, 1, true);
  EXPECT_EQ(watch.ids().size(), 2U);
  // A machine that keeps its speed is only faster than was said: it is cut after the first jump.
  const double before = watch.removed_mm3();
  for (int i = 0; i < 5; ++i) watch.see({22.5 - 12.0 * i, 24, -1}, 0.15 + 0.01 * i);
  EXPECT_EQ(watch.ids().size(), 3U);
  EXPECT_GT(watch.removed_mm3(), before + 20);
}

TEST(SourceWatch, AWildSampleIsToldAndNotCut) {
  double sound_mm3 = 0;
  for (const int wild : {0, 1, 2}) {
    LiveCutOptions options;
    options.most.per_s2 = 5000;
    Watch watch(options);
    for (int i = 0; i < 100; ++i) {
      const bool is_wild = wild > 0 && i >= 50 && i < 50 + wild;
      watch.see({5 + 0.1 * i, is_wild ? 39.0 : 5.0, -1}, 0.01 * i);
    }
    watch.cutter().finish();
    EXPECT_EQ(watch.cutter().facts().samples, 100U);
    EXPECT_EQ(watch.cutter().facts().wild, static_cast<std::uint64_t>(wild));
    if (wild == 0) {
      sound_mm3 = watch.removed_mm3();
      EXPECT_TRUE(watch.ids().empty());
      continue;
    }
    EXPECT_NEAR(watch.removed_mm3(), sound_mm3, 1e-6);
    ASSERT_EQ(watch.ids(), std::vector<FindingId>{FindingId::kSourceGap});
    EXPECT_EQ(watch.log().kept()[0].text.substr(0, 29), "Y reads 39 mm, 34.00 mm away ");
  }
}

TEST(SourceWatch, WhatWasHeldUpAndComesInABurstIsNoJump) {
  LiveCutOptions options;
  options.most_mm_per_s = 60;
  Watch watch(options);
  // 60 mm/s. For 48 ms the thread of the machine stands, then it catches up.
  double x = 10;
  for (int i = 0; i < 10; ++i) watch.see({x += 0.3, 20, -1}, 0.005 * i);
  for (int i = 10; i < 19; ++i) watch.see({x, 20, -1}, 0.005 * i);
  watch.see({x += 2.9, 20, -1}, 0.0951);
  // The same of who reads it: stamped, held up, read, and stamped again at once.
  watch.see({x += 1.7, 20, -1}, 0.1);
  watch.see({x += 1.2, 20, -1}, 0.1);
  EXPECT_TRUE(watch.ids().empty());
  EXPECT_EQ(watch.cutter().facts().gaps, 0U);
  watch.see({x += 4.7, 20, -1}, 0.101);  // 51 ms times 60 mm/s times 1.5 are 4.59 mm
  EXPECT_EQ(watch.ids(), std::vector<FindingId>{FindingId::kSourceGap});
}

TEST(SourceWatch, AJumpFarFromTheWorkpieceIsHomingAndOnlyANote) {
  LiveCutOptions options;
  options.most_mm_per_s = 100;
  Watch watch(options);
  watch.see({0, 0, 50}, 0, 0);
  watch.see({0, 0, 75.4}, 0.001, 0);
  watch.see({-5, -5, 75.4}, 0.1, 0);  // in the air, with nothing in the spindle
  ASSERT_EQ(watch.ids(), std::vector<FindingId>{FindingId::kSourceGap});
  EXPECT_EQ(watch.log().kept()[0].severity, Severity::kNote);
  EXPECT_EQ(watch.cutter().facts().jumps, 1U);
  EXPECT_EQ(watch.cutter().facts().gaps, 0U);
}

}  // namespace
}  // namespace kerf
