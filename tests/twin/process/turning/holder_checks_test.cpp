#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "stock/cutter/shape_spec.h"
#include "stock/turning/turning_stock.h"
#include "tests/twin/process/motions.h"
#include "twin/job/stock_choice.h"
#include "twin/process/cut_stage.h"
#include "twin/process/process_table.h"

namespace kerf {
namespace {

using Ids = std::vector<std::string>;

/// What a tool cuts out of a blank whose end is at Z0.
class BarShop {
 public:
  BarShop(const MotionList& program, const char* shape, const TurnedProfile& blank)
      : stock_(*TurnedPart::create(blank)),
        resolver_(tools(shape), stock_model(StockKind::kTurning).can_cut),
        stage_(stock_, resolver_, log_, TimelineOptions{}, *choose_process(wish())) {
    stage_.judge_blank(BlankKind::kUnjudged);
    stage_.take(program.list());
    stage_.finish();
  }
  Ids ids() const {
    Ids out;
    for (const Finding& finding : log_.kept()) out.emplace_back(to_string(finding.id));
    return out;
  }
  const Finding& finding(std::size_t i) const { return log_.kept().at(i); }
  std::vector<CollisionPair> pairs() const { return stage_.process().collisions(); }

 private:
  static ToolSources tools(const char* shape) {
    ToolSources sources;
    sources.turning = true;
    sources.arguments.push_back({1, *parse_shape(shape)});
    return sources;
  }
  static ProcessWish wish() {
    ProcessWish wish;
    wish.is_turned = true;
    return wish;
  }

  TurningStock stock_;
  FindingLog log_;
  ToolResolver resolver_;
  CutStage stage_;
};

TurnedProfile tube20() { return tube_profile(-60, 0, 50, 20); }

MotionList start_at(Vec3 place) {
  MotionList program;
  program.at(place).tool(1).spindle(true);
  return program;
}

/// A bar of 16 mm whose axis is 11 mm below the tip: it reaches from 3 below the tip to 19.
constexpr const char* kBar16 = "bore:0.4:16:80:f=11";
/// A bar of 8 mm with its axis 5 below the tip.
constexpr const char* kBar8 = "bore:0.4:8:60:f=5";

TEST(HolderChecks, ABarThickerThanTheBoreIsToldOnTheRapid) {
  // The tip at X9.5 has the bar from X6.5 down to, which is 9.5 on the other side: it fits.
  MotionList fits = start_at({9.5, 0, 5});
  fits.traverse({9.5, 0, -30});
  EXPECT_EQ(BarShop(fits, kBar16, tube20()).ids(), Ids{});
  // At X8 it reaches to X-11: 1 mm into the wall.
  MotionList program = start_at({8, 0, 5});
  program.traverse({8, 0, -30});
  const BarShop shop(program, kBar16, tube20());
  ASSERT_EQ(shop.ids(), Ids{"bar-contact"});
  const Finding& finding = shop.finding(0);
  EXPECT_EQ(finding.severity, Severity::kError);
  EXPECT_NEAR(*finding.depth_mm, 1, 0.01);
  EXPECT_EQ(finding.bodies, (std::array<std::string, 2>{"holder", "workpiece"}));
  EXPECT_EQ(finding.source.line, 2U);
  ASSERT_EQ(shop.pairs().size(), 1U);
  EXPECT_EQ(shop.pairs()[0].contacts, 1U);
}

TEST(HolderChecks, OnAFeedTheInsertGoesAhead) {
  // Bored out to 24: the bar follows into what the insert has cut.
  MotionList sound = start_at({12, 0, 5});
  sound.traverse({12, 0, 2}).feed({12, 0, -30}).feed({11, 0, -29}).traverse({11, 0, 5});
  EXPECT_EQ(BarShop(sound, kBar8, tube20()).ids(), Ids{});
}

TEST(HolderChecks, AFeedOfABarThatIsTooThick) {
  // The tip at X5 of a bore of 20 cuts nothing, and the bar is at X-14: 4 mm in the wall, from
  // where its end has come to Z0.
  MotionList program = start_at({5, 0, 5});
  program.feed({5, 0, -30});
  const BarShop shop(program, kBar16, tube20());
  ASSERT_EQ(shop.ids(), Ids{"bar-contact"});
  EXPECT_NEAR(*shop.finding(0).depth_mm, 4, 0.01);
  EXPECT_GT(shop.finding(0).position_mm->z, -8);
  EXPECT_LT(shop.finding(0).position_mm->z, 0.01);
}

TEST(HolderChecks, AShankAgainstAShoulder) {
  // A blade of 3 mm, 8 long, in a shank 20 wide: 10 mm deep it has the shank 2 mm in the bar.
  const TurnedProfile bar = bar_profile(-60, 0, 50);
  MotionList sound = start_at({30, 0, -20});
  sound.feed({17.1, 0, -20}).traverse({30, 0, -20});
  EXPECT_EQ(BarShop(sound, "groove:3:edge=8:holder=20x100", bar).ids(), Ids{});
  MotionList program = start_at({30, 0, -20});
  program.feed({15, 0, -20}).traverse({30, 0, -20});
  const BarShop shop(program, "groove:3:edge=8:holder=20x100", bar);
  ASSERT_EQ(shop.ids(), Ids{"holder-contact"});
  EXPECT_NEAR(*shop.finding(0).depth_mm, 2, 0.01);
  EXPECT_NEAR(shop.finding(0).position_mm->x, 17, 0.002);
}

TEST(EdgeChecks, ACutAsDeepAsTheEdgeIsLong) {
  // An edge of 6 mm that leans back by 5 degrees reaches 6 sin 85 = 5.977 mm across the way.
  const TurnedProfile bar = bar_profile(-60, 0, 50);
  MotionList program = start_at({18, 0, 2});
  program.feed({18, 0, -20});
  const BarShop shop(program, "turn:0:2:85:5:6", bar);
  ASSERT_EQ(shop.ids(), Ids{"over-depth"});
  EXPECT_EQ(shop.finding(0).severity, Severity::kWarning);
  EXPECT_NE(shop.finding(0).text.find("5.98 mm"), std::string::npos);
  MotionList sound = start_at({19.1, 0, 2});
  sound.feed({19.1, 0, -20});
  EXPECT_EQ(BarShop(sound, "turn:0:2:85:5:6", bar).ids(), Ids{});
}

TEST(EdgeChecks, ABladeIsAlwaysInWithItsWholeFront) {
  MotionList program = start_at({30, 0, -20});
  program.feed({10, 0, -20});
  EXPECT_EQ(BarShop(program, "groove:3:edge=30", bar_profile(-60, 0, 50)).ids(), Ids{});
}

/// Up a taper of 30 degrees from the face to a cylinder of 40, along it.
MotionList taper(bool compensated) {
  MotionList program = start_at({14, 0, 2});
  program.feed({14, 0, 0}).feed({20, 0, -6 / std::tan(kPi / 6)});
  program.last().compensated = compensated;
  program.feed({20, 0, -30});
  return program;
}

TEST(NoseChecks, ATaperIsOffByTheNose) {
  // Of the taper's normal (sin 30, cos 30) the nose's centre, at 0.8 (1, 1), is 0.8 * 1.3660 from
  // the programmed line, and its rim 0.8 * 0.3660 off it.
  const TurnedProfile bar = bar_profile(-60, 0, 44);
  const BarShop shop(taper(false), "turn:0.8:2:85:5", bar);
  ASSERT_EQ(shop.ids(), Ids{"uncompensated"});
  const Finding& finding = shop.finding(0);
  EXPECT_EQ(finding.severity, Severity::kNote);
  EXPECT_NE(finding.text.find("0.293 mm"), std::string::npos) << finding.text;
  EXPECT_EQ(finding.source.line, 3U);
  EXPECT_EQ(BarShop(taper(true), "turn:0.8:2:85:5", bar).ids(), Ids{});
}

TEST(NoseChecks, CylindersAndFacesAreRight) {
  MotionList program = start_at({20, 0, 2});
  program.feed({20, 0, -20}).feed({26, 0, -20});
  EXPECT_EQ(BarShop(program, "turn:0.8:2:85:5", bar_profile(-60, 0, 44)).ids(), Ids{});
}

TEST(NoseChecks, AnArcIsOffMostWhereItLeans) {
  // A quarter from the face to a cylinder, convex: at 45 degrees the rim is 0.8 (sqrt 2 - 1) off.
  MotionList program = start_at({10, 0, 0});
  program.feed({10, 0, 0}).arc({20, 0, -10}, {10, 0, -10}, {0, 1, 0}, kPi / 2);
  const BarShop shop(program, "turn:0.8:2:85:5", bar_profile(-60, 0, 44));
  ASSERT_EQ(shop.ids(), Ids{"uncompensated"});
  EXPECT_NE(shop.finding(0).text.find("0.331 mm"), std::string::npos) << shop.finding(0).text;
}

TEST(NoseChecks, WhatIsCutAwayLaterIsNoError) {
  MotionList program = start_at({14, 0, 0});
  program.feed({14, 0, 0}).feed({20, 0, -10}).feed({20, 0, -30}).traverse({30, 0, 2});
  program.traverse({12, 0, 2}).feed({12, 0, -30});
  EXPECT_EQ(BarShop(program, "turn:0.8:2:85:5", bar_profile(-60, 0, 44)).ids(), Ids{});
}

}  // namespace
}  // namespace kerf
