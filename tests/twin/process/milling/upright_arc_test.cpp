// Arcs in planes that stand upright (G18, G19): how low they come, and how a tool is engaged on
// them.
#include "twin/process/milling/upright_arc.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "stock/cutter/shape_spec.h"
#include "stock/zmap/zmap.h"
#include "twin/process/milling/engagement_scan.h"
#include "twin/process/milling/past_ways.h"
#include "twin/process/milling/way_profile.h"

namespace kerf {
namespace {

constexpr double kDegree = kPi / 180;

/// About the level axis `toward` (degrees from X), from one angle to another one, which are from
/// across(): the side on which the axis goes clockwise to it, to Z.
CutMove upright(Vec3 center, double radius, double toward_deg, double from_deg, double to_deg,
                double climb_mm = 0) {
  const Vec3 axis(std::cos(toward_deg * kDegree), std::sin(toward_deg * kDegree), 0);
  const Vec3 across(-axis.y, axis.x, 0);
  const auto at = [&](double deg) {
    return center +
           radius * (std::cos(deg * kDegree) * across + std::sin(deg * kDegree) * Vec3(0, 0, 1));
  };
  CutMove move;
  move.from_mm = at(from_deg), move.to_mm = at(to_deg) + climb_mm * axis;
  move.arc = CutArc{center, axis, (to_deg - from_deg) * kDegree};
  return move;
}

double by_brute_force(const CutMove& arc, const Cutter& cutter, const Vec2& point, double from,
                      double to) {
  double lowest = std::numeric_limits<double>::infinity();
  for (int k = 0; k <= 20'000; ++k) {
    const Vec3 tip = part_of(arc, 0, from + (to - from) * k / 20'000).to_mm;
    const double distance = glm::length(point - Vec2(tip));
    if (distance <= cutter.radius_mm())
      lowest = std::min(lowest, tip.z + cutter.height_mm(distance));
  }
  return lowest;
}

TEST(UprightArcTest, IsNoneOfOtherMoves) {
  CutMove move;
  move.to_mm = {10, 0, 0};
  EXPECT_FALSE(UprightArc::of(move)) << "straight";
  move.arc = CutArc{{5, 0, 0}, {0, 0, 1}, kPi};
  EXPECT_FALSE(UprightArc::of(move)) << "level";
  move.arc->axis = {0, 0.6, 0.8};
  EXPECT_FALSE(UprightArc::of(move)) << "leaning";
  move.arc->axis = {0, 1, 0};
  EXPECT_TRUE(UprightArc::of(move));
  move.axis_from = move.axis_to = {0.6, 0, 0.8};
  EXPECT_FALSE(UprightArc::of(move)) << "a tilted tool";
}

TEST(UprightArcTest, TurnsBackWhereItIsLevelWithItsCentre) {
  const auto turnings = [](double from_deg, double to_deg) {
    return UprightArc::of(upright({0, 0, 0}, 10, 30, from_deg, to_deg))->turning_parts();
  };
  EXPECT_TRUE(turnings(0, 180).empty());
  EXPECT_TRUE(turnings(170, 10).empty());
  ASSERT_EQ(turnings(-90, 270).size(), 2u);
  EXPECT_NEAR(turnings(-90, 270)[0], 0.25, 1e-9);
  EXPECT_NEAR(turnings(-90, 270)[1], 0.75, 1e-9);
  ASSERT_EQ(turnings(90, -30).size(), 1u);
  EXPECT_NEAR(turnings(90, -30)[0], 0.75, 1e-9);
}

TEST(UprightArcTest, TheLineTouchesIt) {
  const CutMove arc = upright({3, 4, -5}, 12, 70, 160, 20, 6);
  const UprightArc upright_arc = *UprightArc::of(arc);
  for (const double at : {0.1, 0.5, 0.83}) {
    const Vec3 before = part_of(arc, 0, at - 1e-5).to_mm, behind = part_of(arc, 0, at + 1e-5).to_mm;
    const CutMove line = upright_arc.line_at(at, 1);
    const Vec3 way = glm::normalize(line.to_mm - line.from_mm);
    EXPECT_NEAR(glm::length(way - glm::normalize(behind - before)), 0, 1e-6);
    EXPECT_NEAR(glm::length(0.5 * (line.from_mm + line.to_mm) - 0.5 * (before + behind)), 0, 1e-6);
  }
}

TEST(UprightArcTest, ComesAsLowAsAllOfItsPlaces) {
  std::mt19937 random(1);
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  const std::vector<std::string> shapes = {"flat:6", "ball:6", "bull:8:1", "vee:10:90"};
  int met = 0;
  for (int n = 0; n < 120; ++n) {
    const Cutter cutter = parse_shape(shapes[static_cast<std::size_t>(n) % shapes.size()]).value();
    // One after the other: compilers differ in which argument they take first.
    const double radius = between(1, 30), from = between(-180, 180);
    const double x = between(-5, 5), y = between(-5, 5), z = between(-9, 9);
    const double toward = between(0, 360), sweep = between(-360, 360);
    const double climb = n % 3 == 0 ? between(-10, 10) : 0;
    const CutMove arc = upright({x, y, z}, radius, toward, from, from + sweep, climb);
    const double until = n % 2 == 0 ? 1 : between(0.1, 1);
    const UprightArc upright_arc = *UprightArc::of(arc);
    const auto lift = [&](double mm) { return cutter.height_mm(mm); };
    for (int k = 0; k < 8; ++k) {
      const Vec3 on = upright_arc.point_at(between(0, 1));
      const double right = between(-3.5, 3.5), up = between(-3.5, 3.5);
      const Vec2 point = Vec2(on) + Vec2(right, up);
      const double expected = by_brute_force(arc, cutter, point, 0, until);
      const double found = upright_arc.lowest_over(point, 0, until, cutter.radius_mm(), lift);
      if (expected == std::numeric_limits<double>::infinity()) continue;
      ++met;
      EXPECT_NEAR(found, expected, 0.01) << cutter.spec() << " of R" << radius << ", case " << n;
    }
  }
  EXPECT_GT(met, 200);
}

TEST(UprightArcTest, PastWaysKnowIt) {
  PastWays ways;
  const Cutter ball = parse_shape("ball:6").value();
  ways.mount(ball, 1);
  // Over the top at Z0 with the middle of the ball on R13: R10 under it is what is left.
  CutMove arc = upright({0, 0, -13}, 13, 90, 150, 30);
  arc.id = 1;
  ways.add(arc);
  for (const double x : {-6.0, 0.0, 4.0}) {
    const double left = std::sqrt(100 - x * x) - 10;
    EXPECT_NEAR(ways.height_mm(1, {x, 0}), left, 1e-3);
    EXPECT_TRUE(ways.covers(1, {x, 0}, left + 0.01, 0));
    EXPECT_FALSE(ways.covers(1, {x, 0}, left - 0.01, 0));
  }
  EXPECT_FALSE(ways.covers(1, {0, 3.1}, 5, 0)) << "beside it";
}

/// Against the same arc, cut as far as the place of the look.
TEST(UprightArcTest, IsLookedAtAsIfItWereCutSoFar) {
  const Cutter cutter = parse_shape("flat:6").value();
  const std::vector<CutMove> arcs = {
      upright({30, 20, -20}, 18, 90, 150, 30), upright({30, 20, -20}, 18, 270, 30, 150),
      upright({30, 20, -8}, 6, 90, 170, 10),   upright({30, 20, 12}, 16, 90, 215, 325),
      upright({30, 20, -9}, 7, 40, 20, 160),   upright({30, 20, -6}, 3, 90, 175, 5)};
  int looks = 0;
  for (const CutMove& arc : arcs) {
    const UprightArc upright_arc = *UprightArc::of(arc);
    const auto block = [&](double until) {
      ZMapOptions options;
      options.blank = parse_blank("box:0,0,-25:60,40,0").value();
      options.cell_mm = 0.1;
      std::unique_ptr<ZMap> stock = std::move(ZMap::create(options).value());
      std::vector<CutReport> reports;
      CutMove beside = arc;  // the pass before
      beside.from_mm.y -= 2, beside.to_mm.y -= 2, beside.arc->center_mm.y -= 2;
      std::vector<CutMove> cut = {beside};
      if (until > 0) cut.push_back(part_of(arc, 0, until));
      stock->cut(cutter, cut, reports);
      stock->finish(reports);
      return stock;
    };
    const std::unique_ptr<ZMap> before = block(0);
    for (const double at : {0.2, 0.4, 0.5, 0.6, 0.7, 0.85}) {
      const std::unique_ptr<ZMap> so_far = block(at);
      EngagementScan scan;
      EngagementScan::Look asked;
      asked.at = 0.5;
      const CutMove line = upright_arc.line_at(at, 1);
      const EngagementLook expected =
          scan.look_ahead(*so_far->present_heights(), cutter, line, asked);
      asked.own = &upright_arc, asked.own_part = at;
      const EngagementLook found = scan.look_ahead(*before->present_heights(), cutter, line, asked);
      EXPECT_NEAR(found.angle_rad, expected.angle_rad, 2 * kDegree) << "R" << arc.from_mm.x << at;
      EXPECT_NEAR(found.wide_mm, expected.wide_mm, 0.2) << at;
      looks += expected.is_engaged() ? 1 : 0;
    }
  }
  EXPECT_GT(looks, 25);
}

/// As straight ways of 0.05 mm remove it, whose sagittae are 0.00002 mm; heights cut such arcs as
/// chords that are within 0.001 mm.
TEST(UprightArcTest, RemovesWhatShortStraightWaysDo) {
  const Cutter ball = parse_shape("ball:6").value();
  for (const CutMove& arc :
       {upright({30, 20, -20}, 18, 90, 150, 30), upright({30, 20, 12}, 16, 90, 215, 325)}) {
    const auto removed_mm3 = [&](int parts) {
      ZMapOptions options;
      options.blank = parse_blank("box:0,0,-25:60,40,0").value();
      options.cell_mm = 0.1;
      const std::unique_ptr<ZMap> stock = std::move(ZMap::create(options).value());
      std::vector<CutMove> moves = {arc};
      if (parts > 1) moves.clear();
      for (int k = 0; k < parts && parts > 1; ++k) {
        CutMove& chord = moves.emplace_back(part_of(arc, double{1} * k / parts, (k + 1.0) / parts));
        chord.arc.reset();
      }
      const double before = stock->remaining_mm3();
      std::vector<CutReport> reports;
      stock->cut(ball, moves, reports);
      stock->finish(reports);
      return before - stock->remaining_mm3();
    };
    const int parts = static_cast<int>(way_length_mm(arc) / 0.05);
    const double whole = removed_mm3(1);
    EXPECT_GT(whole, 100);
    EXPECT_NEAR(whole, removed_mm3(parts), 0.001 * 6 * way_length_mm(arc));
    EXPECT_NEAR(whole / removed_mm3(parts), 1, 3e-4);
  }
}

/// Over a hill that is narrower than the tool it has been lower before it comes down again: what
/// was cut then is not before it. By the same formula as FrontRays, of places in its front over
/// which the arc has not come yet.
double angle_by_brute_force(const CutMove& arc, const Cutter& cutter, double top_mm, double at,
                            bool asks_arc) {
  const UprightArc upright_arc = *UprightArc::of(arc);
  const CutMove line = upright_arc.line_at(at, 1);
  const Vec2 ahead = glm::normalize(Vec2(line.to_mm - line.from_mm));
  const Vec3 tip = upright_arc.point_at(at);
  double sum = 0, square = 0;
  constexpr int kDirections = 60, kRadii = 60;
  for (int n = 0; n < kDirections; ++n) {
    const double angle = kPi * ((n + 0.5) / kDirections - 0.5);
    const Vec2 out = std::cos(angle) * ahead + std::sin(angle) * Vec2(-ahead.y, ahead.x);
    double high = 0;
    for (int k = 0; k < kRadii; ++k) {
      const double inner = cutter.radius_mm() * std::sin(kPi / 2 * k / kRadii);
      const double outer = cutter.radius_mm() * std::sin(kPi / 2 * (k + 1) / kRadii) * (1 - 1e-9);
      const double r = 0.5 * (inner + outer), surface = tip.z + cutter.height_mm(r);
      double before = std::numeric_limits<double>::infinity();
      for (int i = 0; asks_arc && i < 400; ++i) {
        const Vec3 past = upright_arc.point_at(at * i / 400);
        const double distance = glm::length(Vec2(tip) + r * out - Vec2(past));
        if (distance <= cutter.radius_mm())
          before = std::min(before, past.z + cutter.height_mm(distance));
      }
      if (surface < top_mm && before > surface - 1e-3)
        high += cutter.height_mm(outer) - cutter.height_mm(inner);
    }
    sum += high, square += high * high;
  }
  return sum * sum / square * kPi / kDirections;
}

TEST(UprightArcTest, WhatItHasCutBeforeIsNotBeforeIt) {
  ZMapOptions options;
  options.blank = parse_blank("box:0,0,-25:60,40,-3").value();
  options.cell_mm = 0.1;
  const std::unique_ptr<ZMap> stock = std::move(ZMap::create(options).value());
  const Cutter ball = parse_shape("ball:8").value();
  const CutMove arc = upright({30, 20, -5}, 1, 90, 170, 10);
  const UprightArc upright_arc = *UprightArc::of(arc);
  for (const double at : {0.6, 0.75}) {
    EngagementScan scan;
    EngagementScan::Look asked;
    asked.at = 0.5;
    asked.own = &upright_arc, asked.own_part = at;
    for (const bool is_brief : {false, true}) {
      asked.is_brief = is_brief;
      const EngagementLook found =
          scan.look_ahead(*stock->present_heights(), ball, upright_arc.line_at(at, 1), asked);
      const double expected = angle_by_brute_force(arc, ball, -3, at, true);
      EXPECT_LT(found.angle_rad, angle_by_brute_force(arc, ball, -3, at, false) - 9 * kDegree);
      EXPECT_NEAR(found.angle_rad, expected, 9 * kDegree) << at << (is_brief ? " in brief" : "");
    }
  }
}

}  // namespace
}  // namespace kerf
