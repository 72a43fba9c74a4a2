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

}  // namespace
}  // namespace kerf
