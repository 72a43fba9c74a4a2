#include "twin/process/turning/thread_checks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "stock/cutter/shape_spec.h"
#include "stock/turning/turning_stock.h"
#include "tests/twin/process/motions.h"

namespace kerf {
namespace {

/// Passes from Z5 to Z-20 with their radius, one after the other.
struct Pass {
  double radius_mm, start_z_mm = 5;
};

std::vector<Finding> threads_told(const char* shape, const TurnedProfile& blank, double lead_mm,
                                  const std::vector<Pass>& passes) {
  const TurningStock stock(*TurnedPart::create(blank));
  FindingLog log;
  ThreadChecks checks(stock, log);
  const Cutter cutter = *parse_shape(shape);
  checks.mount(cutter);
  for (const Pass& pass : passes) {
    Motion m;
    m.kind = MotionKind::kThread;
    m.feed_mm_per_min = lead_mm;
    m.from_mm = {pass.radius_mm, 0, pass.start_z_mm};
    m.to_mm = {pass.radius_mm, 0, -20};
    checks.note(TurnedMove{m, TimedStep{}, cutter, cutter, {}, 1, false});
  }
  checks.end();
  return log.kept();
}

TurnedProfile rod20() { return bar_profile(-60, 0, 20); }

TEST(ThreadChecks, OutsideItIsThePitchTimes6134) {
  // P1.5: 0.9201 mm; a twentieth less is 0.8741.
  const auto told = threads_told("thread:60:1.5", rod20(), 1.5, {{9.6}, {9.3}, {9.13}});
  ASSERT_EQ(told.size(), 1U);
  EXPECT_EQ(told[0].severity, Severity::kWarning);
  EXPECT_EQ(told[0].text,
            "the thread is 0.870 mm deep: a pitch of 1.5 mm and 60 degrees ask for 0.920 mm "
            "(0.6134 P)");
  EXPECT_EQ(threads_told("thread:60:1.5", rod20(), 1.5, {{9.6}, {9.3}, {9.12}}).size(), 0U);
}

TEST(ThreadChecks, InABoreItIsThePitchTimes5413) {
  // P2: 1.0826, less a twentieth 1.0285.
  const TurnedProfile tube = tube_profile(-60, 0, 40, 20);
  EXPECT_EQ(threads_told("thread:60:2:orient=8", tube, 2, {{10.5}, {11.02}}).size(), 1U);
  EXPECT_EQ(threads_told("thread:60:2:orient=8", tube, 2, {{10.5}, {11.03}}).size(), 0U);
}

TEST(ThreadChecks, OtherForms) {
  // Whitworth, P2: 1.2806, less a twentieth 1.2166. Trapezoidal, P4: 2, less a twentieth 1.9.
  EXPECT_EQ(threads_told("thread:55:2", rod20(), 2, {{8.79}}).size(), 1U);
  EXPECT_EQ(threads_told("thread:55:2", rod20(), 2, {{8.78}}).size(), 0U);
  EXPECT_EQ(threads_told("thread:30:4", rod20(), 4, {{8.11}}).size(), 1U);
  EXPECT_EQ(threads_told("thread:30:4", rod20(), 4, {{8.09}}).size(), 0U);
}

TEST(ThreadChecks, TwoStartsHaveHalfThePitch) {
  // A lead of 3 in two starts is a pitch of 1.5; in one start it asks for 1.84 mm.
  EXPECT_EQ(threads_told("thread:60:1.5", rod20(), 3, {{9.1}, {9.1, 6.5}}).size(), 0U);
  EXPECT_EQ(threads_told("thread:60:1.5", rod20(), 3, {{9.1}, {9.1}}).size(), 1U);
  EXPECT_EQ(threads_told("thread:60:1.5", rod20(), 3, {{9.1}, {9.1, 8}}).size(), 1U);
}

TEST(ThreadChecks, APassMayBeginFarInFront) {
  // From Z40 to Z-20: its middle is beside the rod.
  EXPECT_EQ(threads_told("thread:60:1.5", rod20(), 1.5, {{9.13, 40}}).size(), 1U);
  EXPECT_EQ(threads_told("thread:60:1.5", rod20(), 1.5, {{9.12, 40}}).size(), 0U);
  EXPECT_EQ(threads_told("thread:60:1.5", rod20(), 3, {{9.1}, {9.1, 21.5}}).size(), 0U);
}

TEST(ThreadChecks, EachThreadIsOne) {
  // Another lead is another thread.
  const TurningStock stock(*TurnedPart::create(rod20()));
  FindingLog log;
  ThreadChecks checks(stock, log);
  const Cutter cutter = *parse_shape("thread:60:1.5");
  checks.mount(cutter);
  for (const double lead : {1.5, 1.0}) {
    Motion m;
    m.kind = MotionKind::kThread;
    m.feed_mm_per_min = lead;
    m.from_mm = {9.3, 0, 5};
    m.to_mm = {9.3, 0, -20};
    checks.note(TurnedMove{m, TimedStep{}, cutter, cutter, {}, 1, false});
  }
  checks.end();
  EXPECT_EQ(log.kept().size(), 1U);  // 0.7 is enough for 1, and not for 1.5
}

TEST(ThreadChecks, WaysInAndOutAreNoPasses) {
  const TurningStock stock(*TurnedPart::create(rod20()));
  FindingLog log;
  ThreadChecks checks(stock, log);
  const Cutter cutter = *parse_shape("thread:60:1.5");
  checks.mount(cutter);
  const auto pass = [&](Vec3 from, Vec3 to, double lead) {
    Motion m;
    m.kind = MotionKind::kThread;
    m.feed_mm_per_min = lead;
    m.from_mm = from;
    m.to_mm = to;
    checks.note(TurnedMove{m, TimedStep{}, cutter, cutter, {}, 1, false});
  };
  for (const double x : {9.5, 9.08}) {
    pass({x + 1, 0, 3}, {x, 0, 0}, 1.58);
    pass({x, 0, 0}, {x, 0, -20}, 1.5);
    pass({x, 0, -20}, {x + 1, 0, -23}, 1.58);
  }
  checks.end();
  EXPECT_EQ(log.kept().size(), 0U);
}

/// As samples of a machine divide passes, each pass elsewhere.
std::vector<Finding> told_in_pieces(const TurnedProfile& blank, double lead_mm, double slope,
                                    const std::vector<Pass>& passes) {
  const TurningStock stock(*TurnedPart::create(blank));
  FindingLog log;
  ThreadChecks checks(stock, log);
  const Cutter cutter = *parse_shape("thread:60:1.5");
  checks.mount(cutter);
  double piece_mm = 0.31;
  for (const Pass& pass : passes) {
    Motion m;
    m.kind = MotionKind::kThread;
    m.feed_mm_per_min = lead_mm;
    m.source.line = 7;
    const auto place = [&](double z) {
      return Vec3(pass.radius_mm + slope * (pass.start_z_mm - z), 0, z);
    };
    m.to_mm = place(pass.start_z_mm);
    while (m.to_mm.z > -20) {
      m.from_mm = m.to_mm;
      m.to_mm = place(std::max(m.from_mm.z - piece_mm, -20.0));
      checks.note(TurnedMove{m, TimedStep{}, cutter, cutter, {}, 1, false});
    }
    piece_mm += 0.03;
  }
  checks.end();
  return log.kept();
}

TEST(ThreadChecks, APassInPiecesIsOnePass) {
  EXPECT_EQ(told_in_pieces(rod20(), 1.5, 0, {{9.6}, {9.3}, {9.12}}).size(), 0U);
  const auto told = told_in_pieces(rod20(), 1.5, 0, {{9.6}, {9.3}, {9.13}});
  ASSERT_EQ(told.size(), 1U);
  EXPECT_EQ(told[0].position_mm, Vec3(9.13, 0, 5)) << "where the pass begins";
  // Where pieces begin are no starts: two are two.
  EXPECT_EQ(told_in_pieces(rod20(), 3, 0, {{9.1}, {9.1, 6.5}}).size(), 0U);
  EXPECT_EQ(told_in_pieces(rod20(), 3, 0, {{9.1}, {9.1}}).size(), 1U);
}

TEST(ThreadChecks, APassInPiecesFollowsACone) {
  // 1 in 16 of the diameter. At Z5 the cone would have a radius of 10 - 5/32.
  const double slope = 1.0 / 32;
  const TurnedProfile cone = {{{-60, 0}, {0, 0}, {0, 10}, {-60, 10 + 60 * slope}}};
  const double at_start = 10 - 5 * slope;
  EXPECT_EQ(told_in_pieces(cone, 1.5, slope, {{at_start - 0.5}, {at_start - 0.88}}).size(), 0U);
  const auto told = told_in_pieces(cone, 1.5, slope, {{at_start - 0.5}, {at_start - 0.86}});
  ASSERT_EQ(told.size(), 1U);
  EXPECT_NE(told[0].text.find("is 0.8"), std::string::npos) << told[0].text;
}

TEST(ThreadChecks, WhatIsNoThreadOfAFormIsNotJudged) {
  EXPECT_EQ(threads_told("turn:0:2:85:5", rod20(), 1.5, {{9.9}}).size(), 0U);
  EXPECT_EQ(threads_told("groove:2", rod20(), 1.5, {{9.9}}).size(), 0U);
  EXPECT_EQ(threads_told("thread:80", rod20(), 1.5, {{9.9}}).size(), 0U);
  // Beside the rod.
  EXPECT_EQ(threads_told("thread:60:1.5", rod20(), 1.5, {{10.5}}).size(), 0U);
}

}  // namespace
}  // namespace kerf
