// What a machine is and tells: limits, axes, tool lengths, positions that are missing.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/twin/live/cutter_shop.h"

namespace kerf {
namespace {

TEST(MachineWatch, PositionsOfAnotherMachineAreSuspected) {
  LiveCutOptions options;
  options.timeline.limits.axes[0].present = true;
  options.timeline.limits.axes[0].min = -250;
  options.timeline.limits.axes[0].max = 250;
  Watch watch(options);
  for (int i = 0; i < 30; ++i) watch.see({612.3, 20, 60}, 0.1 * i);
  ASSERT_EQ(watch.ids(), std::vector<FindingId>{FindingId::kAxisLimit});
  EXPECT_EQ(watch.log().kept()[0].text,
            "X stands at 612.30 mm, beyond the limits of the machine (-250 to 250 mm): are these "
            "positions of another machine, or in another unit?");
}

TEST(MachineWatch, AnAxisThatTurnsIsToldOnceWhereTheModelCannotFollow) {
  Watch watch;
  double t_s = 0;
  const auto at = [&](double x, double c_deg) {
    AxisSample sample;
    for (std::size_t i = 0; i < 6; ++i) sample.set(i, 0);
    sample.set(0, x);
    sample.set(5, c_deg);
    sample.tool = 1;
    watch.cutter().take(sample, t_s += 0.1, false);
  };
  // It may stand anywhere.
  at(0, 90);
  at(1, 90.005);
  EXPECT_TRUE(watch.ids().empty());
  at(2, 91.5);
  at(3, 95);
  EXPECT_EQ(watch.ids(), std::vector<FindingId>{FindingId::kRotaryIgnored});
  EXPECT_NE(watch.log().kept().front().text.find("C has turned by 1.50 degrees"), std::string::npos)
      << watch.log().kept().front().text;
}

TEST(MachineWatch, AToolWhoseLengthNobodyTellsIsNamedOnce) {
  LiveCutOptions options;
  auto stock = block();
  FindingLog log;
  LiveCutter cutter(*stock, cutters(), log, options, nullptr);
  AxisSample sample;
  for (std::size_t i = 0; i < 3; ++i) sample.set(i, 50);
  for (const int tool : {0, 1, 1, 1}) {
    sample.tool = tool;
    cutter.take(sample, 0, false);
  }
  ASSERT_EQ(log.kept().size(), 1U);
  EXPECT_EQ(log.kept()[0].id, FindingId::kLengthUnknown);
  EXPECT_EQ(log.kept()[0].tool, 1);
}

TEST(MachineWatch, APositionThatIsMissingIsNamedAndNothingIsCut) {
  Watch watch;
  AxisSample sample;
  sample.set(0, 20);
  sample.set(2, -1);
  watch.cutter().take(sample, 0, false);
  EXPECT_FALSE(watch.cutter().place().known);
  EXPECT_EQ(watch.cutter().place().missing_axes, "Y");
  EXPECT_EQ(watch.cutter().facts().incomplete, 1U);
  EXPECT_EQ(watch.removed_mm3(), 0);
}

}  // namespace
}  // namespace kerf
