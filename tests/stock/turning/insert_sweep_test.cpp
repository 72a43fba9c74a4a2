// What an insert sweeps on straight ways, against the hull of many points of it.
#include "stock/turning/insert_sweep.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/stock/insert_points.h"
#include "tests/stock/turning/turning_oracle.h"

namespace kerf {
namespace {

using namespace turning_test;

using turning::ConvexRegion;
using turning::GridPart;
using turning::Point;
using turning::Ring;

std::vector<Vec2> hull_of(std::vector<Vec2> points) {
  std::sort(points.begin(), points.end(),
            [](const Vec2& a, const Vec2& b) { return a.x != b.x ? a.x < b.x : a.y < b.y; });
  std::vector<Vec2> hull;
  for (int side = 0; side < 2; ++side) {
    const std::size_t base = hull.size();
    for (const Vec2& p : points) {
      while (hull.size() >= base + 2 &&
             cross(hull.back() - hull[hull.size() - 2], p - hull.back()) <= 0)
        hull.pop_back();
      hull.push_back(p);
    }
    hull.pop_back();
    std::reverse(points.begin(), points.end());
  }
  return hull;
}

double area_of(const std::vector<Vec2>& ring) {
  double sum = 0;
  for (std::size_t i = 0; i < ring.size(); ++i)
    sum += cross(ring[i], ring[(i + 1) % ring.size()]) / 2;
  return sum;
}

std::vector<Vec2> points_of(const InsertPart& part) { return insert_points(part, 300); }

void expect_convex(const ConvexRegion& region) {
  const std::vector<Point>& corners = region.corners();
  const std::size_t n = corners.size();
  ASSERT_GE(n, 3u);
  for (std::size_t i = 0; i < n; ++i) {
    ASSERT_GT(plane::turn(corners[i], corners[(i + 1) % n], corners[(i + 2) % n]), 0);
    // Each corner is on the inner side of every edge: it goes round once.
    for (std::size_t k = 0; k < n; k += 1 + n / 8) ASSERT_TRUE(region.is_inward(k, corners[i]));
  }
}

TEST(InsertSweep, sweeps_are_hulls_whatever_the_radius_and_the_way) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (const double r : {0.0, 0.0001, 0.0005, 0.002, 0.01, 0.05, 0.4, 1.6}) {
    for (int round = 0; round < 200; ++round) {
      std::optional<InsertOutline> outline;
      if (round % 2 == 0) {
        outline = iso_insert({"CDEKMPSTVW"[round / 2 % 10], 9.525, r, 1 + round % 9,
                              radians(180 * unit(random)), round % 4 == 0});
      } else {
        const double front = kPi * unit(random);
        outline =
            nose_insert({r, 1 + round % 8, front, front + radians(90 + 80 * unit(random)), 9});
      }
      ASSERT_TRUE(outline);
      const InsertPart& part = outline->parts[0];
      GridPart grid(part);
      GridPart::Scratch scratch;
      ConvexRegion swept;
      GridPart::Lead lead;
      const double length = std::pow(10.0, -4 + 2.5 * (1 + unit(random)));
      Vec2 way = length * Vec2{unit(random), unit(random)};
      if (round % 5 == 0) way.x = 0;
      if (round % 7 == 0) way = length * Vec2(std::cos(radians(85)), std::sin(radians(85)));
      const Point from{-1'234'567, 2'345'678};
      const Point to{from.X + turning::to_units(way.x), from.Y + turning::to_units(way.y)};
      grid.sweep(from, to, scratch, swept, lead);
      expect_convex(swept);
      std::vector<Vec2> points;
      for (const Vec2& p : points_of(part)) {
        points.push_back(turning::to_mm(from) + p);
        points.push_back(turning::to_mm(to) + p);
      }
      const std::vector<Vec2> hull = hull_of(points);
      double around = 0;
      for (std::size_t i = 0; i < hull.size(); ++i)
        around += glm::distance(hull[i], hull[(i + 1) % hull.size()]);
      const double area = static_cast<double>(plane::twice_area(Ring(swept.corners()))) /
                          (2 * turning::kUnitsPerMm * turning::kUnitsPerMm);
      // Two steps of the grid all round, and what points between those of the arcs would add.
      EXPECT_NEAR(area, area_of(hull), 2e-5 * around + 2e-4 * r) << "r " << r << " round " << round;
      if (from == to) continue;
      ASSERT_EQ(lead.sides.size() + 1, lead.across.size());
      for (std::size_t i = 1; i < lead.across.size(); ++i)
        EXPECT_LT(lead.across[i - 1], lead.across[i]);
    }
  }
}

TEST(InsertSweep, a_way_that_touches_a_nose_has_its_very_point) {
  std::mt19937 random(12);
  std::uniform_real_distribution<double> turn(0, 2 * kPi);
  GridPart disc(round_insert(2).parts[0]);
  GridPart::Scratch scratch;
  ConvexRegion swept;
  GridPart::Lead lead;
  for (int round = 0; round < 500; ++round) {
    const double angle = turn(random);
    const Vec2 way(std::cos(angle), std::sin(angle));
    const Point to = turning::to_units(30.0 * way);
    disc.sweep({0, 0}, to, scratch, swept, lead);
    // Half the width of what is swept: the radius, and not that of a corner that sticks out.
    EXPECT_NEAR(lead.across.back(), 2e5, 1);
    EXPECT_NEAR(lead.across.front(), -2e5, 1);
  }
}

TEST(InsertSweep, arcs_in_steps_keep_their_area) {
  for (const double radius : {0.01, 0.4, 30.0}) {
    for (const double sweep : {0.01, 1.0, 3.0, 6.2}) {
      const turning::ArcSteps steps = turning::arc_steps(radius, sweep, 2e-5);
      std::vector<Vec2> ring{{0, 0}, {radius, 0}};
      for (int i = 0; i < steps.count; ++i) {
        const double angle = (i + 0.5) * steps.step_rad;
        ring.push_back(steps.outward * radius * Vec2(std::cos(angle), std::sin(angle)));
      }
      ring.push_back(radius * Vec2(std::cos(sweep), std::sin(sweep)));
      EXPECT_NEAR(area_of(ring) / (radius * radius * sweep / 2), 1, 1e-12);
      EXPECT_LE((steps.outward - 1) * radius, 2e-5 * 1.01);
      EXPECT_LE((1 - steps.outward * std::cos(steps.step_rad / 2)) * radius, 2e-5);
    }
  }
  EXPECT_EQ(turning::arc_steps(0, 1, 2e-5).count, 0);
  EXPECT_EQ(turning::arc_steps(1, 0, 2e-5).count, 0);
}

TEST(InsertSweep, regions_are_hulls_of_what_goes_round_no_way) {
  ConvexRegion region;
  std::vector<Point> star{{20, 40}, {100, 90}, {-50, 100}, {60, -40}, {50, 140}, {0, 60}};
  region.assign(star);
  expect_convex(region);
  EXPECT_EQ(region.corners().size(), 4u);  // -50 100, 60 -40, 100 90, 50 140
  std::vector<Point> line{{0, 0}, {10, 10}, {5, 5}, {20, 20}};
  region.assign(line);
  EXPECT_TRUE(region.empty());
}

TEST(InsertSweep, insets_lie_within_by_their_width) {
  const InsertOutline outline = right_hand(0.8);
  const GridPart whole(outline.parts[0]);
  GridPart::Scratch scratch;
  ConvexRegion swept;
  GridPart::Lead lead;
  whole.inset(0.1).sweep({0, 0}, {0, 0}, scratch, swept, lead);
  expect_convex(swept);
  for (const Point& p : swept.corners())
    EXPECT_NEAR(distance_to_part(outline.parts[0], turning::to_mm(p)), -0.1, 3e-4);
  EXPECT_TRUE(whole.inset(10).empty());
}

}  // namespace
}  // namespace kerf
