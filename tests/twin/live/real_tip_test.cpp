// The look-ahead of a machine whose tool, or tool length offset, is not the program's.
#include "twin/live/real_tip.h"

#include <gtest/gtest.h>

#include <functional>
#include <optional>

#include "stock/cutter/shape_spec.h"
#include "stock/zmap/zmap.h"
#include "tests/twin/live/live_shop.h"
#include "twin/live/live_cutter.h"
#include "twin/program/session_parts.h"

namespace kerf {
namespace {

constexpr double kLength1_mm = 30;
constexpr double kLength2_mm = 34;

struct Foreseen {
  std::optional<AheadWarning> contact;  ///< the first
  bool happened = false;
};

/// A machine runs the program along its path, with a tool (until that line) and an offset of its
/// own.
Foreseen watch(const std::vector<Motion>& motions, int tool,
               const std::function<double(const Motion&)>& applied_mm,
               std::uint32_t until_line = 1000) {
  ZMapOptions blank;
  blank.blank = parse_blank("box:0,0,-10:40,40,0").value();
  blank.cell_mm = 0.1;
  auto stock = std::move(ZMap::create(blank).value());
  ToolSources cutters;
  cutters.arguments.push_back(std::move(parse_tool_argument("1=flat:4").value()));
  cutters.arguments.push_back(std::move(parse_tool_argument("2=flat:4").value()));
  LiveCutOptions options;
  options.frame.table_length_mm = {{1, kLength1_mm}, {2, kLength2_mm}};
  options.wait_for_program = true;
  options.guard_s = 4;
  FindingLog log;
  LiveCutter cutter(*stock, cutters, log, options, std::make_unique<ListedProgram>(motions));
  const RunningMachine machine(motions);
  Foreseen seen;
  for (double t = 0; t < machine.duration_s() + 0.01; t += 0.01) {
    AxisSample sample = machine.sample(std::min(t, machine.duration_s()), true);
    const Motion& now = machine.at(t).motion;
    sample.tool = now.source.line < until_line ? tool : now.tool;
    sample.tool_offset_z_mm = applied_mm(now);
    // The controller has the tip on the program's path by the offset that it applies.
    sample.position[2] += sample.tool_offset_z_mm - now.length.tip_shift_mm.z;
    cutter.take(sample, t, false);
    cutter.look();
    for (AheadWarning& warning : cutter.take_warnings()) {
      const bool contact = warning.finding.id == FindingId::kRapidContact;
      if (contact && !seen.contact) seen.contact = std::move(warning);
    }
  }
  cutter.finish();
  EXPECT_EQ(cutter.facts().off_path, 0U);
  for (const Finding& one : log.kept()) seen.happened |= one.id == FindingId::kRapidContact;
  return seen;
}

/// Half a dozen seconds in the air beside the block, and then over it at that height (line 4).
MotionList over_at(double z) {
  MotionList program;
  program.at({-10, 20, 35}).tool(1).spindle(true).feed_rate(60);
  program.traverse({-10, 20, 20}).feed({-4, 20, 20}).traverse({-4, 20, z}).traverse({30, 20, z});
  program.traverse({30, 20, 35});
  return program;
}

TEST(RealTip, ACrashThatTheRealOffsetMakesIsForeseen) {
  const std::vector<Motion> program = over_at(3).list();
  const Foreseen sound = watch(program, 1, [](const Motion&) { return kLength1_mm; });
  EXPECT_FALSE(sound.contact);
  EXPECT_FALSE(sound.happened);
  // 5 mm lower than programmed: 2 mm deep.
  const Foreseen lower = watch(program, 1, [](const Motion&) { return kLength1_mm - 5; });
  ASSERT_TRUE(lower.contact);
  EXPECT_TRUE(lower.happened);
  EXPECT_EQ(lower.contact->finding.source.line, 5U);
  EXPECT_NEAR(lower.contact->finding.depth_mm.value_or(0), 2, 0.01);
  EXPECT_GT(lower.contact->in_s, 3.5);
}

TEST(RealTip, ACrashThatTheRealOffsetDoesNotMakeIsNot) {
  const std::vector<Motion> program = over_at(-2).list();
  const Foreseen as_programmed = watch(program, 1, [](const Motion&) { return kLength1_mm; });
  EXPECT_TRUE(as_programmed.contact);
  EXPECT_TRUE(as_programmed.happened);
  const Foreseen higher = watch(program, 1, [](const Motion&) { return kLength1_mm + 5; });
  EXPECT_FALSE(higher.contact);
  EXPECT_FALSE(higher.happened);
}

TEST(RealTip, AnotherToolIsAsLongAsTheTableHasIt) {
  // Tool 2 is 4 mm longer: 1 mm deep.
  const Foreseen longer = watch(over_at(3).list(), 2, [](const Motion&) { return kLength1_mm; });
  ASSERT_TRUE(longer.contact);
  EXPECT_TRUE(longer.happened);
  EXPECT_NEAR(longer.contact->finding.depth_mm.value_or(0), 1, 0.01);
  EXPECT_EQ(longer.contact->finding.tool, 2);
  // .. and with its own length the tip is where the program has it.
  const Foreseen own = watch(over_at(3).list(), 2, [](const Motion&) { return kLength2_mm; });
  EXPECT_FALSE(own.contact);
  EXPECT_FALSE(own.happened);
}

/// The program takes the tool's length in line 5 only; until then its tip is that much lower than
/// programmed.
std::vector<Motion> length_taken_later(double z) {
  std::vector<Motion> motions = over_at(z).list();
  for (Motion& m : motions) {
    if (m.source.line > 3) continue;
    m.length.verdict = ToolLengthState::Verdict::kWrong;
    m.length.real_mm = {0, 0, kLength1_mm};
    m.length.tip_shift_mm = {0, 0, -kLength1_mm};
    m.length.displaces = true;
  }
  return motions;
}

TEST(RealTip, ALengthThatTheProgramTakesLaterIsThatOfTheProgramsTool) {
  const auto as_programmed = [](const Motion& m) {
    return m.length.verdict == ToolLengthState::Verdict::kWrong ? 0.0 : kLength1_mm;
  };
  const Foreseen sound = watch(length_taken_later(3), 1, as_programmed);
  EXPECT_FALSE(sound.contact);
  EXPECT_FALSE(sound.happened);
  const Foreseen longer = watch(length_taken_later(3), 2, as_programmed);
  ASSERT_TRUE(longer.contact);
  EXPECT_TRUE(longer.happened);
  EXPECT_NEAR(longer.contact->finding.depth_mm.value_or(0), 1, 0.01);
  // While the machine still has none.
  EXPECT_GT(longer.contact->in_s, 3.5);
  EXPECT_FALSE(watch(length_taken_later(5), 2, as_programmed).contact);
}

TEST(RealTip, BehindTheNextChangeTheToolIsTheProgramsAgain) {
  // Tool 2 stays in the spindle until the change of line 7. It would crash in line 9, and tool 1
  // does not.
  MotionList program = over_at(5);
  program.tool(1).spindle(true).traverse({30, 20, 3}).traverse({10, 20, 3});
  ASSERT_EQ(program.list()[6].kind, MotionKind::kToolChange);
  const auto applied = [](const Motion&) { return kLength1_mm; };
  const std::uint32_t change = program.list()[6].source.line;
  const Foreseen seen = watch(program.list(), 2, applied, change);
  EXPECT_FALSE(seen.contact);
  EXPECT_FALSE(seen.happened);
  EXPECT_TRUE(watch(program.list(), 2, applied).happened);
}

}  // namespace
}  // namespace kerf
