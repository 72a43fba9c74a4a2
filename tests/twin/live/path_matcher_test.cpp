// Where on its program a watched machine is: tools, lengths and offsets that the program tells.
#include <gtest/gtest.h>

#include "tests/twin/live/cutter_shop.h"

namespace kerf {
namespace {

TEST(PathMatcher, WhereTheSourceNamesNoToolTheProgramDoes) {
  const MotionList program = pocket();
  const auto wanted = dry_run(program.list());
  const RunningMachine machine(program.list());
  LiveCutOptions options;
  options.frame.tool = 1;  // as a configuration has it
  Watch watch(options, &program);
  for (double t = 0; t < machine.duration_s() + 0.01; t += 0.01) {
    AxisSample sample = machine.sample(std::min(t, machine.duration_s()));
    sample.tool = AxisSample::kUnknown;
    watch.cutter().take(sample, t, false);
  }
  watch.removed_mm3();
  EXPECT_LT(worst_difference_mm(watch.stock(), *wanted), 2e-5);
  EXPECT_EQ(watch.ids(), std::vector<FindingId>{});
}

TEST(PathMatcher, TheWayToTheProgramsFirstPositionIsNotOffItsPath) {
  MotionList program;
  program.at({10, 20, 5}).tool(1).spindle(true).feed_rate(600);
  program.traverse({10, 20, 5}).traverse({10, 20, 1}).feed({10, 20, -2}).feed({30, 20, -2});
  std::vector<Motion> motions = program.list();
  motions[1].start_known = false;  // line 2: from wherever the machine was
  LiveCutOptions options;
  options.frame.tool_length = ToolLengthFrom::kNone;
  options.wait_for_program = true;
  auto stock = block();
  FindingLog log;
  LiveCutter cutter(*stock, cutters(), log, options, std::make_unique<ListedProgram>(motions));
  AxisSample sample;
  sample.tool = 1;
  sample.line = 2;
  for (int i = 0; i <= 500; ++i) {  // five seconds
    sample.set(0, -90 + 0.2 * i);
    sample.set(1, 20);
    sample.set(2, 5);
    cutter.take(sample, 0.01 * i, false);
  }
  sample.line = 3;
  sample.set(2, 3);
  cutter.take(sample, 5.02, false);
  EXPECT_TRUE(cutter.place().followed);
  EXPECT_TRUE(log.kept().empty());
  // On a line of which it is said to be, and nowhere near it, it is off the path.
  LiveCutter lost(*stock, cutters(), log, options, std::make_unique<ListedProgram>(motions));
  sample.set(0, -50);
  for (int i = 0; i <= 500; ++i) lost.take(sample, 0.01 * i, false);
  ASSERT_EQ(log.kept().size(), 1U);
  EXPECT_EQ(log.kept()[0].id, FindingId::kOffPath);
}

TEST(PathMatcher, ToolLengthsOfTheProgramApplyWhereTheyAreInForce) {
  // Machine coordinates: the tip plus the length in force.
  std::vector<Motion> motions = pocket().list();
  for (Motion& m : motions) m.tool_offset_mm = {0, 0, m.tool == 1 ? 30.0 : 50.0};
  // The longer tool reaches 20 mm farther down when it is put in; the program goes on from there.
  for (std::size_t i = 1; i + 1 < motions.size(); ++i) {
    if (motions[i].kind != MotionKind::kToolChange || motions[i].tool != 2) continue;
    motions[i - 1].to_mm.z = 50;
    motions[i].from_mm = motions[i].to_mm = motions[i + 1].from_mm = {30, 26, 30};
  }
  const auto wanted = dry_run(motions);
  const RunningMachine machine(motions);
  LiveCutOptions options;
  options.program_lengths = true;
  options.gap_s = 10;
  auto stock = block();
  FindingLog log;
  options.wait_for_program = true;
  LiveCutter cutter(*stock, cutters(), log, options, std::make_unique<ListedProgram>(motions));
  for (double t = 0; t < machine.duration_s() + 0.01; t += 0.01) {
    AxisSample sample = machine.sample(std::min(t, machine.duration_s()));
    sample.position[2] += sample.tool == 1 ? 30 : 50;
    cutter.take(sample, t, false);
  }
  cutter.look();
  EXPECT_LT(worst_difference_mm(*stock, *wanted), 2e-5);
  EXPECT_EQ(cutter.facts().off_path, 0U);
}

TEST(PathMatcher, AnOffsetThatIsNotTheToolsLengthMovesTheTipAlongAProgram) {
  const std::vector<Motion> motions = pocket().list();
  for (const double applied_mm : {50.0, 50.5, 45.0}) {
    // The table has 50 for tool 2; half a mm is wear.
    const double off_mm = applied_mm == 45 ? -5 : 0;
    std::vector<Motion> real = motions;
    for (Motion& m : real) {
      if (m.tool != 2) continue;
      m.from_mm.z += off_mm;
      m.to_mm.z += off_mm;
      m.arc.center_mm.z += off_mm;
    }
    const auto wanted = dry_run(real);
    const RunningMachine machine(motions);
    LiveCutOptions options;
    options.frame.table_length_mm = {{1, 30}, {2, 50}};
    options.gap_s = 10;
    options.wait_for_program = true;
    auto stock = block();
    FindingLog log;
    LiveCutter cutter(*stock, cutters(), log, options, std::make_unique<ListedProgram>(motions));
    for (double t = 0; t < machine.duration_s() + 0.01; t += 0.01) {
      AxisSample sample = machine.sample(std::min(t, machine.duration_s()));
      sample.tool_offset_z_mm = sample.tool == 1 ? 30 : applied_mm;
      sample.position[2] += sample.tool_offset_z_mm;
      cutter.take(sample, t, false);
    }
    cutter.look();
    EXPECT_LT(worst_difference_mm(*stock, *wanted), 2e-5) << applied_mm;
    EXPECT_EQ(cutter.facts().off_path, 0U);
    int told = 0;
    for (const Finding& finding : log.kept()) told += finding.id == FindingId::kToolLength ? 1 : 0;
    EXPECT_EQ(told, off_mm != 0 ? 1 : 0) << applied_mm;
  }
}

}  // namespace
}  // namespace kerf
