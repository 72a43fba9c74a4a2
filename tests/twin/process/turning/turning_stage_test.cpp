#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "stock/cutter/insert_shape.h"
#include "stock/turning/thread_gauge.h"
#include "stock/turning/turning_stock.h"
#include "tests/twin/process/motions.h"
#include "twin/job/stock_choice.h"
#include "twin/process/cut_stage.h"
#include "twin/process/engagement_log.h"
#include "twin/process/process_table.h"

namespace kerf {
namespace {

using Ids = std::vector<std::string>;

constexpr double kDeg = kPi / 180;

Cutter nose(double radius_mm, int orientation, double front_deg, double back_deg) {
  NoseInsert insert;
  insert.radius_mm = radius_mm;
  insert.orientation = orientation;
  insert.front_rad = front_deg * kDeg;
  insert.back_rad = back_deg * kDeg;
  insert.edge_mm = 12;
  return Cutter::from_insert("nose", *nose_insert(insert));
}

Cutter blade(double width_mm) {
  GrooveInsert insert;
  insert.width_mm = width_mm;
  insert.length_mm = 30;
  return Cutter::from_insert("blade", *groove_insert(insert));
}

/// A bar 40 x 60 from Z-60 to Z0 under an 80 degree insert (1), whose flanks are 5 degrees off face
/// and axis, and a blade of 3 mm (2).
class LatheShop {
 public:
  explicit LatheShop(const MotionList& program, double nose_mm = 0,
                     EngagementLog* engagement = nullptr)
      : stock_(*TurnedPart::create(bar_profile(-60, 0, 40))),
        resolver_(tools(nose_mm), stock_model(StockKind::kTurning).can_cut),
        stage_(stock_, resolver_, log_, TimelineOptions{}, *choose_process(wish())) {
    stage_.judge_blank(BlankKind::kGiven);
    if (engagement != nullptr) stage_.log_engagement(*engagement);
    stage_.take(program.list());
    stage_.finish();
  }
  Ids ids() const {
    Ids out;
    for (const Finding& finding : log_.kept()) out.emplace_back(to_string(finding.id));
    return out;
  }
  const Finding& finding(std::size_t i) const { return log_.kept().at(i); }
  const CutStage& stage() const { return stage_; }
  const TurningStock& stock() const { return stock_; }
  double removed_mm3() const { return stock_.blank_mm3() - stock_.remaining_mm3(); }

 private:
  static ToolSources tools(double nose_mm) {
    ToolSources sources;
    sources.turning = true;
    sources.arguments.push_back({1, nose(nose_mm, 2, 85, 5)});
    sources.arguments.push_back({2, blade(3)});
    sources.arguments.push_back(
        {4, Cutter::from_insert("thread:60", *thread_insert({60 * kDeg, 0.3, 3, 6}))});
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

MotionList start(int tool = 1) {
  MotionList program;
  program.at({30, 0, 5}).tool(tool).spindle(true);
  return program;
}

TEST(TurningStage, ACylinderIsWhatItsDiameterSays) {
  MotionList program = start();
  program.traverse({15, 0, 2}).feed({15, 0, -30}).traverse({25, 0, -29}).traverse({30, 0, 5});
  const LatheShop shop(program);
  EXPECT_EQ(shop.ids(), Ids{});
  // The shoulder slants by the 5 degrees that the front flank is off the face.
  const double slant_mm3 = 2 * kPi * std::tan(5 * kDeg) * ((8000 - 3375) / 3.0 - 7.5 * 175);
  EXPECT_NEAR(shop.removed_mm3(), kPi * 175 * 30 - slant_mm3, 1e-6 * kPi * 400 * 60);
  ASSERT_EQ(shop.stage().tools().size(), 1U);
  const ToolUse& use = shop.stage().tools()[0];
  EXPECT_NEAR(use.max_depth_mm, 5, 0.01);
  EXPECT_NEAR(use.removed_mm3, shop.removed_mm3(), 1e-6);
  EXPECT_NEAR(use.feed_mm, 32, 1e-9);
}

TEST(TurningStage, CuttingTimeIsThatInMaterial) {
  MotionList program = start();
  program.traverse({15, 0, 30}).feed_rate(600).feed({15, 0, -30});
  const ToolUse use = LatheShop(program).stage().tools()[0];
  EXPECT_NEAR(use.cut_s, 3, 0.06);  // 30 of 60 mm at 10 mm/s
  EXPECT_NEAR(use.peak_mm3_per_s, kPi * (400 - 225) * 10, kPi * 175 * 10 * 0.02);
}

TEST(TurningStage, HowItWasEngagedIsTold) {
  // 30 mm in air, 30 mm 5 mm deep; 600 mm/min at 500 turns: 1.2 mm a turn, on a flank that leans by
  // 5 degrees. A thread is fed by its lead, and not measured.
  MotionList program = start();
  program.rpm(500).traverse({15, 0, 30}).feed_rate(600).feed({15, 0, -30});
  program.traverse({30, 0, -30}).traverse({30, 0, 5}).tool(4).traverse({14.9, 0, 5});
  program.thread({14.9, 0, -10}, 1);
  EngagementLog log(true);
  const LatheShop shop(program, 0, &log);
  const Engagement found = log.result();
  ASSERT_EQ(found.turned.size(), 1U);
  const TurningEngagement& turned = found.turned[0];
  EXPECT_EQ(turned.tool, 1);
  EXPECT_NEAR(turned.cut_mm, 30, 0.5);
  EXPECT_NEAR(turned.air_mm, 30, 0.5);
  EXPECT_NEAR(turned.cut_s, 3, 0.1);
  EXPECT_NEAR(turned.mean(turned.depth_sum_mm2), 5, 0.01);
  EXPECT_NEAR(turned.feed_most_mm, 1.2, 0.02);
  EXPECT_NEAR(turned.chip_most_mm, turned.feed_most_mm * std::cos(5 * kDeg), 1e-3);
  EXPECT_NEAR(turned.rate_mm3_per_s(), kPi * (400 - 225) * 10, kPi * 175 * 10 * 0.03);
  EXPECT_NEAR(found.unmeasured_mm, 15, 1);
  EXPECT_FALSE(found.map.has_value());
}

TEST(TurningStage, ATraverseThroughTheBarIsTold) {
  MotionList program = start();
  program.traverse({15, 0, 2}).traverse({15, 0, -30});
  const LatheShop shop(program);
  ASSERT_EQ(shop.ids(), Ids{"rapid-contact"});
  const Finding& finding = shop.finding(0);
  EXPECT_EQ(finding.source.line, 3U);
  EXPECT_NEAR(finding.position_mm->z, -0.01, 0.002);
  EXPECT_NEAR(*finding.depth_mm, 5, 0.02);
}

TEST(TurningStage, AStandingSpindleIsTold) {
  MotionList program = start();
  program.traverse({15, 0, 2}).spindle(false).feed({15, 0, -30});
  EXPECT_EQ(LatheShop(program).ids(), Ids{"spindle-off-contact"});
}

TEST(TurningStage, TheTrailingFlankOfASteepContourIsTold) {
  // The back flank runs 5 degrees off the axis: a contour that falls by 20 degrees is too steep.
  MotionList steep = start();
  steep.traverse({18, 0, 2}).feed({18, 0, -10}).feed({18 - 10 * std::tan(20 * kDeg), 0, -20});
  EXPECT_EQ(LatheShop(steep).ids(), Ids{"flank-contact"});
  MotionList sound = start();
  sound.traverse({18, 0, 2}).feed({18, 0, -10}).feed({18 - 10 * std::tan(4 * kDeg), 0, -20});
  EXPECT_EQ(LatheShop(sound).ids(), Ids{});
  MotionList rising = start();
  rising.traverse({15, 0, 2}).feed({15, 0, -10}).feed({18, 0, -20}).feed({22, 0, -20});
  EXPECT_EQ(LatheShop(rising).ids(), Ids{});
}

TEST(TurningStage, FacesAndGroovesAreNoFlanks) {
  MotionList program = start();
  program.traverse({22, 0, -1}).feed({0, 0, -1}).traverse({0, 0, 2}).traverse({30, 0, 2}).tool(2);
  program.traverse({30, 0, -20}).traverse({21, 0, -20}).feed({12, 0, -20}).feed({21, 0, -20});
  EXPECT_EQ(LatheShop(program).ids(), Ids{});
}

TEST(TurningStage, WhatIsNoEdgeMustNotTouch) {
  // Out of a groove towards +z the back of the insert goes first.
  MotionList program = start();
  program.traverse({30, 0, -20}).feed({15, 0, -20}).feed({15, 0, -10});
  // Into it the whole flank along the axis cuts, and it ends there.
  EXPECT_EQ(LatheShop(program).ids(), (Ids{"over-depth", "flank-contact"}));
  EXPECT_EQ(LatheShop(program).finding(1).severity, Severity::kError);
}

TEST(TurningStage, ABladeThatGoesFarBeyondTheAxisIsTold) {
  MotionList program = start(2);
  program.traverse({21, 0, -20}).feed({-2, 0, -20});
  EXPECT_EQ(LatheShop(program).ids(), Ids{"past-centre"});
}

TEST(TurningStage, APipIsToldOfANoseThatStopsAtTheAxis) {
  MotionList short_of = start();
  short_of.traverse({22, 0, -1}).feed({0, 0, -1}).traverse({0, 0, 2});
  const LatheShop shop(short_of, 0.8);
  ASSERT_EQ(shop.ids(), Ids{"pip-left"});
  // The nose rises from the face by 0.02 at sqrt(0.8^2 - 0.78^2) from its middle, which stands 0.8
  // from the axis.
  EXPECT_NEAR(shop.finding(0).position_mm->x, 0.8 - std::sqrt(0.64 - 0.6084), 0.002);
  MotionList beyond = start();
  beyond.traverse({22, 0, -1}).feed({-0.8, 0, -1}).traverse({-0.8, 0, 2});
  EXPECT_EQ(LatheShop(beyond, 0.8).ids(), Ids{});
}

TEST(TurningStage, WhatIsPartedOffFalls) {
  MotionList program = start(2);
  program.traverse({21, 0, -20}).feed({-0.1, 0, -20}).traverse({21, 0, -20});
  const LatheShop shop(program);
  EXPECT_EQ(shop.ids(), Ids{});
  const auto pieces = shop.stage().process().fallen();
  ASSERT_EQ(pieces.size(), 1U);
  // The controlled point is the corner towards -z: the blade takes Z-20 to Z-17.
  EXPECT_NEAR(pieces[0].piece.volume_mm3, kPi * 400 * 17, 0.1);
  EXPECT_EQ(pieces[0].source.line, 3U);
  EXPECT_EQ(pieces[0].tool, 2);
}

TEST(TurningStage, AnArcInAnotherPlaneIsToldOnce) {
  MotionList program = start();
  program.traverse({15, 0, 2}).feed({15, 0, -5});
  program.arc({15, 10, -5}, {15, 5, -5}, {0, 0, 1}, kPi)
      .arc({15, 0, -5}, {15, 5, -5}, {0, 0, 1}, kPi);
  EXPECT_EQ(LatheShop(program).ids(), Ids{"wrong-plane"});
}

TEST(TurningStage, WhatIsMilledBesideTheAxisIsNotModelled) {
  MotionList program = start();
  program.traverse({15, 0, 2}).feed({15, 3, 2});
  EXPECT_EQ(LatheShop(program).ids(), (Ids{"not-modelled", "nothing-cut"}));
}

TEST(TurningStage, NothingCutIsTold) {
  MotionList program = start();
  program.traverse({25, 0, 2}).feed({25, 0, -30});
  EXPECT_EQ(LatheShop(program).ids(), Ids{"nothing-cut"});
}

/// A pass of G76 with both ends slanting (E, L3), as LinuxCNC's interpreter gives it: into the
/// entry, the entry and the way out have a lead along their ways that keeps that along the axis.
void g76_pass(MotionList& program, double depth) {
  const double in = depth * std::tan(29.5 * kDeg), x = 20 - depth, slant = std::hypot(1.84, 3.0);
  program.traverse({24 - depth, 0, 8 - in})
      .thread({22 - depth, 0, 8 - in}, slant)
      .thread({x, 0, 5 - in}, slant)
      .thread({x, 0, -30 - in}, 3)
      .thread({22 - depth, 0, -33 - in}, slant)
      .traverse({24 - depth, 0, -33 - in});
}

TEST(TurningStage, PassesOfAThreadAreOneThread) {
  MotionList program = start(4);
  program.rpm(500);
  for (const double depth : {0.3, 0.7, 1.1, 1.5, 1.84, 1.84}) g76_pass(program, depth);
  const LatheShop shop(program);
  EXPECT_EQ(shop.ids(), Ids{});
  const std::vector<MeasuredThread> threads = measure_threads(shop.stock().part());
  ASSERT_EQ(threads.size(), 1U);
  EXPECT_TRUE(threads[0].is_right_hand);
  EXPECT_EQ(threads[0].starts, 1);
  EXPECT_NEAR(threads[0].lead_mm, 3, 1e-9);
  EXPECT_NEAR(threads[0].major_mm, 40, 1e-3);
  EXPECT_NEAR(threads[0].minor_mm, 40 - 2 * 1.84, 1e-3);
  EXPECT_NEAR(threads[0].angle_rad, 60 * kDeg, 1e-4);
  // What leads in through the air, and is not cut, counts for where the groove is.
  MotionList last = start(4);
  last.rpm(500);
  g76_pass(last, 1.84);
  const LatheShop once(last);
  EXPECT_NEAR(once.stock().remaining_mm3(), shop.stock().remaining_mm3(), 1e-6);
  EXPECT_EQ(once.stock().part().threads().passes().size(),
            shop.stock().part().threads().passes().size());
}

/// A pass as a machine is seen to make it: in pieces, by the same line as all others.
void seen_pass(MotionList& program, double start_z, double piece_mm) {
  const double x = 18.8;
  program.traverse({24, 0, start_z}).traverse({x, 0, start_z});
  for (double z = start_z; z > -30;) {
    z = std::max(z - piece_mm, -30.0);
    program.thread({x, 0, z}, 4);
    program.last().source.line = 18;
  }
  program.traverse({24, 0, -30});
}

TEST(TurningStage, StartsAreToldApartByWhatIsSeenInTheAir) {
  // A lead of 4 in two starts asks for 0.6134 * 2 = 1.227 mm, a twentieth less is 1.166; one start
  // asks for 2.454. The insert is 3 mm wide: what is farther from the bar cannot touch it.
  MotionList two = start(4), one = start(4);
  two.rpm(500);
  one.rpm(500);
  seen_pass(two, 8, 0.37);
  seen_pass(two, 10, 0.29);
  EXPECT_EQ(LatheShop(two).ids(), Ids{});
  seen_pass(one, 8, 0.37);
  seen_pass(one, 12, 0.29);
  const LatheShop told(one);
  ASSERT_EQ(told.ids(), Ids{"thread-shallow"});
  EXPECT_EQ(told.finding(0).position_mm, Vec3(18.8, 0, 8)) << "where the pass begins";
  EXPECT_NE(told.finding(0).text.find("ask for 2.454"), std::string::npos) << told.finding(0).text;
}

TEST(TurningStage, M4LeavesALeftHandThread) {
  MotionList program = start(4);
  program.rpm(500);
  program.traverse({18.7, 0, 5});
  program.thread({18.7, 0, -30}, 2);
  program.last().spindle = SpindleState::kCounterclockwise;
  program.traverse({30, 0, -30});
  const LatheShop shop(program);
  EXPECT_EQ(shop.ids(), Ids{});  // out of where it has stopped, too
  const std::vector<MeasuredThread> threads = measure_threads(shop.stock().part());
  ASSERT_EQ(threads.size(), 1U);
  EXPECT_FALSE(threads[0].is_right_hand);
}

}  // namespace
}  // namespace kerf
