// Driven tools on a lathe: what they cut with C, A and Y, what is told of them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "stock/cutter/shape_spec.h"
#include "stock/millturn/mill_turn.h"
#include "tests/twin/process/motions.h"
#include "twin/job/stock_choice.h"
#include "twin/process/cut_stage.h"
#include "twin/process/process_table.h"

namespace kerf {
namespace {

using Ids = std::vector<std::string>;

constexpr double kBar_mm3 = kPi * 400 * 50;

/// A bar 40 x 50 from Z-50 to Z0, with an insert (1), a driven end mill of 6 along Z (2), one along
/// X (3), one of 20 along X (4), and one that nobody has said to be driven (5).
class MillTurnShop {
 public:
  explicit MillTurnShop(const MotionList& program,
                        std::shared_ptr<const MachineKinematics> machine = nullptr)
      : resolver_(tools(), stock_model(StockKind::kTurning).can_cut) {
    MillTurnOptions options;
    options.cell_mm = 0.25;
    TurningStock bar(*TurnedPart::create(bar_profile(-50, 0, 40)));
    stock_ = std::move(MillTurn::create(std::move(bar), options).value());
    TimelineOptions timing;
    timing.kinematics = std::move(machine);
    ProcessWish wish;
    wish.is_turned = true;
    stage_ = std::make_unique<CutStage>(*stock_, resolver_, log_, timing, *choose_process(wish));
    stage_->set_frame({});
    stage_->judge_blank(BlankKind::kGiven);
    stage_->take(program.list());
    stage_->finish();
  }
  Ids ids() const {
    Ids out;
    for (const Finding& finding : log_.kept()) out.emplace_back(to_string(finding.id));
    return out;
  }
  const Finding& finding(std::size_t i) const { return log_.kept().at(i); }
  const CutStage& stage() const { return *stage_; }
  const MillTurn& stock() const { return *stock_; }
  double removed_mm3() const { return stock_->blank_mm3() - stock_->remaining_mm3(); }

 private:
  static ToolSources tools() {
    ToolSources sources;
    sources.turning = true;
    int number = 0;
    for (const char* const shape :
         {"turn:0:2:85:30:20", "flat:6:live=z", "flat:6:live=x", "flat:20:live=x", "flat:6"})
      sources.arguments.push_back({++number, *parse_shape(shape)});
    return sources;
  }

  std::unique_ptr<MillTurn> stock_;
  FindingLog log_;
  ToolResolver resolver_;
  std::unique_ptr<CutStage> stage_;
};

MotionList start(int tool) {
  MotionList program;
  program.at({30, 0, 5}).tool(tool).spindle(true).feed_rate(500);
  return program;
}

/// A feed during which A B C go from one angle to the other.
void turn(MotionList& program, const Vec3& to, const std::array<double, 3>& from_abc,
          const std::array<double, 3>& to_abc) {
  program.turned(from_abc).feed(to);
  program.last().to_abc_deg = to_abc;
  program.turned(to_abc);
}

TEST(MillTurnStage, HolesBesideTheAxisByC) {
  MotionList program = start(2);
  for (const double deg : {0.0, 90.0, 180.0, 270.0}) {
    program.turned({0, 0, deg}).traverse({12, 0, 2}).feed({12, 0, -10}).traverse({12, 0, 2});
  }
  const MillTurnShop shop(program);
  EXPECT_EQ(shop.ids(), Ids{});
  EXPECT_NEAR(shop.removed_mm3(), 4 * kPi * 9 * 10, 2);
  const ToolUse& use = shop.stage().tools().at(0);
  EXPECT_NEAR(use.removed_mm3, shop.removed_mm3(), 0.5);
  EXPECT_NEAR(use.max_depth_mm, 10, 0.3);
  // 4 x 12 mm at 500 mm/min; it counts as cutting over whole moves.
  EXPECT_NEAR(use.cut_s, 48 / 500.0 * 60, 0.5);
}

TEST(MillTurnStage, ItIsTheWorkpieceThatTurns) {
  // Positive C: the tool, as the part sees it, goes right-handed about Z.
  MotionList program = start(2);
  program.turned({0, 0, 90}).traverse({12, 0, 2}).feed({12, 0, -10}).traverse({12, 0, 2});
  const MillTurnShop shop(program);
  CutMove probe;
  probe.from_mm = {0, 12, -1};
  probe.to_mm = {0, 12, -2};
  CutMove other = probe;
  other.from_mm.y = other.to_mm.y = -12;
  EXPECT_FALSE(shop.stock().first_contact(*parse_shape("flat:5:live=z"), probe, 1e-3));
  EXPECT_TRUE(shop.stock().first_contact(*parse_shape("flat:5:live=z"), other, 1e-3));
}

TEST(MillTurnStage, ARingGrooveByTurningC) {
  // A groove of 6 at radius 12 in the face, 3 deep, by a whole turn of C; and with A in its place.
  const double groove_mm3 = kPi * (15 * 15 - 9 * 9) * 3;
  for (const bool is_a : {false, true}) {
    MotionList program = start(2);
    program.traverse({12, 0, 2}).feed({12, 0, -3});
    const std::array<double, 3> whole{is_a ? 360.0 : 0.0, 0, is_a ? 0.0 : 360.0};
    turn(program, {12, 0, -3}, {0, 0, 0}, whole);
    program.traverse({12, 0, 2});
    const MillTurnShop shop(program);
    EXPECT_EQ(shop.ids(), Ids{}) << is_a;
    EXPECT_NEAR(shop.removed_mm3(), groove_mm3, 2e-3 * groove_mm3) << is_a;
  }
}

TEST(MillTurnStage, AGrooveRoundTheBarByARadialTool) {
  // An end mill of 6 along X goes round by C, the middle of its front at 18 from the axis: it
  // leaves a floor of that radius, 6 wide. The tip's way is chords that keep within 0.01 mm of the
  // circle, on its inner side.
  const double groove_mm3 = kPi * (400 - 324) * 6;
  MotionList program = start(3);
  program.traverse({25, 0, -20}).feed({18, 0, -20});
  turn(program, {18, 0, -20}, {0, 0, 0}, {0, 0, 360});
  program.traverse({25, 0, -20});
  const MillTurnShop shop(program);
  EXPECT_EQ(shop.ids(), Ids{});
  EXPECT_NEAR(shop.removed_mm3(), groove_mm3, 0.01 * 2 * kPi * 18 * 6);
}

TEST(MillTurnStage, AFlatByY) {
  MotionList program = start(4);
  program.traverse({15, -35, -10}).feed({15, 35, -10}).traverse({30, 35, -10});
  const MillTurnShop shop(program);
  EXPECT_EQ(shop.ids(), Ids{});
  const double segment_mm2 = 400 * std::acos(0.75) - 15 * std::sqrt(400.0 - 225);
  EXPECT_NEAR(shop.removed_mm3(), segment_mm2 * 20, 1e-3 * segment_mm2 * 20);
}

TEST(MillTurnStage, TurnedAndMilledAndTurned) {
  MotionList program = start(1);
  program.traverse({18, 0, 2}).feed({18, 0, -30}).feed({25, 0, -30}).traverse({30, 0, 5}).tool(2);
  program.traverse({12, 0, 2}).feed({12, 0, -10}).traverse({12, 0, 2}).traverse({30, 0, 5}).tool(1);
  program.traverse({16, 0, 2}).feed({16, 0, -20}).feed({25, 0, -20});
  const MillTurnShop shop(program);
  EXPECT_EQ(shop.ids(), Ids{});
  // The hole reaches to 15 from the axis: all of it is in what is left.
  const double left = kPi * (256 * 20 + 324 * 10 + 400 * 20 - 9 * 10);
  EXPECT_NEAR(shop.stock().remaining_mm3(), left, 1e-4 * left);
  ASSERT_EQ(shop.stage().tools().size(), 2U);
}

TEST(MillTurnStage, ATraverseOfADrivenToolThroughTheBarIsTold) {
  MotionList program = start(3);
  program.traverse({25, 0, -20}).traverse({17, 0, -20}).feed({17, 0, -25}).traverse({30, 0, -25});
  const MillTurnShop shop(program);
  ASSERT_EQ(shop.ids(), Ids{"rapid-contact"});
  EXPECT_EQ(shop.finding(0).source.line, 3U);
  EXPECT_NEAR(shop.finding(0).position_mm->x, 20, 0.3);
}

TEST(MillTurnStage, ATraverseOverWhatWasMilledIsSound) {
  MotionList program = start(3);
  program.traverse({17, 0, 10}).feed({17, 0, -25}).traverse({17, 0, 10}).traverse({17, 0, -25});
  EXPECT_EQ(MillTurnShop(program).ids(), Ids{});
}

TEST(MillTurnStage, AStandingSpindleIsTold) {
  MotionList program = start(3);
  program.spindle(false).traverse({25, 0, -20}).feed({17, 0, -20});
  EXPECT_EQ(MillTurnShop(program).ids(), Ids{"spindle-off-contact"});
}

TEST(MillTurnStage, ADrivenToolHasASpindleOfItsOwn) {
  MotionList program = start(3);
  program.spindle(false).spindles(2);  // M5 $0, M3 $1
  program.traverse({25, 0, -20}).feed({17, 0, -20}).traverse({30, 0, -20});
  EXPECT_EQ(MillTurnShop(program).ids(), Ids{});
}

TEST(MillTurnStage, ThreadsOfAMilledPartAreTold) {
  const auto program_of = [](bool mills) {
    MotionList program = start(1);
    program.traverse({19, 0, 3}).feed({19, 0, -20});
    Motion& thread = program.last();
    thread.kind = MotionKind::kThread;
    thread.feed_mm_per_min = 2;  // a turn
    program.traverse({30, 0, -20}).traverse({30, 0, 5}).tool(2);
    program.traverse({10, 0, 2}).feed({10, 0, mills ? -10.0 : 1.0}).traverse({10, 0, 2});
    return program;
  };
  const auto tells = [](const MillTurnShop& shop) {
    const Ids ids = shop.ids();
    return std::count(ids.begin(), ids.end(), "not-simulated");
  };
  const MillTurnShop milled(program_of(true)), turned(program_of(false));
  EXPECT_EQ(tells(milled), 1);
  EXPECT_EQ(tells(turned), 0);
  EXPECT_GT(turned.removed_mm3(), 1);
  EXPECT_NEAR(milled.removed_mm3() - turned.removed_mm3(), kPi * 9 * 10, 1);
}

TEST(MillTurnStage, TurnMillingIsNotModelled) {
  MotionList program = start(3);
  program.spindles(3).traverse({25, 0, -20}).feed({17, 0, -20});
  const MillTurnShop shop(program);
  EXPECT_EQ(shop.ids(), (Ids{"not-modelled", "nothing-cut"}));
  EXPECT_EQ(shop.removed_mm3(), 0);
}

TEST(MillTurnStage, AToolThatNobodyDrivesIsNotModelledWhileCTurns) {
  MotionList program = start(5);
  program.traverse({12, 0, 2}).feed({12, 0, -3});
  turn(program, {12, 0, -3}, {0, 0, 0}, {0, 0, 90});
  const MillTurnShop shop(program);
  ASSERT_EQ(shop.ids(), Ids{"not-modelled"});
  EXPECT_NE(shop.finding(0).hint.find("live=z"), std::string::npos);
  // C that turns while nothing cuts is none of that.
  MotionList sound = start(1);
  sound.turned({0, 0, 0}).traverse({18, 0, 2});
  sound.last().to_abc_deg = {0, 0, 90};
  sound.turned({0, 0, 90}).feed({18, 0, -10});
  EXPECT_EQ(MillTurnShop(sound).ids(), Ids{});
}

TEST(MillTurnStage, KinematicsThatAreSwitchedAreNotFollowed) {
  const auto machine =
      std::make_shared<const MachineKinematics>(known_machine("millturn", "XYZA", {}, {}).value());
  MotionList program = start(3);
  program.traverse({25, 0, -20}).feed({17, 0, -20});
  EXPECT_EQ(MillTurnShop(program, machine).ids(), (Ids{"not-modelled", "nothing-cut"}));
  const auto plain = std::make_shared<const MachineKinematics>(
      known_machine("trivkins coordinates=XZC", "XZC", {}, {}).value());
  EXPECT_EQ(MillTurnShop(program, plain).ids(), Ids{});
}

}  // namespace
}  // namespace kerf
