#include "twin/process/punch/punch_stage.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/twin/process/punch_shop.h"
#include "tests/twin/process/stages.h"
#include "tests/twin/process/torch_shop.h"
#include "twin/playback/frontier.h"
#include "twin/playback/stock_cursor.h"
#include "twin/process/punch/punch_plan.h"

namespace kerf {
namespace {

using test::add_station;
using test::turret;
using Ids = std::vector<std::string>;

/// Arcs keep their area; corners are rounded to tenths of a micrometre.
constexpr double kClose_mm2 = 0.02;

/// 200 x 100 x 3 mm from 0, 0, punched as a dry run does.
class PunchShop {
 public:
  PunchShop(std::span<const Motion> motions, const TurretPointer& turret)
      : sheet_(test::sheet_200()),
        resolver_({}, stock_model(StockKind::kSheet).can_cut),
        stage_(*sheet_, resolver_, log_, TimelineOptions{}, *punch_process(turret)) {
    stage_.take(motions);
    stage_.finish();
  }
  const Sheet& sheet() const { return *sheet_; }
  double punched_mm2() const { return 20000 - sheet_->remaining_mm2(); }
  PunchTotals totals() const { return test::punch_of(stage_).totals(); }
  const std::vector<Finding>& findings() const { return log_.kept(); }
  Ids ids() const {
    Ids out;
    for (const Finding& finding : log_.kept()) out.emplace_back(to_string(finding.id));
    return out;
  }
  SheetReport report() const { return sheet_report(*sheet_, stage_.process(), 8000); }
  const CutStage& stage() const { return stage_; }

 private:
  std::unique_ptr<Sheet> sheet_;
  FindingLog log_;
  ToolResolver resolver_;
  CutStage stage_;
};

MotionList start(int tool) {
  MotionList program;
  program.at({0, 0, 5}).tool(tool);
  return program;
}

double lens(double r, double d) {
  return 2 * r * r * std::acos(d / (2 * r)) - d / 2 * std::sqrt(4 * r * r - d * d);
}

TEST(PunchStage, SpindleComingOnIsOneStroke) {
  MotionList program = start(1);
  for (const double x : {50.0, 80.0, 110.0}) {
    program.traverse({x, 50, 5}).spindle(true).signal().spindle(false).signal();
  }
  const PunchShop shop(program.list(), turret("m3"));
  EXPECT_EQ(shop.ids(), Ids{});
  EXPECT_NEAR(shop.punched_mm2(), 3 * kPi * 25, kClose_mm2);
  EXPECT_EQ(shop.totals().hits, 3U);
  ASSERT_EQ(shop.totals().stations.size(), 1U);
  EXPECT_EQ(shop.totals().stations[0].station, 1);
  EXPECT_EQ(shop.totals().stations[0].shape, "round:10");
  EXPECT_EQ(shop.totals().stations[0].hits, 3U);
  EXPECT_EQ(shop.stage().tools().at(0).origin, "turret");
}

TEST(PunchStage, DwellsWithTheSpindleOnStrikeOnce) {
  MotionList program = start(2);
  program.traverse({50, 50, 5}).spindle(true).dwell(0.1).dwell(0.1).spindle(false);
  program.traverse({90, 50, 5});
  const PunchShop shop(program.list(), turret("m3"));
  EXPECT_EQ(shop.ids(), Ids{});
  EXPECT_NEAR(shop.punched_mm2(), 100, 1e-9);
}

/// Without an INI nobody knows where the first move begins.
TEST(PunchStage, FirstMoveStrikesAtItsEnd) {
  const auto first_to = [](const Vec3& place, std::uint8_t unknown_axes = 0) {
    MotionList program;
    program.at(place).tool(2).spindle(true).traverse(place);
    program.last().start_known = false;
    program.last().unknown_to = unknown_axes;
    program.traverse({90, 50, 5}).spindle(false).traverse({130, 50, 5});
    return program;
  };
  auto press = turret("m3");
  press->strikes_at_ends = true;
  const PunchShop known(first_to({50, 50, 5}).list(), press);
  EXPECT_EQ(known.ids(), Ids{});
  EXPECT_EQ(known.totals().hits, 2U);
  EXPECT_FALSE(known.sheet().has_material({50, 50}));
  // X0 that a block names is a place; an X that none has named is not.
  EXPECT_EQ(PunchShop(first_to({0, 50, 5}).list(), press).totals().hits, 2U);
  const PunchShop unknown(first_to({0, 50, 5}, 1).list(), press);
  EXPECT_EQ(unknown.ids(), Ids{"position-unknown"});
  EXPECT_EQ(unknown.totals().hits, 1U);
  // A punch that strikes where the trigger comes does so before the move.
  const PunchShop once(first_to({50, 50, 5}).list(), turret("m3"));
  EXPECT_EQ(once.ids().at(0), "position-unknown");
  EXPECT_EQ(once.totals().hits, 0U);
}

TEST(PunchStage, TriggersOfEveryKind) {
  // M62 takes effect with the move behind it: where that begins.
  MotionList synchronous = start(2);
  synchronous.traverse({50, 50, 5}).output(0, true).traverse({90, 50, 5}).output(0, false);
  synchronous.traverse({130, 50, 5});
  auto press = turret("m62:0");
  PunchShop first(synchronous.list(), press);
  EXPECT_EQ(first.totals().hits, 1U);
  EXPECT_FALSE(first.sheet().has_material({50, 50}));
  EXPECT_EQ(first.ids(), Ids{"punch-down"});
  // User M-codes.
  MotionList codes = start(2);
  codes.traverse({50, 50, 5}).signal(101).signal(102).traverse({90, 50, 5}).signal(101);
  EXPECT_EQ(PunchShop(codes.list(), turret("M101")).totals().hits, 2U);
  EXPECT_EQ(PunchShop(codes.list(), turret("m102")).totals().hits, 1U);
  // Drilling cycles: at their bottom, whatever comes between.
  MotionList cycle = start(2);
  for (const double x : {50.0, 90.0}) {
    cycle.traverse({x, 50, 5}).traverse({x, 50, 2}).feed({x, 50, -1}).traverse({x, 50, 2});
  }
  for (const char* const trigger : {"g81", "z<0", "z<-0.5"}) {
    PunchShop shop(cycle.list(), turret(trigger));
    EXPECT_EQ(shop.totals().hits, 2U) << trigger;
    EXPECT_EQ(shop.ids(), Ids{}) << trigger;
    EXPECT_NEAR(shop.punched_mm2(), 200, 1e-9);
  }
  EXPECT_EQ(PunchShop(cycle.list(), turret("z<-2")).ids(), Ids{"no-hit"});
}

TEST(PunchStage, StrikesAtTheEndsOfMovesIfThatIsMeant) {
  MotionList program = start(2);
  program.traverse({30, 50, 5}).spindle(true).signal();
  for (const double x : {50.0, 80.0, 110.0}) program.traverse({x, 50, 5});
  program.spindle(false).signal().traverse({150, 50, 5});
  auto press = turret("m3");
  press->strikes_at_ends = true;
  const PunchShop shop(program.list(), press);
  EXPECT_EQ(shop.totals().hits, 3U);
  EXPECT_TRUE(shop.sheet().has_material({30, 50}));
  EXPECT_FALSE(shop.sheet().has_material({110, 50}));
  EXPECT_EQ(shop.ids(), Ids{});
}

TEST(PunchStage, NibblesLinesAndArcsWithBothEnds) {
  const double r = 5;
  MotionList line = start(1);
  line.traverse({30, 50, 5}).spindle(true).signal().feed({72, 50, 5}).spindle(false).signal();
  const PunchShop along(line.list(), turret("m3", 3));
  EXPECT_EQ(along.totals().hits, 15U) << "at the start by M3, then 14 steps of 3 mm";
  EXPECT_NEAR(along.totals().nibbled_mm, 42, 1e-9);
  EXPECT_NEAR(along.punched_mm2(), kPi * 25 + 14 * (kPi * 25 - lens(r, 3)), kClose_mm2);
  // A rest of a step at the end; the next feed goes on from there without a second stroke.
  MotionList corner = start(1);
  corner.traverse({30, 50, 5}).spindle(true).signal().feed({40, 50, 5}).feed({40, 40, 5});
  EXPECT_EQ(PunchShop(corner.list(), turret("m3", 3)).totals().hits, 1U + 4 + 4);
  // An arc of radius 30, in six steps of 7 mm.
  MotionList round = start(1);
  const double sweep = 42.0 / 30, step = 7.0 / 30;
  round.traverse({130, 30, 5}).spindle(true).signal();
  round.arc({100 + 30 * std::cos(sweep), 30 + 30 * std::sin(sweep), 5}, {100, 30, 5}, {0, 0, 1},
            sweep);
  round.spindle(false).signal();
  const PunchShop arc(round.list(), turret("m3", 7));
  EXPECT_EQ(arc.totals().hits, 7U);
  EXPECT_NEAR(arc.punched_mm2(), 7 * kPi * 25 - 6 * lens(r, 60 * std::sin(step / 2)), kClose_mm2);
  EXPECT_FALSE(arc.sheet().has_material({100 + 30 * std::cos(sweep), 30 + 30 * std::sin(sweep)}));
}

TEST(PunchStage, NibblingMayHaveAConditionOfItsOwn) {
  auto press = turret("m101", 5);
  press->nibbles = std::move(*BeamTrigger::parse("m62:1"));
  MotionList program = start(2);
  program.traverse({30, 50, 5}).signal(101).feed({50, 50, 5});
  program.output(1, true).feed({70, 50, 5}).feed({70, 70, 5}).output(1, false).feed({90, 70, 5});
  const PunchShop shop(program.list(), press);
  EXPECT_EQ(shop.totals().hits, 1U + 5 + 4);
  EXPECT_NEAR(shop.totals().nibbled_mm, 40, 1e-9);
}

TEST(PunchStage, IndexStationsTurnByTheAxisOrTheOutput) {
  const auto corner = [](double angle_deg) {
    const double a = angle_deg * kPi / 180;
    return Vec2(100 + 14 * std::cos(a), 50 + 14 * std::sin(a));
  };
  MotionList program = start(3);
  program.traverse({100, 50, 5}).turned({0, 0, 30}).signal(101);
  const PunchShop shop(program.list(), turret("m101"));
  EXPECT_FALSE(shop.sheet().has_material(corner(30)));
  EXPECT_TRUE(shop.sheet().has_material(corner(0)));
  auto other = turret("m101");
  other->index.analog = 1;
  MotionList analog = start(3);
  analog.traverse({100, 50, 5}).turned({0, 0, 30}).signal(101);
  analog.last().torch.analog[1] = -45;
  const PunchShop by_output(analog.list(), other);
  EXPECT_FALSE(by_output.sheet().has_material(corner(-45)));
  EXPECT_TRUE(by_output.sheet().has_material(corner(30)));
}

TEST(PunchStage, PartsAreReportedWithTheLineThatFreedThem) {
  MotionList program = start(3);
  program.traverse({100, 37.5, 5}).signal(101).traverse({100, 62.5, 5}).signal(101);
  program.turned({0, 0, 90});
  program.traverse({87.5, 50, 5}).signal(101).traverse({112.5, 50, 5}).signal(101);
  const PunchShop shop(program.list(), turret("m101"));
  EXPECT_EQ(shop.ids(), Ids{});
  const SheetReport report = shop.report();
  ASSERT_EQ(report.parts.size(), 1U);
  EXPECT_NEAR(report.parts[0].area_mm2, 400, 1e-9);
  EXPECT_EQ(report.parts[0].freed_by.line, program.last().source.line);
  EXPECT_NEAR(report.remaining_mm2 + 400 + report.kerf_mm2, 20000, 1e-6);
  EXPECT_NEAR(report.yield(), 0.02, 1e-9);
  // A stroke on it afterwards.
  program.traverse({100, 50, 5}).signal(101);
  const PunchShop again(program.list(), turret("m101"));
  ASSERT_EQ(again.ids(), Ids{"hit-on-part"});
  EXPECT_EQ(again.findings()[0].text,
            "the punch strikes piece 1, which is free since line 9 and may have moved");
}

TEST(PunchStage, StationsThatAreEmptyAndNoToolAtAll) {
  MotionList program = start(0);
  program.traverse({50, 50, 5}).signal(101).tool(9).signal(101).tool(1).signal(101);
  const PunchShop shop(program.list(), turret("m101"));
  EXPECT_EQ(shop.ids(), (Ids{"no-punch", "station-empty"}));
  EXPECT_EQ(message_of(shop.findings()[1]),
            "station 9 is empty; nothing is cut at X50.00 Y50.00 Z5.00 (tool 9)");
  EXPECT_EQ(shop.totals().hits, 1U);
  EXPECT_NEAR(shop.punched_mm2(), kPi * 25, kClose_mm2);
}

TEST(PunchStage, ClampsAreInTheWayUntilTheyReGrip) {
  auto press = turret("m101");
  press->clamps.push_back({{50, -60}, {90, 15}, 5});
  press->regrips.push_back({.user_code = 120, .line = 0, .shift_mm = {60, 0}});
  MotionList program = start(2);
  program.traverse({70, 24.9, 5}).signal(101);              // its edge within the clearance
  program.traverse({70, 25.1, 5}).signal(101).signal(120);  // just clear
  program.traverse({70, 10, 5}).signal(101);                // the clamp has gone ..
  program.traverse({130, 10, 5}).signal(101);               // .. there
  const PunchShop shop(program.list(), press);
  EXPECT_EQ(shop.ids(), (Ids{"hit-on-clamp", "hit-on-clamp"}));
  EXPECT_EQ(shop.findings()[0].source.line, 3U);
  EXPECT_EQ(shop.findings()[1].source.line, 10U);
  EXPECT_EQ(shop.findings()[1].text, "the punch comes down on clamp 1");
  EXPECT_EQ(shop.totals().regrips, 1U);
  // Into the air, by the line of the program.
  press->regrips = {{.user_code = 0, .line = 5, .shift_mm = {-400, 0}}};
  EXPECT_EQ(PunchShop(program.list(), press).ids(), (Ids{"hit-on-clamp", "grip-lost"}));
}

TEST(PunchStage, StrokesBesideTheSheetAndIntoTheAir) {
  MotionList program = start(1);
  program.traverse({-5.1, 50, 5}).signal(101);  // beside
  program.traverse({-4.9, 50, 5}).signal(101);  // a notch of the edge
  program.traverse({50, 50, 5}).signal(101).signal(101);
  const PunchShop shop(program.list(), turret("m101"));
  ASSERT_EQ(shop.ids(), (Ids{"hit-off-sheet", "hit-over-edge", "hit-in-air"}));
  EXPECT_EQ(shop.findings()[0].source.line, 3U);
  EXPECT_EQ(shop.findings()[1].source.line, 5U);
  EXPECT_EQ(shop.findings()[2].source.line, 8U);
}

TEST(PunchStage, StrokesThatHangOverTheEdgeAreTold) {
  MotionList program = start(2);
  program.traverse({0, 50, 5}).signal(101);   // half of it
  program.traverse({-1, 70, 5}).signal(101);  // more
  program.traverse({20, 50, 5}).signal(101);
  const PunchShop shop(program.list(), turret("m101"));
  ASSERT_EQ(shop.ids(), (Ids{"hit-over-edge", "hit-over-edge"}));
  EXPECT_EQ(shop.findings()[0].severity, Severity::kNote);
  EXPECT_EQ(shop.findings()[0].text, "50.0 % of the punch hangs over the edge of the sheet");
  EXPECT_EQ(shop.findings()[1].severity, Severity::kWarning);
  EXPECT_TRUE(shop.findings()[1].text.ends_with(", which pushes it aside"))
      << shop.findings()[1].text;
}

/// A pitch is never made wider without a word.
TEST(PunchStage, AMoveOfTooManyStrokesIsAnError) {
  MotionList program = start(1);
  program.traverse({-15000, 50, 5}).spindle(true).signal().feed({15000, 50, 5}).spindle(false);
  program.signal();
  const PunchShop shop(program.list(), turret("m3", 0.2));
  const std::vector<Finding> findings(shop.findings().begin(), shop.findings().end());
  const auto told = std::find_if(findings.begin(), findings.end(), [](const Finding& finding) {
    return finding.id == FindingId::kWebLeft;
  });
  ASSERT_NE(told, findings.end());
  EXPECT_EQ(told->severity, Severity::kError);
  EXPECT_EQ(told->text,
            "the move is 30000 mm long: with a pitch of 0.2 mm it would take more than 100000 "
            "strokes; it was nibbled every 0.300 mm");
}

TEST(PunchStage, WebsBetweenStrokesAreFound) {
  MotionList program = start(1);
  program.traverse({30, 50, 5}).spindle(true).signal().feed({90, 50, 5}).spindle(false).signal();
  EXPECT_EQ(PunchShop(program.list(), turret("m3", 9.99)).ids(), Ids{});
  const PunchShop wide(program.list(), turret("m3", 12));
  ASSERT_EQ(wide.ids(), Ids{"web-left"});
  EXPECT_EQ(wide.findings()[0].text,
            "webs stay between the strokes, and the slug with them: 12.00 mm from one to the next, "
            "and punch:round:10 reaches 10.00 mm that way");
  // Where the web has gone before, nothing stays.
  auto press = turret("m3", 9);
  press->stations.at(1).pitch_mm = 12;
  MotionList twice = start(2);
  twice.traverse({30, 50, 5}).spindle(true).signal().feed({90, 50, 5}).spindle(false).signal();
  twice.tool(1).traverse({30, 50, 5}).spindle(true).signal().feed({90, 50, 5});
  EXPECT_EQ(PunchShop(twice.list(), press).ids(), (Ids{"hit-in-air", "hit-in-air"}));
  // Across its narrow side a slit leaves webs that it does not leave along itself.
  MotionList slit = start(3);
  slit.traverse({100, 20, 5}).spindle(true).signal().feed({100, 60, 5});
  EXPECT_EQ(PunchShop(slit.list(), turret("m3", 8)).ids(), Ids{"web-left"});
}

TEST(PunchStage, OneKindOfTroubleIsToldTenTimes) {
  MotionList program = start(9);
  for (int i = 0; i < 50; ++i) program.traverse({10.0 + i, 50, 5}).signal(101);
  const PunchShop shop(program.list(), turret("m101"));
  ASSERT_EQ(shop.findings().size(), PunchChecks::kTold);
  EXPECT_EQ(shop.findings().back().text, "station 9 is empty; nothing is cut; and later 40 more");
}

/// A program of every kind of stroke, seeked to and fro, is the same sheet as cut from its start.
TEST(PunchStage, SeekingLeavesTheSameSheet) {
  auto press = turret("m3", 3);
  MotionList program = start(1);
  for (int i = 0; i < 12; ++i) {
    program.tool(1 + i % 4).turned({0, 0, 25.0 * i});
    program.traverse({15.0 + 15 * i, 30, 5}).spindle(true).signal();
    program.feed({22.0 + 15 * i, 40, 5});
    program.arc({22.0 + 15 * i, 60, 5}, {22.0 + 15 * i, 50, 5}, {0, 0, 1}, kPi);
    program.spindle(false).signal();
    program.traverse({20.0 + 15 * i, 80, 5}).spindle(true).dwell(0.1).spindle(false);
  }
  const std::vector<Motion>& motions = program.list();
  ProgramTrackBuilder builder;
  Timeline timeline(TimelineOptions{}, builder);
  for (const Motion& m : motions) timeline.push(m);
  timeline.finish();
  const std::shared_ptr<const ProgramTrack> track = builder.build({"part.ngc"}, {});
  KeyframeStore store(std::size_t{1} << 28, 1e-5);
  Frontier frontier(*track, test::sheet_200(), {}, TimelineOptions{}, store, {},
                    *punch_process(press));
  while (!frontier.complete()) frontier.advance(track->size());
  StockCursor cursor(*track, frontier.moves(), frontier.record(), store);
  for (const std::size_t place : {motions.size(), std::size_t{5}, motions.size() / 2,
                                  std::size_t{7}, std::size_t{40}, std::size_t{0}}) {
    while (!cursor.approach(place)) {
    }
    const PunchShop shop(std::span<const Motion>(motions).first(place), press);
    EXPECT_EQ(cursor.picture(0)->digest(), shop.sheet().digest()) << place;
    if (place == motions.size()) {
      EXPECT_EQ(frontier.findings().kept().size(), shop.findings().size());
      EXPECT_GT(shop.totals().hits, 200U);
    }
  }
  // Half a row: motion 5 is the first arc.
  while (!cursor.approach(5)) {
  }
  ASSERT_EQ(motions[5].kind, MotionKind::kArc);
  const double before = cursor.picture(0)->remaining_mm3();
  const double half = cursor.picture(0.5)->remaining_mm3();
  while (!cursor.approach(6)) {
  }
  EXPECT_LT(half, before);
  EXPECT_LT(cursor.picture(0)->remaining_mm3(), half);
}

TEST(PunchStage, TriggersThatAreNone) {
  for (const char* const text : {"", "m99", "m200", "m1000", "g82", "x<3", "m3+", "m62", "\x01"}) {
    const Result<PunchTrigger> trigger = PunchTrigger::parse(text);
    ASSERT_FALSE(trigger) << text;
    EXPECT_NE(trigger.error().find("is no trigger; must be g81, m100 to m199"), std::string::npos)
        << trigger.error();
  }
}

}  // namespace
}  // namespace kerf
