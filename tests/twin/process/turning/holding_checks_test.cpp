#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "stock/cutter/insert_shape.h"
#include "stock/cutter/shape_spec.h"
#include "stock/turning/turning_stock.h"
#include "tests/twin/process/motions.h"
#include "twin/job/stock_choice.h"
#include "twin/process/cut_stage.h"
#include "twin/process/process_table.h"

namespace kerf {
namespace {

constexpr double kDegree = kPi / 180;

/// An 80 degree insert whose flanks are 5 degrees off face and axis, its edges 12 mm.
Cutter sharp_insert() {
  return Cutter::from_insert("sharp", *nose_insert({0, 2, 85 * kDegree, 5 * kDegree, 12}));
}

/// The same in a shank, from 10 mm above the tip on: Z-8 to Z20 of the tip.
Cutter held_insert() {
  InsertOutline outline = *nose_insert({0, 2, 85 * kDegree, 5 * kDegree, 12});
  InsertPart shank;
  for (const Vec2& corner : {Vec2(-8, 10), Vec2(20, 10), Vec2(20, 100), Vec2(-8, 100)})
    shank.push_back({corner, std::nullopt, InsertSide::kBody});
  outline.parts.push_back(shank);
  return Cutter::from_insert("held", outline);
}

/// A bar 40 x 60 from Z-60 to Z0 in a chuck of 160 mm with its face at Z-60, jaws to 120 mm and
/// Z-35.
class ChuckShop {
 public:
  explicit ChuckShop(const MotionList& program, Cutter cutter = sharp_insert(),
                     const char* tailstock = "", std::vector<NamedPair> ignored = {})
      : stock_(*TurnedPart::create(bar_profile(-60, 0, 40))),
        resolver_(tools(std::move(cutter)), stock_model(StockKind::kTurning).can_cut),
        stage_(stock_, resolver_, log_, TimelineOptions{}, *choose_process(wish())) {
    CheckOptions options;
    options.collisions.holding.chuck = *parse_chuck("160:80:120:25");
    if (*tailstock) options.collisions.holding.tailstock = *parse_tailstock(tailstock);
    options.collisions.rules.ignored = std::move(ignored);
    Diagnostics diagnostics;
    EXPECT_TRUE(hold_workpiece(options.collisions.holding, nullptr, stock_, true,
                               options.collisions.held_by, diagnostics));
    stage_.check_by(options);
    stage_.judge_blank(BlankKind::kUnjudged);
    stage_.take(program.list());
    stage_.finish();
  }
  std::vector<std::string> ids() const {
    std::vector<std::string> out;
    for (const Finding& finding : log_.kept()) out.emplace_back(to_string(finding.id));
    return out;
  }
  const Finding& finding(std::size_t i) const { return log_.kept().at(i); }
  CollisionPair pair(const std::string& other, ToolPart part = ToolPart::kCutter) const {
    for (const CollisionPair& row : stage_.process().collisions())
      if (row.other == other && row.part == part) return row;
    ADD_FAILURE() << other;
    return {};
  }

 private:
  static ToolSources tools(Cutter cutter) {
    ToolSources sources;
    sources.turning = true;
    sources.arguments.push_back({1, std::move(cutter)});
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

using Ids = std::vector<std::string>;

MotionList begin() {
  MotionList program;
  program.at({80, 0, 5}).tool(1).spindle(true);
  return program;
}

TEST(HoldingChecks, ATraverseIntoTheJawsIsTold) {
  MotionList program = begin();
  program.traverse({30, 0, 5}).traverse({30, 0, -40});
  const ChuckShop shop(program);
  ASSERT_EQ(shop.ids(), Ids{"jaw-contact"});
  const Finding& finding = shop.finding(0);
  EXPECT_EQ(finding.severity, Severity::kError);
  EXPECT_EQ(finding.source.line, 3U);
  EXPECT_NEAR(finding.position_mm->z, -35, 1e-3);
  EXPECT_NEAR(finding.position_mm->x, 30, 1e-9);
  EXPECT_NEAR(*finding.depth_mm, 5, 0.01);
  EXPECT_EQ(finding.bodies, (std::array<std::string, 2>{"cutter", "jaws"}));
  EXPECT_EQ(shop.pair("jaws").contacts, 1U);
  EXPECT_EQ(shop.pair("jaws").least_clearance_mm, 0);
}

TEST(HoldingChecks, BesideTheJawsNothingIs) {
  MotionList program = begin();
  program.traverse({30, 0, 5}).traverse({30, 0, -34});
  const ChuckShop shop(program);
  EXPECT_EQ(shop.ids(), Ids{});
  EXPECT_NEAR(*shop.pair("jaws").least_clearance_mm, 1, 2e-4);
  EXPECT_EQ(shop.pair("jaws").source.line, 3U);
  EXPECT_NEAR(*shop.pair("chuck").least_clearance_mm, 26, 2e-4);
}

TEST(HoldingChecks, AFeedThatEndsBeforeTheJaws) {
  // The jaws' inner corner is 5 before the tip and 5 above it: as far from the flank as
  // 5 (sin 85 + cos 85).
  MotionList program = begin();
  program.traverse({15, 0, 5}).feed({15, 0, -30}).feed({25, 0, -30});
  const ChuckShop shop(program);
  EXPECT_EQ(shop.ids(), Ids{});
  const double flank_mm = 5 * (std::sin(85 * kDegree) + std::cos(85 * kDegree));
  // Out again the tip comes by the corner itself.
  EXPECT_NEAR(*shop.pair("jaws").least_clearance_mm, 5, 2e-4);
  EXPECT_GT(flank_mm, 5);
  EXPECT_EQ(shop.pair("jaws").source.line, 4U);
}

TEST(HoldingChecks, WhatComesNearIsNoted) {
  MotionList program = begin();
  program.traverse({30, 0, 5}).traverse({30, 0, -34.7}).traverse({80, 0, 5});
  const ChuckShop shop(program);
  ASSERT_EQ(shop.ids(), Ids{"near-miss"});
  EXPECT_EQ(shop.finding(0).severity, Severity::kNote);
  EXPECT_EQ(shop.finding(0).text, "the tool comes as near as 0.30 mm to the jaws of the chuck");
  EXPECT_NEAR(shop.finding(0).position_mm->z, -34.7, 1e-3);
}

TEST(HoldingChecks, AFeedIntoTheChuckIsTold) {
  MotionList program = begin();
  program.traverse({70, 0, 5}).feed({70, 0, -62});
  const ChuckShop shop(program);
  ASSERT_EQ(shop.ids(), Ids{"chuck-contact"});
  EXPECT_NEAR(shop.finding(0).position_mm->z, -60, 1e-3);
  EXPECT_NEAR(*shop.finding(0).depth_mm, 2, 0.01);
  EXPECT_NEAR(*shop.pair("jaws").least_clearance_mm, 10, 2e-4);
}

TEST(HoldingChecks, WhetherTheSpindleTurnsIsAllTheSame) {
  MotionList program;
  program.at({80, 0, 5}).tool(1).spindle(false);
  program.traverse({30, 0, 5}).traverse({30, 0, -40});
  EXPECT_EQ(ChuckShop(program).ids(), Ids{"jaw-contact"});
}

TEST(HoldingChecks, AnEventEndsWithTheFirstTraverseThatIsClear) {
  MotionList program = begin();
  program.traverse({30, 0, 5}).feed({30, 0, -36}).feed({30, 0, -37}).traverse({30, 0, -30});
  program.traverse({30, 0, -20}).feed({30, 0, -38});
  const ChuckShop shop(program);
  ASSERT_EQ(shop.ids(), (Ids{"jaw-contact", "jaw-contact"}));
  EXPECT_NEAR(*shop.finding(0).depth_mm, 2, 0.01);
  EXPECT_NEAR(*shop.finding(1).depth_mm, 3, 0.01);
  EXPECT_EQ(shop.pair("jaws").contacts, 2U);
}

TEST(HoldingChecks, AnArcIntoTheJaws) {
  // A quarter turn of radius 10 about Z-30 X40, from Z-30 X30 to Z-40 X40 (seen with z to the right
  // it goes clockwise): the tip is at Z-35 where the turn has gone by asin(1/2), of which the
  // finding's place is X = 40 - 10 cos 30.
  MotionList program = begin();
  program.traverse({30, 0, 5}).traverse({30, 0, -30});
  program.arc({40, 0, -40}, {40, 0, -30}, {0, -1, 0}, kPi / 2);
  const ChuckShop shop(program);
  ASSERT_EQ(shop.ids(), Ids{"jaw-contact"});
  EXPECT_NEAR(shop.finding(0).position_mm->z, -35, 0.01);
  EXPECT_NEAR(shop.finding(0).position_mm->x, 40 - 10 * std::cos(30 * kDegree), 0.02);
}

TEST(HoldingChecks, TheHolderIsLookedAtByItself) {
  // At X52 the shank begins at X62, above the jaws; at X48 it is before them and 8 mm ahead.
  MotionList clear = begin();
  clear.traverse({52, 0, 5}).traverse({52, 0, -33});
  EXPECT_EQ(ChuckShop(clear, held_insert()).ids(), Ids{});
  MotionList program = begin();
  program.traverse({48, 0, 5}).traverse({48, 0, -33});
  const ChuckShop shop(program, held_insert());
  ASSERT_EQ(shop.ids(), Ids{"jaw-contact"});
  EXPECT_EQ(shop.finding(0).bodies[0], "holder");
  EXPECT_NEAR(shop.finding(0).position_mm->z, -27, 1e-3);
  // 2 mm of it are below the jaws' rim.
  EXPECT_NEAR(*shop.finding(0).depth_mm, 2, 0.01);
  EXPECT_NEAR(*shop.pair("jaws").least_clearance_mm, 2, 2e-4);
  EXPECT_EQ(shop.pair("jaws", ToolPart::kHolder).contacts, 1U);
}

TEST(HoldingChecks, ATailstockIsInTheWayOfAFace) {
  // Facing the end at Z0: the far end of the flank that lies 5 degrees off the axis meets the cone.
  MotionList program = begin();
  program.traverse({22, 0, 5}).traverse({22, 0, 0}).feed({3, 0, 0});
  const ChuckShop shop(program, sharp_insert(), "30");
  ASSERT_EQ(shop.ids(), Ids{"fixture-contact"});
  const double far_z = 12 * std::cos(5 * kDegree), far_x = 12 * std::sin(5 * kDegree);
  const double cone = 20.0 / 3 + far_z * std::tan(30 * kDegree);
  EXPECT_NEAR(shop.finding(0).position_mm->x, cone - far_x, 2e-3);
  EXPECT_EQ(shop.finding(0).bodies[1], "tailstock");
  MotionList sound = begin();
  sound.traverse({22, 0, 5}).traverse({22, 0, 0}).feed({14, 0, 0});
  EXPECT_EQ(ChuckShop(sound, sharp_insert(), "30").ids(), Ids{});
}

TEST(HoldingChecks, ADrillMeetsTheTailstock) {
  MotionList program;
  program.at({0, 0, 30}).tool(1).spindle(true);
  program.traverse({0, 0, 20});
  EXPECT_EQ(ChuckShop(program, *parse_shape("drill:8:118"), "30").ids(), Ids{"fixture-contact"});
  MotionList without;
  without.at({0, 0, 30}).tool(1).spindle(true);
  without.traverse({0, 0, 20});
  EXPECT_EQ(ChuckShop(without, *parse_shape("drill:8:118")).ids(), Ids{});
}

TEST(HoldingChecks, PairsMayTouchIfSomebodySaysSo) {
  MotionList program = begin();
  program.traverse({30, 0, 5}).traverse({30, 0, -40});
  EXPECT_EQ(ChuckShop(program, sharp_insert(), "", {{"tool", "jaws"}}).ids(), Ids{});
}

}  // namespace
}  // namespace kerf
