#include "twin/job/work_holding.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "stock/turning/turning_stock.h"

namespace kerf {
namespace {

TurnedProfile bar() { return bar_profile(-60, 0, 40); }

std::vector<HoldingBody> bodies_of(const char* chuck, const char* tailstock,
                                   const TurnedProfile& blank) {
  WorkHolding holding;
  if (*chuck) holding.chuck = *parse_chuck(chuck);
  if (*tailstock) holding.tailstock = *parse_tailstock(tailstock);
  auto bodies = holding_bodies(holding, blank);
  EXPECT_TRUE(bodies) << bodies.error();
  return bodies ? *bodies : std::vector<HoldingBody>{};
}
std::string misfit_of(const char* chuck, const char* tailstock, const TurnedProfile& blank) {
  WorkHolding holding;
  if (*chuck) holding.chuck = *parse_chuck(chuck);
  if (*tailstock) holding.tailstock = *parse_tailstock(tailstock);
  const auto bodies = holding_bodies(holding, blank);
  return bodies ? "" : bodies.error();
}

double disc_mm2(double diameter) { return kPi / 4 * diameter * diameter; }

TEST(WorkHolding, TheBlankEndsAtTheFaceAndJawsReachAroundIt) {
  const auto bodies = bodies_of("160:80:120:25", "", bar());
  ASSERT_EQ(bodies.size(), 2U);
  const Box chuck = bodies[0].ring.bounds_mm();
  EXPECT_EQ(chuck.min.z, -140);
  EXPECT_EQ(chuck.max.z, -60);
  EXPECT_EQ(chuck.max.x, 80);
  EXPECT_NEAR(bodies[0].ring.remaining_mm3(), 80 * (disc_mm2(160) - disc_mm2(40)), 1e-3);
  const Box jaws = bodies[1].ring.bounds_mm();
  EXPECT_EQ(jaws.min.z, -60);
  EXPECT_EQ(jaws.max.z, -35);
  EXPECT_NEAR(bodies[1].ring.remaining_mm3(), 25 * (disc_mm2(120) - disc_mm2(40)), 1e-3);
}

TEST(WorkHolding, ABarGoesThroughTheChuck) {
  const auto bodies = bodies_of("160:80:bore=30:at=-40", "", bar());
  ASSERT_EQ(bodies.size(), 1U);
  // The blank, not the bore, is in it.
  EXPECT_NEAR(bodies[0].ring.remaining_mm3(), 80 * (disc_mm2(160) - disc_mm2(40)), 1e-3);
  const auto wider = bodies_of("160:80:bore=50:at=-40", "", bar());
  EXPECT_NEAR(wider[0].ring.remaining_mm3(), 80 * (disc_mm2(160) - disc_mm2(50)), 1e-3);
}

TEST(WorkHolding, JawsHoldASteppedBlankWhereTheyAre) {
  const TurnedProfile stepped{{{-60, 0}, {0, 0}, {0, 20}, {-30, 20}, {-30, 12}, {-60, 12}}};
  const auto bodies = bodies_of("160:80:120:25", "", stepped);
  EXPECT_NEAR(bodies[1].ring.remaining_mm3(), 25 * (disc_mm2(120) - disc_mm2(24)), 1e-3);
}

TEST(WorkHolding, TheCentreIsAThirdAsThickAsTheEnd) {
  const auto bodies = bodies_of("", "50", bar());
  ASSERT_EQ(bodies.size(), 1U);
  const Box box = bodies[0].ring.bounds_mm();
  EXPECT_NEAR(box.min.z, -(40.0 / 3 / 2) * std::sqrt(3.0), 1e-4);
  EXPECT_EQ(box.max.x, 25);
  const auto said = bodies_of("", "50:90:at=-4", bar());
  EXPECT_NEAR(said[0].ring.bounds_mm().min.z, -4, 1e-9);
  // A cone of 90 degrees is as long as its radius.
  EXPECT_NEAR(said[0].ring.bounds_mm().max.z, -4 + 25 + 300, 1e-4);
}

TEST(WorkHolding, WhatDoesNotFitIsSaid) {
  EXPECT_NE(misfit_of("160:80:at=-80", "", bar()).find("begins at Z-60"), std::string::npos);
  EXPECT_NE(misfit_of("30:80:at=-40", "", bar()).find("40 mm thick"), std::string::npos);
  EXPECT_NE(misfit_of("160:80:35:20", "", bar()).find("do not reach round"), std::string::npos);
  EXPECT_NE(misfit_of("", "50:60:at=3", bar()).find("the blank ends at Z0"), std::string::npos);
  EXPECT_NE(misfit_of("", "50:60:at=-50", bar()).find("so deep"), std::string::npos);
  EXPECT_NE(misfit_of("1500:1500:at=-900", "", bar_profile(-1000, 0, 40)).find("2 m"),
            std::string::npos);
}

TEST(WorkHolding, FaultsOfTexts) {
  EXPECT_EQ(parse_chuck("160").error(), "160: the form is D:L[:JAW_D:JAW_L][:bore=D][:at=Z]");
  EXPECT_EQ(parse_chuck("160:80:100").error(),
            "160:80:100: the form is D:L[:JAW_D:JAW_L][:bore=D][:at=Z]");
  EXPECT_EQ(parse_chuck("0:80").error(), "0:80: D: 0 is not allowed; must be from 1 to 1500 (mm)");
  EXPECT_EQ(parse_chuck("160:80:att=3").error(),
            "160:80:att=3: unknown option 'att'; did you mean 'at'? Options: bore, at");
  EXPECT_EQ(parse_chuck("160:80:at=1:at=2").error(), "160:80:at=1:at=2: at is given twice");
  EXPECT_EQ(parse_chuck("160:80:bore=160").error(),
            "160:80:bore=160: the bore is as wide as the chuck; must be below D");
  EXPECT_EQ(parse_tailstock("50:5").error(),
            "50:5: ANGLE: 5 is not allowed; must be from 10 to 170 (degrees)");
  EXPECT_EQ(parse_tailstock("50:60:70").error(), "50:60:70: the form is D[:ANGLE][:at=Z]");
  EXPECT_EQ(parse_chuck("6:3", LengthUnit::kInch)->diameter_mm, 152.4);
}

TEST(WorkHolding, FixturesStandBesideAWorkpieceThatTurns) {
  const TurningStock turned(*TurnedPart::create(bar()));
  HoldingList out;
  const auto held = [&](const char* text, bool blank_given, Diagnostics& diagnostics) {
    const FixtureSpec spec = *parse_fixture(text);
    const FixtureList fixtures = load_fixtures({&spec, 1}, diagnostics);
    return hold_workpiece({}, fixtures, turned, blank_given, out, diagnostics);
  };
  Diagnostics none;
  const Box bounds = turned.bounds_mm();
  const double r = bounds.max.x;
  const std::string beside = fmt::format("box:{},-5,-20:{},5,-10", r + 1, r + 9),
                    in_it = fmt::format("box:-5,{},-20:5,{},-10", r - 1, r + 9);
  EXPECT_TRUE(held(beside.c_str(), true, none));
  EXPECT_TRUE(none.empty());
  Diagnostics told;
  EXPECT_FALSE(held(in_it.c_str(), true, told));
  ASSERT_EQ(told.size(), 1U);
  EXPECT_NE(told[0].message.find("stands in the blank, "), std::string::npos);
  EXPECT_TRUE(held(in_it.c_str(), false, none)) << "a blank that is a guess";
  EXPECT_TRUE(held((in_it + ":in-blank").c_str(), true, none));
  Diagnostics on_link;
  EXPECT_FALSE(held((beside + ":on=table").c_str(), true, on_link));
  ASSERT_EQ(on_link.size(), 1U);
  EXPECT_EQ(on_link[0].message,
            "fixture 'box' is on link 'table': beside a workpiece that turns fixtures stand still");
  EXPECT_TRUE(hold_workpiece({}, nullptr, turned, true, out, none));
  EXPECT_EQ(out, nullptr);
}

}  // namespace
}  // namespace kerf
