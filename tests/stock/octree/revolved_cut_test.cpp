// What lies beyond a body that turns is taken away: closed forms, an oracle that asks the profile
// node by node, equal bits.
#include "stock/octree/revolved_cut.h"

#include <algorithm>
#include <cmath>

#include "tests/stock/octree/octree_samples.h"

namespace kerf::test {
namespace {

using octree::RevolvedBody;
using octree::ZRange;
using Chain = std::vector<Vec2>;  // (z, r)

constexpr ZRange kAll{-1000, 1000};

bool is_inside(const RevolvedBody& body, const Vec3& p) {
  const double z = p.z, r = std::hypot(p.x, p.y);
  bool inside = false;
  for (const Chain& ring : body.chains_mm) {
    for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) {
      const Vec2 &a = ring[i], &b = ring[j];
      if ((a.x > z) == (b.x > z)) continue;
      if (r < a.y + (z - a.x) / (b.x - a.x) * (b.y - a.y)) inside = !inside;
    }
  }
  for (int flat = 0; flat < body.flats; ++flat) {
    const double angle = 2 * kPi * flat / body.flats;
    if (p.x * std::cos(angle) + p.y * std::sin(angle) >= body.inner_radius_mm) return false;
  }
  return inside;
}

double distance_to(const Vec2& a, const Vec2& b, const Vec2& p) {
  const Vec2 d = b - a;
  const double length2 = glm::dot(d, d);
  const double t = length2 > 0 ? std::clamp(glm::dot(p - a, d) / length2, 0.0, 1.0) : 0;
  return glm::length(a + t * d - p);
}

/// From the surface, of a point on it.
double off_surface(const RevolvedBody& body, const Vec3& p) {
  double least = 1e9;
  const Vec2 at(p.z, std::hypot(p.x, p.y));
  for (const Chain& ring : body.chains_mm)
    for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++)
      least = std::min(least, distance_to(ring[j], ring[i], at));
  for (int flat = 0; flat < body.flats; ++flat) {
    const double angle = 2 * kPi * flat / body.flats;
    least = std::min(
        least, std::abs(p.x * std::cos(angle) + p.y * std::sin(angle) - body.inner_radius_mm));
  }
  return least;
}

std::unique_ptr<Octree> kept_within(const std::string& blank, double cell, const RevolvedBody& body,
                                    int threads = 1) {
  auto tree = make_octree(blank, cell, threads);
  tree->keep_within(body, kAll);
  return tree;
}

/// A shaft with a cone, a groove, a bore, and a ring of air inside.
RevolvedBody shaft() {
  return {{{{-40, 4},
            {-40, 15},
            {-25, 15},
            {-24, 12},
            {-21, 12},
            {-20, 15},
            {-12, 15},
            {-2, 8},
            {0, 8},
            {0, 0},
            {-30, 0},
            {-31.5, 4}},
           {{-35, 7}, {-35, 9}, {-33, 9}, {-33, 7}}}};
}

TEST(RevolvedCut, ABarIsTheBlankOfThatShape) {
  const RevolvedBody bar{{{{-20, 0}, {-20, 9.3}, {3, 9.3}, {3, 0}}}};
  const auto kept = kept_within("box:-9.3,-9.3,-20:9.3,9.3,3", 0.4, bar);
  const auto blank = make_octree("cylinder:0,0,-20:3:18.6", 0.4);
  EXPECT_NEAR(kept->remaining_mm3(), blank->remaining_mm3(), 1e-3 * blank->remaining_mm3());
  const HermiteGrid a = whole(*kept), b = whole(*blank);
  EXPECT_EQ(a.solid, b.solid);
  const auto of = surface_points(a), that = surface_points(b);
  ASSERT_EQ(of.size(), that.size());
  for (std::size_t i = 0; i < of.size(); ++i) {
    ASSERT_LT(glm::length(of[i].at - that[i].at), 2e-5) << i;
    // Where two faces meet either normal is right.
    if (glm::length(of[i].normal - that[i].normal) < 1e-3) continue;
    ASSERT_NEAR(std::hypot(of[i].at.x, of[i].at.y), 9.3, 1e-4) << i;
  }
}

TEST(RevolvedCut, NodesAndCrossingsAreThoseOfTheProfile) {
  for (const int flats : {0, 6, 4}) {
    RevolvedBody body = shaft();
    body.flats = flats;
    body.inner_radius_mm = 13;
    for (const double cell : {0.5, 0.83}) {
      const auto tree = kept_within("box:-15,-15,-40:15,15,0", cell, body);
      const HermiteGrid grid = whole(*tree);
      expect_sound(grid);
      int wrong = 0;
      for (int k = 0; k < grid.nodes[2]; ++k)
        for (int j = 0; j < grid.nodes[1]; ++j)
          for (int i = 0; i < grid.nodes[0]; ++i) {
            const Vec3 p = grid.origin_mm + Vec3(i, j, k) * grid.cell_mm;
            const std::size_t n =
                static_cast<std::size_t>((k * grid.nodes[1] + j) * grid.nodes[0] + i);
            if (off_surface(body, p) > 1e-9) wrong += is_inside(body, p) != (grid.solid[n] != 0);
          }
      EXPECT_EQ(wrong, 0) << flats << ' ' << cell;
      for (const SurfacePoint& p : surface_points(grid)) {
        ASSERT_LT(off_surface(body, p.at), 2e-5) << flats;
        // A little inward there is material, a little outward none.
        if (off_surface(body, p.at + 2e-3 * p.normal) < 1.9e-3) continue;  // beside an edge
        ASSERT_FALSE(is_inside(body, p.at + 2e-3 * p.normal)) << flats;
        ASSERT_TRUE(is_inside(body, p.at - 2e-3 * p.normal) ||
                    off_surface(body, p.at - 2e-3 * p.normal) < 1.9e-3);
      }
    }
  }
}

TEST(RevolvedCut, VolumesAreThoseOfClosedForms) {
  const double cell = 0.25;
  const RevolvedBody cone{{{{-30, 0}, {-30, 12}, {0, 3}, {0, 0}}}};
  const double cone_mm3 = kPi / 3 * 30 * (144 + 36 + 9);
  EXPECT_NEAR(kept_within("box:-12,-12,-30:12,12,0", cell, cone)->remaining_mm3(), cone_mm3,
              2e-4 * cone_mm3);
  RevolvedBody hexagon{{{{-10, 0}, {-10, 20}, {0, 20}, {0, 0}}}, 6, 12};
  const double hexagon_mm3 = 2 * std::sqrt(3.0) * 144 * 10;
  EXPECT_NEAR(kept_within("box:-20,-20,-10:20,20,0", cell, hexagon)->remaining_mm3(), hexagon_mm3,
              2e-4 * hexagon_mm3);
  Chain disc;
  for (int i = 0; i < 720; ++i)
    disc.push_back({-5 + 4 * std::cos(kPi * i / 360), 10 + 4 * std::sin(kPi * i / 360)});
  const double torus_mm3 = 2 * kPi * kPi * 10 * 16;
  EXPECT_NEAR(kept_within("box:-14,-14,-9:14,14,-1", cell, {{disc}})->remaining_mm3(), torus_mm3,
              5e-4 * torus_mm3);
}

TEST(RevolvedCut, WhatIsMilledStays) {
  const Cutter mill = make_cutter("flat:6");
  const std::vector<CutMove> slot{line({-30, 0, -3}, {30, 0, -3}, 1),
                                  line({20, 3, -18}, {10, 3, -18}, 2, {1, 0, 0})};
  const auto first = make_octree("box:-15,-15,-40:15,15,0", 0.5);
  cut(*first, mill, slot);
  first->keep_within(shaft(), kAll);
  const auto last = make_octree("box:-15,-15,-40:15,15,0", 0.5);
  last->keep_within(shaft(), kAll);
  cut(*last, mill, slot);
  // Either way the same body; crossings where both surfaces are differ by rounding.
  const HermiteGrid a = whole(*first), b = whole(*last);
  EXPECT_EQ(a.solid, b.solid);
  expect_sound(a);
  EXPECT_NEAR(first->remaining_mm3(), last->remaining_mm3(), 1e-4 * last->remaining_mm3());
  const auto of = surface_points(a), that = surface_points(b);
  ASSERT_EQ(of.size(), that.size());
  for (std::size_t i = 0; i < of.size(); ++i) ASSERT_LT(glm::length(of[i].at - that[i].at), 5e-5);
}

TEST(RevolvedCut, BitsDependOnNothingElse) {
  const std::string blank = "box:-15,-15,-40:15,15,0";
  const auto tree = kept_within(blank, 0.4, shaft());
  EXPECT_EQ(tree->digest(), kept_within(blank, 0.4, shaft(), 3)->digest());
  const std::string digest = tree->digest();
  EXPECT_EQ(tree->keep_within(shaft(), kAll), 0);
  EXPECT_EQ(tree->digest(), digest);
  // In steps, each told of no more than has changed.
  RevolvedBody plain = shaft(), next = shaft();
  plain.chains_mm[0] = {{-40, 0}, {-40, 15}, {0, 15}, {0, 0}};
  next.chains_mm[0] = {{-40, 0}, {-40, 15}, {-12, 15}, {-2, 8}, {0, 8}, {0, 0}};
  const auto whole_way = kept_within(blank, 0.4, next);
  const auto in_steps = kept_within(blank, 0.4, plain);
  EXPECT_GT(in_steps->keep_within(next, {-12, 0}), 0);
  EXPECT_EQ(in_steps->digest(), whole_way->digest());
}

}  // namespace
}  // namespace kerf::test
