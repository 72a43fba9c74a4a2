#include "twin/process/torch/torch_stage.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/twin/process/stages.h"
#include "tests/twin/process/torch_shop.h"
#include "twin/playback/frontier.h"
#include "twin/playback/stock_cursor.h"
#include "twin/process/torch/torch_plan.h"

namespace kerf {
namespace {

using test::square;
using test::torch_of;
using test::torch_program;
using test::TorchShop;
using Ids = std::vector<std::string>;

constexpr double kKerf = 2;  // of tool 1
/// Arcs of the sheet lie within 0.005 mm, and keep their area.
constexpr double kClose_mm2 = 0.05;

TEST(TorchStage, SquareComesFreeWithItsAreaAndItsLine) {
  MotionList program = torch_program();
  square(program, {50, 20}, 40);
  const TorchShop shop(program.list());
  EXPECT_EQ(shop.ids(), Ids{});
  const SheetReport report = shop.report();
  ASSERT_EQ(report.parts.size(), 1U);
  EXPECT_EQ(report.slugs.size(), 0U);
  const SheetPart& part = report.parts[0];
  EXPECT_NEAR(part.area_mm2, 38 * 38, 1e-6);
  EXPECT_NEAR(part.min_mm.x, 51, 1e-9);
  EXPECT_NEAR(part.max_mm.y, 59, 1e-9);
  EXPECT_NEAR(part.weight_kg, 38 * 38 * 3 * 8e-6, 1e-9);
  EXPECT_EQ(part.freed_by.line, 7U) << "tool change, traverse, lead-in, four sides: the last side";
  // Outside: round corners at three, the lead-in at the fourth. The lead-in of 3 mm leaves half a
  // disc and 2 mm beyond the square's own kerf.
  const double corners = 3 * (1 - kPi / 4) + (1 - kPi / 4) + 0;
  const double square_kerf = 42 * 42 - corners - 38 * 38;
  // Beyond the left edge of the square's kerf (1 mm from its line): 2 mm of full width and the half
  // disc, and the corner at the lower left is filled down to the lead-in's own lower edge.
  const double lead_in = 2 * kKerf + kPi / 2 + (1 - kPi / 4);
  EXPECT_NEAR(report.kerf_mm2, square_kerf + lead_in, kClose_mm2);
  EXPECT_NEAR(report.remaining_mm2 + part.area_mm2 + report.kerf_mm2, 20000, 1e-6);
  EXPECT_NEAR(report.yield(), 38 * 38 / 20000.0, 1e-9);
  EXPECT_NEAR(test::cuts_of(report).cut_mm, 3 + 4 * 40, 1e-9);
  EXPECT_EQ(test::cuts_of(report).pierces, 1U);
  EXPECT_NEAR(test::cuts_of(report).beam_s, 163 / 10.0, 1) << "600 mm/min, and braking in corners";
  const ToolUse& use = shop.stage().tools().at(0);
  EXPECT_EQ(use.shape, "kerf:2");
  EXPECT_NEAR(use.removed_mm3, report.kerf_mm2 * 3, 1e-6);
}

TEST(TorchStage, DwellWithTheBeamOnPiercesAHoleOfItsDiameter) {
  for (const double pierce : {1.0, 2.0, 3.5, 6.0, 9.0}) {
    MotionList program = torch_program();
    program.traverse({100, 50, 3}).spindle(true).dwell(0.5).dwell(0.5).spindle(false);
    program.traverse({150, 50, 3});
    BeamSettings settings;
    settings.pierce_mm = pierce;
    const TorchShop shop(program.list(), settings);
    const double hole = std::max(pierce, kKerf);
    EXPECT_NEAR(shop.kerf_mm2(), kPi / 4 * hole * hole, kClose_mm2) << pierce;
    EXPECT_EQ(test::cuts_of(shop.report()).pierces, 1U);
    EXPECT_NEAR(test::cuts_of(shop.report()).beam_s, 1, 1e-9);
    EXPECT_EQ(shop.report().parts.size(), 0U) << "nothing stays in the middle of the hole";
  }
}

TEST(TorchStage, PiercesAtTheStartOfTheCut) {
  MotionList program = torch_program();
  program.traverse({50, 50, 3}).spindle(true).feed({50, 50, 1}).feed({90, 50, 1}).spindle(false);
  BeamSettings settings;
  settings.pierce_mm = 6;
  const TorchShop shop(program.list(), settings);
  // The hole, a slot of 40 mm from its middle, its round end; less what hole and slot share: the
  // slot within the hole, half a disc's segment aside.
  const double half = std::asin(kKerf / 6);
  const double shared = 3 * 3 * (half + std::sin(2 * half) / 2);
  EXPECT_NEAR(shop.kerf_mm2(), kPi * 9 + 40 * kKerf + kPi / 2 - shared, kClose_mm2);
  EXPECT_EQ(test::cuts_of(shop.report()).pierces, 1U) << "down to the cut, and along, is one";
  EXPECT_NEAR(test::cuts_of(shop.report()).cut_mm, 40, 1e-9) << "the way down is none";
}

TEST(TorchStage, OnlyTheBeamCuts) {
  MotionList program = torch_program();
  program.traverse({50, 50, 0}).traverse({90, 50, 0});
  EXPECT_EQ(TorchShop(program.list()).kerf_mm2(), 0);
  program.feed({90, 60, 0});
  const TorchShop dark(program.list());
  EXPECT_EQ(dark.kerf_mm2(), 0);
  EXPECT_EQ(dark.ids(), Ids{"no-beam"});
  BeamSettings coolant;
  coolant.trigger = BeamTrigger::parse("m8").value();
  program.last().flood = true;
  EXPECT_NEAR(TorchShop(program.list(), coolant).kerf_mm2(), 10 * kKerf + kPi, kClose_mm2);
}

TEST(TorchStage, AProgramThatWasStoppedMayNotHaveComeToItsBeam) {
  MotionList program = torch_program();
  program.feed({50, 50, 0});
  const std::unique_ptr<Sheet> sheet = test::sheet_200();
  FindingLog log;
  ToolResolver resolver(test::torch_of("kerf:2"), stock_model(StockKind::kSheet).can_cut);
  CutStage stage(*sheet, resolver, log, TimelineOptions{}, *torch_process({}));
  stage.take(program.list());
  stage.finish(false);
  EXPECT_TRUE(log.kept().empty());
}

TEST(TorchStage, QtPlasmacTravelsLowOnlyWhereTheTorchIsHeldOff) {
  for (const bool held_off : {false, true}) {
    MotionList program = torch_program();
    square(program, {60, 20}, 40);
    if (held_off) program.spindle(true).output(3, true);
    program.feed({80, 40, 1});
    BeamSettings settings;
    settings.trigger = BeamTrigger::parse("plasmac").value();
    settings.is_qtplasmac = true;
    const TorchShop shop(program.list(), settings);
    const std::vector<std::string> ids = shop.ids();
    EXPECT_EQ(std::count(ids.begin(), ids.end(), "crosses-part"), held_off ? 1 : 0);
  }
}

TEST(TorchStage, SlugsOfHolesAreNoParts) {
  MotionList program = torch_program();
  square(program, {70, 40}, 10);
  square(program, {60, 20}, 40);
  const SheetReport report = TorchShop(program.list()).report();
  ASSERT_EQ(report.parts.size(), 1U);
  ASSERT_EQ(report.slugs.size(), 1U);
  EXPECT_NEAR(report.slugs[0].area_mm2, 8 * 8, 1e-6);
  EXPECT_EQ(report.slugs[0].freed_by.line, 7U);
  EXPECT_EQ(report.parts[0].freed_by.line, 13U);
}

TEST(TorchStage, PiercingAPartThatIsFreeIsAnError) {
  MotionList program = torch_program();
  square(program, {60, 20}, 40);
  square(program, {70, 40}, 10);  // its hole, too late
  const TorchShop shop(program.list());
  ASSERT_EQ(shop.ids(), (Ids{"crosses-part", "pierce-in-part"})) << "on the way there, too";
  EXPECT_EQ(shop.findings()[0].source.line, 8U);
  EXPECT_EQ(shop.findings()[0].severity, Severity::kWarning);
  EXPECT_EQ(shop.findings()[0].text,
            "the head travels at cut height over piece 1, which is free since line 7 and may have "
            "tipped");
  EXPECT_EQ(shop.findings()[1].source.line, 9U);
  EXPECT_EQ(shop.findings()[1].severity, Severity::kError);
}

TEST(TorchStage, TravelsOverManyPartsAreToldTogether) {
  MotionList program = torch_program();
  for (int i = 0; i < 14; ++i) square(program, {10.0 + 13 * i, 20}, 6);
  program.traverse({5, 23, 1}).traverse({199, 23, 1});
  const TorchShop shop(program.list());
  ASSERT_EQ(shop.ids(), Ids(TorchChecks::kTravelsTold, "crosses-part"));
  EXPECT_NE(shop.findings().back().text.find("may have tipped; and later over 4 more pieces"),
            std::string::npos)
      << shop.findings().back().text;
  EXPECT_EQ(shop.findings().front().text.find("more pieces"), std::string::npos);
}

TEST(TorchStage, HighAboveAPartTheHeadIsSafe) {
  MotionList program = torch_program();
  square(program, {60, 20}, 40).traverse({57, 20, 20}).traverse({150, 50, 20});
  EXPECT_EQ(TorchShop(program.list()).ids(), Ids{});
  program.traverse({150, 50, 1}).traverse({20, 50, 1});
  EXPECT_EQ(TorchShop(program.list()).ids(), Ids{"crosses-part"});
  BeamSettings lifts;
  lifts.is_qtplasmac = true;
  EXPECT_EQ(TorchShop(program.list(), lifts).ids(), Ids{}) << "that machine lifts it by itself";
}

TEST(TorchStage, FeedsAtCutHeightWithoutTheBeamAreOneFinding) {
  MotionList program = torch_program();
  square(program, {60, 20}, 40);
  program.feed({20, 80, 1}).feed({30, 80, 1}).feed({30, 90, 30}).feed({-50, 90, 1});
  const TorchShop shop(program.list());
  ASSERT_EQ(shop.ids(), Ids{"beam-off"});
  EXPECT_EQ(shop.findings()[0].source.line, 8U);
  EXPECT_EQ(shop.findings()[0].text.substr(0, 18), "3 feed moves run o");
}

TEST(TorchStage, QtPlasmacsScribeIsDarkOnPurpose) {
  MotionList program = torch_program();
  square(program, {60, 20}, 40);
  program.feed({20, 80, 1});
  program.last().torch.spindles_on = 2;
  BeamSettings settings;
  settings.trigger = BeamTrigger::parse("plasmac").value();
  EXPECT_EQ(TorchShop(program.list(), settings).ids(), Ids{"beam-off"});
  settings.is_qtplasmac = true;
  EXPECT_EQ(TorchShop(program.list(), settings).ids(), Ids{});
}

TEST(TorchStage, BeamThatStaysOnIsFound) {
  MotionList program = torch_program();
  program.spindle(true).feed({30, 30, 1}).dwell(0);
  program.last().kind = MotionKind::kProgramEnd;
  const TorchShop shop(program.list());
  ASSERT_EQ(shop.ids(), Ids{"torch-left-on"});
  EXPECT_EQ(shop.findings()[0].source.line, 3U);
  program.last().torch.spindles_on = 0;
  EXPECT_EQ(TorchShop(program.list()).ids(), Ids{});
}

TEST(TorchStage, SmallPartsAreFoundWhereTheSlatsAreKnown) {
  MotionList program = torch_program();
  square(program, {30, 20}, 30);
  square(program, {80, 20}, 60);
  BeamSettings settings;
  settings.slats_mm = 50;
  const TorchShop shop(program.list(), settings);
  ASSERT_EQ(shop.ids(), Ids{"small-part"});
  EXPECT_EQ(shop.findings()[0].source.line, 7U);
}

TEST(TorchStage, KerfIsThatOfTheMaterial) {
  MotionList program = torch_program();
  program.traverse({50, 50, 1}).spindle(true).feed({90, 50, 1}).spindle(false);
  program.traverse({50, 80, 1}).spindle(true).feed({90, 80, 1});
  program.last().torch.material = 1;
  program.spindle(false).traverse({0, 0, 1});
  BeamSettings settings;
  settings.is_qtplasmac = true;
  TorchMaterial thin, thick;
  thin.kerf_width_mm = 1;
  thin.pierce_delay_s = 0.5;
  thin.pause_at_end_s = 0.2;
  thick.number = 7;
  thick.kerf_width_mm = 4;
  settings.materials = {thin, thick};
  const double both = 40 * 1 + kPi / 4 + 40 * 4 + kPi * 4;
  EXPECT_NEAR(TorchShop(program.list(), settings, {}).kerf_mm2(), both, kClose_mm2);
  EXPECT_NEAR(TorchShop(program.list(), settings).kerf_mm2(), 2 * (40 * kKerf + kPi), kClose_mm2)
      << "--tool counts before it";
  const TorchShop shop(program.list(), settings, {});
  EXPECT_EQ(shop.ids(), Ids{});
  ASSERT_EQ(shop.stage().tools().size(), 2U);
  EXPECT_EQ(shop.stage().tools()[1].origin, "material 7 DEFAULT");
  EXPECT_NEAR(test::cuts_of(shop.report()).beam_s, 2 * 40 / 10.0 + 0.7, 1);
  settings.materials[0].pierce_delay_s = settings.materials[0].pause_at_end_s = 0;
  const TorchShop quick(program.list(), settings, {});
  EXPECT_NEAR(test::cuts_of(shop.report()).beam_s - test::cuts_of(quick.report()).beam_s, 0.7,
              1e-9);
  settings.materials[1].kerf_width_mm = 0;
  const TorchShop zero(program.list(), settings, {});
  ASSERT_EQ(zero.ids(), Ids{"kerf-zero"});
  EXPECT_EQ(zero.findings()[0].text,
            "tool 1: its kerf is 0 mm (material 7 DEFAULT); must be at least 0.01 mm; its moves do "
            "not cut");
  settings.kerf_mm = 3;
  EXPECT_NEAR(TorchShop(program.list(), settings, {}).kerf_mm2(), 2 * (120 + kPi * 9 / 4),
              kClose_mm2);
}

TEST(TorchStage, WithoutAKerfNothingIsCut) {
  MotionList program = torch_program();
  square(program, {50, 20}, 40);
  const TorchShop shop(program.list(), {}, {});
  EXPECT_EQ(shop.ids(), Ids{"tool-undefined"});
  EXPECT_EQ(shop.kerf_mm2(), 0);
}

TEST(TorchStage, CutsBesideTheSheetAreFound) {
  MotionList program = torch_program();
  square(program, {250, 20}, 40);
  const TorchShop shop(program.list());
  ASSERT_EQ(shop.ids(), Ids{"outside-stock"});
}

/// Pierced holes, arcs, dwells, jumps with the beam on and off, two materials.
std::vector<Motion> varied_program() {
  MotionList program = torch_program();
  for (int i = 0; i < 6; ++i) {
    const double x = 12 + 30.0 * i;
    square(program, {x, 10}, 12);
    program.traverse({x + 10, 60, 1}).spindle(true).dwell(0.2);
    program.arc({x + 10, 60, 1}, {x + 5, 60, 1}, {0, 0, 1}, i % 2 == 0 ? 2 * kPi : -2 * kPi);
    program.last().torch.material = static_cast<std::uint16_t>(i % 2);
    program.at({x + 12, 80, 1}).feed({x + 15, 85, 1}).spindle(false);
    program.feed({x + 20, 90, 1});
  }
  return program.list();
}

TEST(TorchStage, APlayedProgramIsTheDryRunAtEveryPlace) {
  const std::vector<Motion> motions = varied_program();
  BeamSettings settings;
  settings.pierce_mm = 5;
  settings.is_qtplasmac = true;
  settings.materials.resize(2);
  settings.materials[1].kerf_width_mm = 1.5;
  ProgramTrackBuilder builder;
  Timeline timeline(TimelineOptions{}, builder);
  for (const Motion& m : motions) timeline.push(m);
  timeline.finish();
  const std::shared_ptr<const ProgramTrack> track = builder.build({"part.ngc"}, {});
  KeyframeStore store(std::size_t{1} << 28, 1e-5);
  Frontier frontier(*track, test::sheet_200(), {}, TimelineOptions{}, store, {},
                    *torch_process(settings), settings.materials);
  while (!frontier.complete()) frontier.advance(track->size());
  StockCursor cursor(*track, frontier.moves(), frontier.record(), store);
  for (const std::size_t place : {motions.size(), std::size_t{9}, motions.size() / 2,
                                  std::size_t{10}, std::size_t{33}, std::size_t{0}}) {
    while (!cursor.approach(place)) {
    }
    const TorchShop shop(std::span<const Motion>(motions).first(place), settings, {});
    EXPECT_EQ(cursor.picture(0)->digest(), shop.sheet().digest()) << place;
    if (place == motions.size()) {
      EXPECT_EQ(frontier.findings().kept().size(), shop.findings().size());
      EXPECT_GT(shop.report().parts.size(), 5U);
    }
  }
  // Half of a cut is less than the whole and more than nothing: motion 9 dwells, motion 10 is
  // round.
  while (!cursor.approach(10)) {
  }
  const double before = cursor.picture(0)->remaining_mm3();
  const double half = cursor.picture(0.5)->remaining_mm3();
  while (!cursor.approach(11)) {
  }
  EXPECT_LT(half, before);
  EXPECT_LT(cursor.picture(0)->remaining_mm3(), half);
}

}  // namespace
}  // namespace kerf
