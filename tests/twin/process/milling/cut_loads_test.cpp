// What is told of chips and forces, part by part of feed moves.
#include "twin/process/milling/cut_loads.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "cutting/tool_bending.h"
#include "stock/cutter/shape_spec.h"

namespace kerf {
namespace {

CuttingWish in_steel() {
  Material steel;
  steel.name = "steel";
  steel.kc11_n_per_mm2 = {1400, 2000, 3000};
  steel.mc = 0.2;
  steel.speed_carbide = SpeedRange{70, 250};
  CuttingWish wish;
  wish.material = steel;
  return wish;
}

EngagementLook slot(double deep_mm, double wide_mm = 10) {
  EngagementLook look;
  look.angle_rad = kPi, look.wide_mm = wide_mm, look.deep_mm = deep_mm;
  look.exit_rad = kPi, look.climb = 0.5, look.effective_mm = wide_mm;
  return look;
}

class CutLoadsTest : public testing::Test {
 protected:
  void run(const CuttingWish& wish, const std::string& shape, const EngagementLook& look,
           double seconds = 6, double rpm = 2000) {
    loads_.emplace(log_);
    loads_->set_wish(wish);
    mount(shape);
    rpm_ = rpm;
    take(look, seconds);
  }
  void mount(const std::string& shape) {
    const Cutter cutter = parse_shape(shape).value();
    shape_ = cutter.spec();
    loads_->mount(cutter, 1);
  }
  /// Of the tool that is mounted.
  std::shared_ptr<const ToolLoads> loads_of(int tool) const {
    return loads_->loads_of(tool, shape_);
  }
  /// At F400.
  void take(const EngagementLook& look, double seconds, double down_rad = 0) {
    ++line_;
    loads_->take({look,
                  {seconds * 400 / 60, seconds, down_rad},
                  {0, line_},
                  time_s_,
                  Vec3(line_),
                  rpm_,
                  400});
    time_s_ += seconds;
  }
  std::string told() {
    loads_->finish();
    std::string out;
    for (const Finding& one : log_.kept())
      out += std::string(to_string(one.id)) +
             (one.severity == Severity::kNote ? " note " : " worse ") +
             std::to_string(one.source.line) + "\n";
    return out;
  }

  FindingLog log_;
  std::optional<CutLoads> loads_;
  std::uint32_t line_ = 0;
  double time_s_ = 0, rpm_ = 0;
  std::string shape_;
};

/// 4 teeth, S2000, F400: 0.05 mm a tooth.
TEST_F(CutLoadsTest, ForcesAreThoseOfTheModel) {
  run(in_steel(), "flat:10:teeth=4:helix=45", slot(4));
  const Material steel = *in_steel().material;
  const MillingModel model(steel, EdgeProfile::cylinder(5, 0.2), {4, kPi / 4}, {});
  const MillingLoad load = model.load_of({0.05, 0, kPi, 4, 2000});
  const auto loads = loads_of(1);
  ASSERT_NE(loads, nullptr);
  EXPECT_NEAR(loads->chip_mm.most(), 0.05, 1e-9);
  EXPECT_NEAR(loads->force_most_n.nominal, load.force_n.nominal, 1e-9 * load.force_n.nominal);
  EXPECT_NEAR(loads->force_most_n.high, load.force_n.high, 1e-9 * load.force_n.high);
  EXPECT_NEAR(loads->torque_most_nm.low, load.torque_nm.low, 1e-9);
  EXPECT_NEAR(loads->power_most_kw.nominal, load.power_w.nominal / 1000, 1e-9);
  EXPECT_NEAR(loads->force_n.not_above(0.5), load.force_n.nominal, 0.03 * load.force_n.nominal);
  EXPECT_NEAR(loads->speed_m_per_min.most(), kPi * 20, 1e-9);
  EXPECT_FALSE(loads->has_bend) << "nobody has said how far it stands out";
  EXPECT_EQ(told(), "");
}

class Heard final : public LoadListener {
 public:
  void on_load(const CutLoad& load) override { loads.push_back(load); }
  void restart() override { loads.clear(); }
  std::vector<CutLoad> loads;
};

/// Who shows loads place by place is told what the report has, with the ends of ranges; the torque
/// is the mean of a turn, which over-torque goes by.
TEST_F(CutLoadsTest, ListenersHearTheSameOfEachPart) {
  run(in_steel(), "flat:10:teeth=4:helix=45:flute=20:holder=20x30:stickout=30", slot(4), 0);
  Heard heard;
  loads_->take({slot(4), {40, 6, 0}, {0, 9}, 12.5, Vec3(0), 2000, 400}, &heard);
  loads_->take({{}, {40, 6, 0}, {0, 10}, 18.5, Vec3(0), 2000, 400}, &heard);  // in the air
  ASSERT_EQ(heard.loads.size(), 2u);
  EXPECT_FALSE(heard.loads[1].is_engaged);
  EXPECT_EQ(heard.loads[1].of(LoadKind::kAngle).nominal, 0);
  const CutLoad& load = heard.loads[0];
  EXPECT_EQ(load.start_s, 12.5);
  EXPECT_EQ(load.seconds, 6);
  const MillingModel model(*in_steel().material, EdgeProfile::cylinder(5, 0.2), {4, kPi / 4}, {});
  const MillingLoad wanted = model.load_of({0.05, 0, kPi, 4, 2000});
  EXPECT_NEAR(load.of(LoadKind::kAngle).nominal, 180, 1e-9);
  EXPECT_NEAR(load.of(LoadKind::kChip).nominal, 0.05, 1e-9);
  EXPECT_NEAR(load.of(LoadKind::kForce).nominal, wanted.force_n.nominal, 1e-6);
  EXPECT_NEAR(load.of(LoadKind::kForce).high, wanted.force_n.high, 1e-6);
  EXPECT_NEAR(load.of(LoadKind::kTorque).nominal, wanted.torque_mean_nm.nominal, 1e-9);
  EXPECT_NEAR(load.of(LoadKind::kPower).high, wanted.power_w.high / 1000, 1e-9);
  EXPECT_NEAR(load.of(LoadKind::kBend).nominal, loads_of(1)->bend_most_mm.nominal, 1e-12);
  EXPECT_NEAR(load.of(LoadKind::kBend).high, loads_of(1)->bend_most_mm.high, 1e-12);
}

TEST_F(CutLoadsTest, WithoutTeethListenersHearOfTheAngleAlone) {
  run(in_steel(), "flat:10", slot(4), 0);
  Heard heard;
  loads_->take({slot(4), {40, 6, 0}, {0, 9}, 0, Vec3(0), 2000, 400}, &heard);
  ASSERT_EQ(heard.loads.size(), 1u);
  EXPECT_EQ(heard.loads[0].of(LoadKind::kAngle).nominal, 180);
  EXPECT_EQ(heard.loads[0].of(LoadKind::kChip).nominal, 0);
  EXPECT_EQ(heard.loads[0].of(LoadKind::kForce).nominal, 0);
}

TEST_F(CutLoadsTest, NothingIsKnownOfToolsWithoutTeeth) {
  run(in_steel(), "flat:10", slot(4));
  EXPECT_EQ(loads_of(1), nullptr);
}

TEST_F(CutLoadsTest, ChipsAloneAreKnownWithoutAMaterial) {
  run({}, "flat:10:teeth=4", slot(4));
  ASSERT_NE(loads_of(1), nullptr);
  EXPECT_FALSE(loads_of(1)->has_forces);
  EXPECT_NEAR(loads_of(1)->chip_mm.most(), 0.05, 1e-9);
}

/// A program may give one number two shapes, each with its own teeth: F400 at S2000.
TEST_F(CutLoadsTest, EachShapeOfANumberHasItsOwnLoads) {
  run({}, "flat:10:teeth=4", slot(4));
  mount("flat:6:teeth=2");
  take(slot(4, 6), 6);
  EXPECT_NEAR(loads_of(1)->chip_mm.most(), 0.1, 1e-9);
  EXPECT_NEAR(loads_of(1)->speed_m_per_min.most(), kPi * 12, 1e-9);
  mount("flat:10:teeth=4");
  EXPECT_NEAR(loads_of(1)->chip_mm.most(), 0.05, 1e-9);
  EXPECT_EQ(loads_->loads_of(1, "flat:8"), nullptr);
}

/// As it stands in the holder: 40 mm, 22 of them flutes.
TEST_F(CutLoadsTest, ToolsBendByWhatTheyStandOut) {
  CuttingWish wish = in_steel();
  wish.most_bend_mm = 1e-6;
  run(wish, "flat:10:flute=22:holder=er20:stickout=40:teeth=4", slot(4));
  const auto kept = loads_of(1);
  const ToolLoads& loads = *kept;
  const double each = tip_bends_mm_per_n({10, 10, 22, 40, kCarbideModulus}, 2);
  EXPECT_NEAR(loads.bend_most_mm.nominal, each * loads.force_most_n.nominal, 1e-9);
  EXPECT_NEAR(loads.bend_most_mm.low, each * loads.force_most_n.low, 1e-9);
  EXPECT_NEAR(loads.bend_most_mm.high, each * loads.force_most_n.high * 600 / 210, 1e-9);
  EXPECT_EQ(told(), "deflection worse 1\n");
}

TEST_F(CutLoadsTest, WarningsAreOfTheLowEndAndNotesOfTheHighOne) {
  CuttingWish wish = in_steel();
  run(wish, "flat:10:teeth=4", slot(4));
  const ValueRange power = loads_of(1)->power_most_kw;
  for (const auto& [limit, expected] :
       {std::pair(power.low * 0.99, "over-power worse 2\n"),
        std::pair(power.low * 1.01, "over-power note 3\n"),
        std::pair(power.high * 0.99, "over-power note 4\n"), std::pair(power.high * 1.01, "")}) {
    log_ = {};
    wish.spindle_power_kw = limit;
    run(wish, "flat:10:teeth=4", slot(4));
    EXPECT_EQ(told(), expected);
  }
}

TEST_F(CutLoadsTest, ThinChipsCountOnlyWhereTheyAreMostOfTheTime) {
  // 0.05 mm a tooth is 0.0009 mm thick at sin(phi) = 0.018.
  EngagementLook thin = slot(1, 0.002);
  thin.angle_rad = 0.018, thin.entry_rad = kPi - 0.018, thin.climb = 1;
  run(in_steel(), "flat:10:teeth=4", slot(1), 6);
  take(thin, 5);
  EXPECT_EQ(told(), "");
  take(thin, 2);
  EXPECT_EQ(told(), "chip-thin worse 2\n");
}

TEST_F(CutLoadsTest, WhatTheMakerAllows) {
  EngagementLook down = slot(3);
  down.cuts_centre = true;
  run({}, "flat:10:ramp=5:centre=no:chip=0.04:teeth=4", slot(1), 6);
  take(down, 1, 6 * kPi / 180);
  EXPECT_EQ(told(), "chip-load-high worse 1\nplunge worse 2\nramp-steep worse 2\n");
  log_ = {};
  run({}, "flat:10:ramp=5:chip=0.06:teeth=4", slot(1), 6);
  take(down, 1, 4 * kPi / 180);
  EXPECT_EQ(told(), "");
}

TEST_F(CutLoadsTest, TheOtherWayRoundForAnInstantIsNoWayToMill) {
  CuttingWish wish;
  wish.wants_climb = true;
  EngagementLook climb = slot(1, 3), up = slot(1, 3);
  climb.angle_rad = 1, climb.entry_rad = kPi - 1, climb.climb = 1;
  up.angle_rad = 1, up.exit_rad = 1, up.climb = 0;
  run(wish, "flat:10", climb, 6);
  take(up, 0.04);
  take(up, 0.05);
  EXPECT_EQ(told(), "");
  take(up, 0.02);
  EXPECT_EQ(told(), "conventional worse 2\n");
  EXPECT_EQ(log_.kept().back().text,
            "conventional milling, where climb milling is wanted (for 0.1 s in all)");
  // All that a tool cuts, however short.
  log_ = {};
  run(wish, "flat:10", up, 0.0404);
  EXPECT_EQ(told(), "conventional worse 5\n");
  EXPECT_EQ(log_.kept().back().text,
            "conventional milling, where climb milling is wanted (for 40 ms in all)");
}

TEST_F(CutLoadsTest, ABallIsCutNoWiderThanItIs) {
  // In a slot the model's section is that of the ball; 1 mm deep it is 6 mm wide.
  run(in_steel(), "ball:10:teeth=2", slot(1, 6));
  const double whole = loads_of(1)->power_most_kw.nominal;
  run(in_steel(), "ball:10:teeth=2", slot(1, 2));
  EXPECT_LT(loads_of(1)->power_most_kw.nominal, 0.6 * whole);
}

TEST_F(CutLoadsTest, TheFiveLongestWaysInTheAir) {
  run({}, "flat:10", {}, 1);
  for (const double seconds : {3.0, 0.2, 7.0, 2.0, 5.0, 4.0}) {
    take(slot(1), 0.1);
    take({}, seconds);
  }
  loads_->finish();
  ASSERT_EQ(log_.kept().size(), 1u);
  EXPECT_EQ(log_.kept()[0].text,
            "22.2 s of 22.8 s at feed are in no material; most from line 7 7.0 s, line 11 5.0 s, "
            "line 13 4.0 s, line 3 3.0 s, line 9 2.0 s");
  EXPECT_EQ(log_.kept()[0].source.line, 7u);
}

TEST(LoadSpread, TellsWhatItWasNotAboveForHalfOfTheTime) {
  LoadSpread spread;
  EXPECT_EQ(spread.not_above(0.5), 0);
  for (int k = 1; k <= 100; ++k) spread.add(k, 1, {0, static_cast<std::uint32_t>(k)});
  EXPECT_EQ(spread.most(), 100);
  EXPECT_EQ(spread.most_at().line, 100u);
  EXPECT_NEAR(spread.not_above(0.5), 50, 0.04 * 50);
  EXPECT_NEAR(spread.not_above(0.95), 95, 0.04 * 95);
  EXPECT_EQ(spread.not_above(1), 100);
}

}  // namespace
}  // namespace kerf
