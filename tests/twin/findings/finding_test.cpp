#include "twin/findings/finding.h"

#include <gtest/gtest.h>

namespace kerf {
namespace {

Finding rapid() {
  Finding f;
  f.id = FindingId::kRapidContact;
  f.source.line = 118;
  f.position_mm = Vec3(12.4, 3, -1.2);
  f.tool = 3;
  f.depth_mm = 2.31;
  f.text = "traverse touches the workpiece";
  return f;
}

TEST(Finding, ReadsAsPromised) {
  EXPECT_EQ(to_string(diagnostic_of(rapid(), {"part.ngc"})),
            "part.ngc:118: error: rapid-contact: traverse touches the workpiece, 2.31 mm deep at "
            "X12.40 Y3.00 Z-1.20 (tool 3)\n");
}

TEST(Finding, NamesTheSubroutineFile) {
  Finding f = rapid();
  f.source.file = 1;
  EXPECT_EQ(diagnostic_of(f, {"part.ngc", "sub.ngc"}).file, "sub.ngc");
}

TEST(Finding, NeverWritesMinusZero) {
  Finding f = rapid();
  f.position_mm = Vec3(-0.0, -0.004, 0.004);
  EXPECT_NE(message_of(f).find("X0.00 Y0.00 Z0.00"), std::string::npos) << message_of(f);
}

TEST(FindingLog, KeepsTheGreatestDepthOfAnEvent) {
  FindingLog log;
  const auto handle = log.add(rapid());
  log.deepen(handle, 1.0);
  EXPECT_EQ(*log.kept()[0].depth_mm, 2.31);
  log.deepen(handle, 4.5);
  EXPECT_EQ(*log.kept()[0].depth_mm, 4.5);
}

TEST(FindingLog, CountsAllButKeepsABoundedNumber) {
  FindingLog log;
  for (std::size_t i = 0; i < FindingLog::kMaxKept + 7; ++i) log.deepen(log.add(rapid()), 1e3);
  EXPECT_EQ(log.kept().size(), FindingLog::kMaxKept);
  EXPECT_EQ(log.count(Severity::kError), FindingLog::kMaxKept + 7);
  EXPECT_EQ(log.total(), FindingLog::kMaxKept + 7);
}

Finding contact(double x_mm, double depth_mm) {
  Finding f = rapid();
  f.id = FindingId::kFixtureContact;
  f.text = "cutter touches fixture 'clamp'";
  f.position_mm = Vec3(x_mm, 3, -1);
  f.time_s = x_mm;
  f.depth_mm = depth_mm;
  f.bodies = {"cutter", "clamp"};
  return f;
}

TEST(FindingLog, ALoopThatMeetsTheSameClampIsOneFindingWhereItIsDeepest) {
  FindingLog log;
  log.join_repeats();
  log.deepen(log.add(contact(1, 0.5)), 1);
  log.deepen(log.add(contact(2, 0.5)), 2);
  log.deepen(log.add(contact(3, 0.5)), 2);
  log.deepen(log.add(contact(4, 0.5)), 1.5);
  ASSERT_EQ(log.kept().size(), 1u);
  EXPECT_EQ(log.count(Severity::kError), 1u);
  EXPECT_EQ(log.kept()[0].times, 4u);
  EXPECT_EQ(*log.kept()[0].time_s, 2);
  EXPECT_EQ(message_of(log.kept()[0]),
            "cutter touches fixture 'clamp', 2.00 mm deep at X2.00 Y3.00 Z-1.00 (tool 3); 4 times, "
            "deepest here");
  for (std::size_t n = 0; n < 3 * FindingLog::kMaxKept; ++n) log.add(contact(1, 1));
  EXPECT_EQ(log.total(), 1u);
}

TEST(FindingLog, WhatDiffersIsAFindingOfItsOwn) {
  FindingLog log;
  log.join_repeats();
  log.add(contact(1, 1));
  Finding other = contact(1, 1);
  other.bodies[0] = "holder";
  log.add(other);
  other = contact(1, 1);
  other.bodies[1] = "vise";
  log.add(other);
  other = contact(1, 1);
  other.bodies[1] = kWorkpieceBody;
  log.add(other), log.add(other);
  other = contact(1, 1);
  other.tool = 4;
  log.add(other);
  other = contact(1, 1);
  other.source.line = 119;
  log.add(other);
  EXPECT_EQ(log.total(), 7u);
}

TEST(FindingLog, BesideAMachineEachContactIsTold) {
  FindingLog log;
  log.add(contact(1, 1)), log.add(contact(1, 1));
  EXPECT_EQ(log.total(), 2u);
}

}  // namespace
}  // namespace kerf
