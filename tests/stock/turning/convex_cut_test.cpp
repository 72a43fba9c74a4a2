// Regions without convex polygons: what touches, what coincides, what crosses itself.
#include "stock/turning/convex_cut.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace kerf {
namespace {

using turning::Contour;
using turning::ContourBuilder;
using turning::ConvexCut;
using turning::ConvexRegion;
using turning::Point;
using turning::Ring;
using turning::Rings;

Contour contour_of(const Ring& ring) {
  ContourBuilder builder;
  for (const Point& p : ring) builder.append(p);
  return builder.close();
}

ConvexRegion region_of(Ring corners) {
  ConvexRegion region;
  region.assign(corners);
  return region;
}

Ring box(int low_z, int low_r, int high_z, int high_r) {
  return {{low_z, low_r}, {high_z, low_r}, {high_z, high_r}, {low_z, high_r}};
}

std::int64_t area2(const std::vector<Contour>& region) {
  std::int64_t sum = 0;
  for (const Contour& contour : region) sum += contour.area2();
  return sum;
}

std::int64_t removed2(const ConvexCut& cut) {
  std::int64_t sum = 0;
  for (std::size_t i = 0; i < cut.removed_count(); ++i) {
    const auto ring = cut.removed(i);
    sum += plane::twice_area(Ring(ring.begin(), ring.end()));
  }
  return sum;
}

struct Result {
  std::vector<Contour> rest;
  bool met = false;
  std::int64_t removed2 = 0;
};

Result cut(const Ring& subject, const Ring& tool) {
  Result result;
  result.rest = {contour_of(subject)};
  ConvexCut cut;
  result.met = cut.look(result.rest, region_of(tool));
  if (!result.met) return result;
  result.removed2 = removed2(cut);
  cut.apply(result.rest);
  EXPECT_EQ(cut.library_calls(), 0u);
  return result;
}

const Ring kSquare = box(0, 0, 1000, 1000);

TEST(ConvexCut, a_notch_a_hole_a_bite_of_all) {
  const Result notch = cut(kSquare, box(400, 500, 600, 1200));
  EXPECT_EQ(notch.removed2, 2 * 200 * 500);
  EXPECT_EQ(area2(notch.rest), 2 * (1000 * 1000 - 200 * 500));
  ASSERT_EQ(notch.rest.size(), 1u);
  EXPECT_EQ(notch.rest[0].corner_count(), 8u);
  const Result hole = cut(kSquare, box(400, 400, 600, 600));
  ASSERT_EQ(hole.rest.size(), 2u);
  EXPECT_EQ(hole.rest[1].area2(), -2 * 200 * 200);
  const Result all = cut(kSquare, box(-1, -1, 1001, 1001));
  EXPECT_TRUE(all.rest.empty());
  EXPECT_EQ(all.removed2, 2'000'000);
  EXPECT_FALSE(cut(kSquare, box(1001, 0, 1200, 1000)).met);
}

TEST(ConvexCut, edges_on_edges_leave_nothing_thin) {
  // As large as the square, and with two or three sides on its sides.
  EXPECT_TRUE(cut(kSquare, kSquare).rest.empty());
  const Result half = cut(kSquare, box(0, 0, 500, 1000));
  ASSERT_EQ(half.rest.size(), 1u);
  EXPECT_EQ(half.rest[0].corner_count(), 4u);
  EXPECT_EQ(area2(half.rest), 1'000'000);
  const Result middle = cut(kSquare, box(250, 0, 500, 1000));
  EXPECT_EQ(middle.rest.size(), 2u);
  EXPECT_EQ(area2(middle.rest), 1'500'000);
  // Beside it, side on side: a line is nothing in common.
  EXPECT_FALSE(cut(kSquare, box(1000, 200, 1500, 800)).met);
}

TEST(ConvexCut, corners_on_edges_and_corners) {
  // A diamond whose corners lie in the middle of the square's sides: four triangles stay.
  const Result diamond = cut(kSquare, {{500, 0}, {1000, 500}, {500, 1000}, {0, 500}});
  EXPECT_EQ(diamond.rest.size(), 4u);
  EXPECT_EQ(area2(diamond.rest), 1'000'000);
  // A triangle between three corners.
  const Result triangle = cut(kSquare, {{0, 0}, {1000, 0}, {1000, 1000}});
  ASSERT_EQ(triangle.rest.size(), 1u);
  EXPECT_EQ(triangle.rest[0].corner_count(), 3u);
  // A corner that touches a side from outside takes nothing.
  EXPECT_FALSE(cut(kSquare, {{1000, 500}, {1200, 400}, {1200, 600}}).met);
}

TEST(ConvexCut, two_that_hang_together_by_a_point_or_a_line_do_not) {
  // A slot whose far end is on the far side.
  const Result slot = cut(kSquare, {{400, 1200}, {500, 0}, {600, 1200}});
  EXPECT_EQ(slot.rest.size(), 2u);
  std::vector<Contour> rest = {contour_of(kSquare)};
  ConvexCut both;
  for (const Ring& tool : {box(400, 500, 600, 1000), box(400, 0, 600, 500)}) {
    ASSERT_TRUE(both.look(rest, region_of(tool)));
    both.apply(rest);
  }
  EXPECT_EQ(rest.size(), 2u);
}

/// Polygons with corners on few places, so that most of them meet: against the library.
TEST(ConvexCut, random_polygons_on_a_coarse_grid) {
  std::mt19937 random(3);
  const auto place = [&] { return static_cast<turning::Unit>(random() % 9) * 1000; };
  int cuts = 0;
  for (int round = 0; round < 4000; ++round) {
    Rings subject;
    ClipperLib::Clipper unite;
    for (int i = 0; i < 4; ++i) {
      const turning::Unit z = place(), r = place();
      unite.AddPath({{z, r}, {z + 2000 + place(), r}, {z + 1000, r + 1000 + place()}},
                    ClipperLib::ptSubject, true);
    }
    unite.Execute(ClipperLib::ctUnion, subject, ClipperLib::pftNonZero, ClipperLib::pftNonZero);
    std::vector<Contour> region;
    for (const Ring& ring : subject) {
      Contour contour = contour_of(ring);
      if (!contour.runs().empty()) region.push_back(std::move(contour));
    }
    Ring tool;
    for (int i = 0; i < 5; ++i) tool.push_back({place(), place()});
    std::sort(tool.begin(), tool.end(),
              [](const Point& a, const Point& b) { return a.X != b.X ? a.X < b.X : a.Y < b.Y; });
    // Its hull: lower side, then upper side.
    Ring hull;
    for (int side = 0; side < 2; ++side) {
      const std::size_t base = hull.size();
      for (const Point& p : tool) {
        while (hull.size() >= base + 2 && plane::turn(hull[hull.size() - 2], hull.back(), p) <= 0)
          hull.pop_back();
        hull.push_back(p);
      }
      hull.pop_back();
      std::reverse(tool.begin(), tool.end());
    }
    const ConvexRegion convex = region_of(hull);
    if (convex.empty()) continue;
    Rings expected;
    ClipperLib::Clipper clipper;
    for (const Contour& contour : region)
      clipper.AddPath(contour.ring(), ClipperLib::ptSubject, true);
    clipper.AddPath(convex.corners(), ClipperLib::ptClip, true);
    clipper.Execute(ClipperLib::ctDifference, expected, ClipperLib::pftNonZero,
                    ClipperLib::pftNonZero);
    double left = 0;
    for (const Ring& ring : expected) left += static_cast<double>(plane::twice_area(ring));
    const auto before = static_cast<double>(area2(region));
    ConvexCut cut;
    double removed = 0;
    if (cut.look(region, convex)) {
      removed = static_cast<double>(removed2(cut));
      cut.apply(region);
      ++cuts;
    }
    // Crossings are rounded to a unit, edges are up to 17000 long.
    EXPECT_NEAR(static_cast<double>(area2(region)), left, 1e5) << "round " << round;
    // Holes of the region count as removed where they lie in the tool.
    EXPECT_GE(removed, before - left - 1e5) << "round " << round;
    EXPECT_EQ(cut.library_calls(), 0u) << "round " << round;
  }
  EXPECT_GT(cuts, 2000);
}

TEST(ConvexCut, contours_that_cross_are_made_right) {
  // Two squares that overlap, as rounding may leave two contours, and a tool over the crossing.
  std::vector<Contour> region = {contour_of(kSquare), contour_of(box(900, 0, 2000, 1000))};
  ConvexCut cut;
  ASSERT_TRUE(cut.look(region, region_of(box(500, 500, 1500, 1500))));
  EXPECT_EQ(cut.library_calls(), 1u);
  EXPECT_EQ(removed2(cut), 2 * 1000 * 500);
  cut.apply(region);
  ASSERT_EQ(region.size(), 1u);
  EXPECT_EQ(area2(region), 2 * (2000 * 1000 - 1000 * 500));
}

TEST(ConvexCut, shreds_go_with_the_tool) {
  // Nine units are left over a length of 1000: less than a tenth of a micrometre.
  EXPECT_TRUE(cut(kSquare, box(-10, -10, 1010, 991)).rest.empty());
  EXPECT_EQ(cut(kSquare, box(-10, -10, 1010, 980)).rest.size(), 1u);
}

TEST(ConvexCut, runs_are_shared_and_keep_their_sums) {
  // A comb of 2000 corners; a tool at one end leaves the runs of the other.
  Ring comb;
  for (int i = 0; i < 1000; ++i) {
    comb.push_back({1000 * i, 0});
    comb.push_back({1000 * i + 500, 300});
  }
  comb.push_back({1'000'000, 5000});
  comb.push_back({0, 5000});
  std::vector<Contour> region = {contour_of(comb)};
  const std::vector<Contour> before = region;
  ConvexCut cut;
  ASSERT_TRUE(cut.look(region, region_of(box(100'000, -100, 103'000, 2000))));
  cut.apply(region);
  std::size_t shared = 0;
  for (const turning::RunPointer& run : region[0].runs()) shared += run.use_count() > 1 ? 1 : 0;
  EXPECT_GT(shared, region[0].runs().size() - 4);
  EXPECT_EQ(region[0].area2(), plane::twice_area(region[0].ring()));
  EXPECT_EQ(before[0].area2(), plane::twice_area(before[0].ring()));
  for (const turning::RunPointer& run : region[0].runs()) EXPECT_LE(run->points.size(), 200u);
  turning::Wide moment6 = 0;
  const Ring ring = region[0].ring();
  for (std::size_t i = 0; i < ring.size(); ++i)
    moment6 += turning::moment6_of(ring[i], ring[(i + 1) % ring.size()]);
  EXPECT_TRUE(moment6 == region[0].moment6());
}

}  // namespace
}  // namespace kerf
