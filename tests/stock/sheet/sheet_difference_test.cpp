#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "stock/sheet/difference.h"
#include "stock/sheet/kerf_contour.h"
#include "stock/sheet/sheet_grid.h"

namespace kerf::sheet {
namespace {

const Rect kWindow{-1'000'000, -1'000'000, 1'000'000, 1'000'000};

Ring square(Unit x, Unit y, Unit half) {
  return {{x - half, y - half}, {x + half, y - half}, {x + half, y + half}, {x - half, y + half}};
}

Ring reversed(Ring ring) {
  std::reverse(ring.begin(), ring.end());
  return ring;
}

std::vector<const Ring*> pointers(const Rings& rings) {
  std::vector<const Ring*> found;
  for (const Ring& ring : rings) found.push_back(&ring);
  return found;
}

/// What a run of the operation leaves: new rings, and those that stay.
Rings result_of(Difference& difference, const Rings& subject) {
  Rings result = difference.fresh();
  for (std::size_t i = 0; i < subject.size(); ++i) {
    if (difference.untouched()[i]) result.push_back(subject[i]);
  }
  return result;
}

std::int64_t area2_of(const Rings& rings) {
  std::int64_t area2 = 0;
  for (const Ring& ring : rings) area2 += twice_area(ring);
  return area2;
}

Rings by_library(const Rings& subject, const Rings& kerf, ClipperLib::ClipType operation) {
  ClipperLib::Clipper clipper;
  clipper.AddPaths(subject, ClipperLib::ptSubject, true);
  clipper.AddPaths(kerf, ClipperLib::ptClip, true);
  Rings result;
  clipper.Execute(operation, result, ClipperLib::pftNonZero, ClipperLib::pftNonZero);
  return result;
}

TEST(Difference, cuts_a_corner_off) {
  const Rings subject{square(0, 0, 1000)}, kerf{square(1000, 1000, 500)};
  Difference difference;
  ASSERT_TRUE(difference.subtract(pointers(subject), kerf, kWindow));
  ASSERT_EQ(difference.fresh().size(), 1u);
  EXPECT_EQ(difference.fresh()[0].size(), 6u);
  EXPECT_EQ(twice_area(difference.fresh()[0]), 2 * (2000 * 2000 - 500 * 500));
  EXPECT_FALSE(difference.untouched()[0]);
  EXPECT_TRUE(difference.has_fresh_outer());
}

TEST(Difference, a_slot_through_makes_two_of_one) {
  const Rings subject{square(0, 0, 1000)};
  const Rings kerf{{{-100, -2000}, {100, -2000}, {100, 2000}, {-100, 2000}}};
  Difference difference;
  ASSERT_TRUE(difference.subtract(pointers(subject), kerf, kWindow));
  ASSERT_EQ(difference.fresh().size(), 2u);
  EXPECT_EQ(area2_of(difference.fresh()), 2 * (2000 * 2000 - 200 * 2000));
}

TEST(Difference, whole_rings_become_holes_parts_or_nothing) {
  const Rings subject{square(0, 0, 1000), reversed(square(700, 700, 100)), square(3000, 0, 50)};
  // A ring round the origin, and a piece that takes the small square.
  const Rings kerf{square(0, 0, 400), reversed(square(0, 0, 300)), square(3000, 0, 60)};
  Difference difference;
  ASSERT_TRUE(difference.subtract(pointers(subject), kerf, kWindow));
  EXPECT_EQ(difference.untouched(), (std::vector<char>{1, 1, 0}));
  ASSERT_EQ(difference.fresh().size(), 2u);
  EXPECT_EQ(twice_area(difference.fresh()[0]), -2 * 800 * 800);
  EXPECT_EQ(twice_area(difference.fresh()[1]), 2 * 600 * 600);
  EXPECT_TRUE(difference.has_fresh_outer());
}

TEST(Difference, a_hole_that_grows_leaves_the_contour) {
  const Rings subject{square(0, 0, 1000), reversed(square(0, 0, 100))};
  const Rings kerf{square(100, 100, 100 - 1)};
  Difference difference;
  ASSERT_TRUE(difference.subtract(pointers(subject), kerf, kWindow));
  EXPECT_EQ(difference.untouched(), (std::vector<char>{1, 0}));
  EXPECT_FALSE(difference.has_fresh_outer());
  EXPECT_EQ(area2_of(difference.fresh()), -2 * (200 * 200 + (2 * 99) * (2 * 99) - 99 * 99));
}

TEST(Difference, leaves_corners_on_edges_to_others) {
  const Rings subject{square(0, 0, 1000)};
  Difference difference;
  EXPECT_FALSE(difference.subtract(pointers(subject), {square(1000, 0, 1000)}, kWindow));
  EXPECT_FALSE(difference.subtract(pointers(subject), {square(2000, 0, 1000)}, kWindow));
  EXPECT_FALSE(
      difference.subtract(pointers(subject), {{{500, 0}, {1000, 10}, {500, 20}}}, kWindow));
  const Unit far = Unit{1} << 31;
  EXPECT_FALSE(difference.subtract(pointers(subject), {{{500, 0}, {far, 10}, {500, 20}}}, kWindow));
  // The same object goes on working afterwards.
  EXPECT_TRUE(difference.subtract(pointers(subject), {square(10, 10, 20)}, kWindow));
}

TEST(Difference, corners_on_the_line_of_their_neighbours_go) {
  // The kerf runs along the slope in two pieces.
  const Rings subject{{{0, 0}, {1000, 0}, {1000, 1000}, {0, 1000}}};
  const Rings kerf{{{-100, -50}, {500, -50}, {500, 250}, {500, 500}, {-100, 500}}};
  Difference difference;
  ASSERT_TRUE(difference.subtract(pointers(subject), kerf, kWindow));
  ASSERT_EQ(difference.fresh().size(), 1u);
  EXPECT_EQ(difference.fresh()[0].size(), 6u);
}

// Moves of all kinds, one after the other from one region: area as the library has it within what
// rounding of the crossings makes, and nowhere another shape.
TEST(Difference, is_what_the_polygon_library_makes) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> place(-12, 12), angle(-4, 4), kerf_radius(0.1, 3);
  CircleTables tables;
  Difference difference;
  int plain = 0, crossings = 0, refused = 0;
  for (int sheet = 0; sheet < 12; ++sheet) {
    Rings region{square(0, 0, 100'000)};
    for (int i = 0; i < 25; ++i) {
      CutMove move;
      move.from_mm = {place(random), place(random), 0};
      move.to_mm = {place(random), place(random), 0};
      if (i % 3 != 0) {
        const Vec3 center{place(random), place(random), 0};
        const double sweep = i % 3 == 1 ? 2 * kPi : angle(random);
        const Vec3 arm = 0.5 * (move.from_mm - center);
        move.from_mm = center + arm;
        const double c = std::cos(sweep), s = std::sin(sweep);
        move.to_mm = center + Vec3(c * arm.x - s * arm.y, s * arm.x + c * arm.y, 0);
        move.arc = CutArc{center, {0, 0, 1}, sweep};
      }
      const Kerf kerf = kerf_of_move(move, kerf_radius(random), 0.005, tables);
      const Rings wanted = by_library(region, kerf.rings, ClipperLib::ctDifference);
      if (!kerf.plain) {
        region = wanted;
        continue;
      }
      ++plain;
      if (!difference.subtract(pointers(region), kerf.rings, kWindow)) {
        ++refused;
        region = wanted;
        continue;
      }
      crossings += difference.fresh().empty() ? 0 : 1;
      const Rings found = result_of(difference, region);
      // Each crossing moves by half a unit, and so do both its edges, 20 mm long at most.
      std::size_t corners = 0;
      for (const Ring& ring : wanted) corners += ring.size();
      EXPECT_NEAR(static_cast<double>(area2_of(found)), static_cast<double>(area2_of(wanted)),
                  2e5 * static_cast<double>(corners));
      const Rings apart = by_library(found, wanted, ClipperLib::ctXor);
      for (const Ring& sliver : apart) {
        const Rect box = bounds_of(sliver);
        const double longest = std::hypot(static_cast<double>(box.max_x - box.min_x),
                                          static_cast<double>(box.max_y - box.min_y));
        EXPECT_LE(std::abs(static_cast<double>(twice_area(sliver))), 4 * (longest + 2))
            << "sheet " << sheet << ", move " << i;
      }
      region = found;
    }
  }
  EXPECT_GT(plain, 200);
  EXPECT_LE(refused, 2);
  EXPECT_GT(crossings, 150);
}

// Of a rectangle that tiles divide, both tiles have the same corner on their border.
TEST(Difference, neighbours_round_alike) {
  std::mt19937 random(3);
  std::uniform_int_distribution<Unit> x(-90'000, -10), y(-90'000, 90'000);
  Difference difference;
  for (int i = 0; i < 300; ++i) {
    const Point low{x(random), y(random)}, high{-x(random), y(random)};
    const Rings kerf{{low, {low.X, low.Y - 300'000}, {high.X, high.Y - 300'000}, high}};
    const Rings left{{{-100'000, -100'000}, {0, -100'000}, {0, 100'000}, {-100'000, 100'000}}};
    const Rings right{{{0, -100'000}, {70'001, -100'000}, {70'001, 99'999}, {0, 99'999}}};
    const auto on_border = [&](const Rings& subject) {
      EXPECT_TRUE(difference.subtract(pointers(subject), kerf, kWindow));
      std::vector<Unit> found;
      for (const Ring& ring : difference.fresh()) {
        for (const Point& p : ring) {
          if (p.X == 0 && std::abs(p.Y) < 99'000) found.push_back(p.Y);
        }
      }
      return found;
    };
    EXPECT_EQ(on_border(left), on_border(right));
  }
}

}  // namespace
}  // namespace kerf::sheet
