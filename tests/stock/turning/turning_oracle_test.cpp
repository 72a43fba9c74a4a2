// Random programs against a tool that is looked at in many places of its way.
#include "tests/stock/turning/turning_oracle.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/stock/insert_points.h"

namespace kerf {
namespace {

using namespace turning_test;

/// The oracle's steps, and what outlines, ways and rounding may differ by.
constexpr double kStep_mm = 2e-3, kUnsure_mm = 2e-3;

TEST(TurningOracle, points_are_material_where_no_tool_came) {
  int cut = 0, left = 0, fallen = 0;
  for (unsigned seed = 0; seed < 30; ++seed) {
    std::mt19937 random(seed);
    TurnedPart part = *TurnedPart::create(bar_profile(-30, 0, 40));
    std::vector<InsertOutline> outlines;
    const std::vector<TurnMove> moves = random_moves(random, 12);
    double removed = 0;
    for (std::size_t i = 0; i < moves.size(); ++i) {
      outlines.push_back(i % 3 == 0 ? random_tool(random) : outlines.back());
      removed += part.cut(TurningTool(outlines.back()), moves[i]).removed_mm3;
    }
    for (const TurnedPiece& piece : part.freed()) removed += piece.volume_mm3;
    EXPECT_NEAR(part.blank_mm3() - removed, part.remaining_mm3(), 1e-6) << "seed " << seed;
    const TurnedProfile profile = part.profile();
    std::uniform_real_distribution<double> z(-30, 0), r(0, 20);
    for (int k = 0; k < 1000; ++k) {
      const Vec2 p{z(random), r(random)};
      double least = 1e300, t = 0;
      for (std::size_t i = 0; i < moves.size() && least > -kUnsure_mm; ++i)
        least = std::min(least, least_distance(outlines[i], moves[i], p, kStep_mm, t));
      if (std::abs(least) < kUnsure_mm + kStep_mm / 2) continue;
      const bool is_there = is_within(profile, p);
      const bool fell =
          !is_there &&
          std::any_of(part.freed().begin(), part.freed().end(), [&](const TurnedPiece& piece) {
            return p.x > piece.low_z_mm && p.x < piece.high_z_mm && p.y > piece.low_r_mm &&
                   p.y < piece.high_r_mm;
          });
      if (least > 0 && fell) {
        ++fallen;
        continue;
      }
      ASSERT_EQ(is_there, least > 0)
          << fmt::format("seed {} at z {} r {}, {} from the tool", seed, p.x, p.y, least);
      ++(is_there ? left : cut);
    }
  }
  EXPECT_GT(cut, 4000);
  EXPECT_GT(left, 4000);
  EXPECT_GT(fallen, 10);
}

/// Corners that a move makes lie on what it sweeps, within what is promised.
TEST(TurningOracle, contours_are_within_a_tenth_of_a_micrometre) {
  for (unsigned seed = 100; seed < 130; ++seed) {
    std::mt19937 random(seed);
    TurnedPart part = *TurnedPart::create(bar_profile(-30, 0, 40));
    const InsertOutline outline = random_tool(random);
    const TurnMove move = random_moves(random, 1)[0];
    if (part.cut(TurningTool(outline), move).removed_mm3 == 0) continue;
    for (const std::vector<Vec2>& ring : part.profile()) {
      for (const Vec2& p : ring) {
        const bool on_blank = p.x < -29.999 || p.x > -0.001 || p.y < 0.001 || p.y > 19.999;
        double t = 0;
        // 0.1 um of the outline, 0.02 of the way, and a step of the grid; where the outline is
        // nearest its distance changes with the square of the oracle's steps.
        if (!on_blank) {
          EXPECT_NEAR(least_distance(outline, move, p, 1e-4, t), 0, 1.3e-4)
              << fmt::format("seed {} at z {} r {}", seed, p.x, p.y);
        }
      }
    }
  }
}

TEST(TurningOracle, first_contact_is_where_the_tool_comes_to_material) {
  int met = 0, missed = 0;
  for (unsigned seed = 200; seed < 230; ++seed) {
    std::mt19937 random(seed);
    TurnedPart part = *TurnedPart::create(bar_profile(-30, 0, 40));
    const std::vector<TurnMove> moves = random_moves(random, 8);
    for (std::size_t i = 0; i + 1 < moves.size(); ++i)
      part.cut(TurningTool(random_tool(random)), moves[i]);
    const InsertOutline outline = random_tool(random);
    const TurnMove& move = moves.back();
    const std::string digest = part.digest();
    const double tolerance = 0.05;
    const std::optional<TurnContact> contact =
        part.first_contact(TurningTool(outline).inset(tolerance), move);
    EXPECT_EQ(part.digest(), digest);
    // Over points of the material's border and inside: the first place with one so deep in it.
    double first = 2;
    const TurnedProfile profile = part.profile();
    std::vector<Vec2> points;
    for (const std::vector<Vec2>& ring : profile) {
      for (std::size_t i = 0; i < ring.size(); ++i) {
        const Vec2 &a = ring[i], &b = ring[(i + 1) % ring.size()];
        const int steps = 1 + static_cast<int>(glm::distance(a, b) / 0.05);
        for (int k = 0; k < steps; ++k) points.push_back(a + (k / double(steps)) * (b - a));
      }
    }
    constexpr int kSteps = 400;
    for (int step = 0; step <= kSteps && first > 1; ++step) {
      const Vec2 place = place_at(move, step / double(kSteps));
      for (const Vec2& p : points) {
        if (distance_to_tool(outline, p - place) > -tolerance &&
            distance_to_tool(outline, Vec2(p.x, -p.y) - place) > -tolerance)
          continue;
        first = step / double(kSteps);
        break;
      }
    }
    if (first > 1) {
      // Points 0.05 mm apart may miss a corner of the tool, but not much of it.
      EXPECT_LT(contact ? contact->depth_mm : 0, 0.06) << "seed " << seed;
      ++missed;
      continue;
    }
    ASSERT_TRUE(contact) << "seed " << seed;
    EXPECT_LE(contact->t, first + 1e-6) << "seed " << seed;
    // A step, and how far it goes until the nearest point is reached.
    EXPECT_GE(contact->t, first - (1.0 / kSteps + 0.3 / length_of(move))) << "seed " << seed;
    EXPECT_GT(contact->depth_mm, 0);
    ++met;
  }
  EXPECT_GT(met, 10);
  EXPECT_GT(missed, 1);
}

/// How far ahead the outline reaches at an offset across the way; none where it is not.
std::optional<double> front_at(const std::vector<Vec2>& outline, const Vec2& way, double across) {
  std::optional<double> front;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Vec2 &a = outline[i], &b = outline[(i + 1) % outline.size()];
    const double from = cross(way, a) - across, to = cross(way, b) - across;
    if ((from > 0) == (to > 0)) continue;
    const double ahead = glm::dot(way, a + from / (from - to) * (b - a));
    front = std::max(front.value_or(-1e300), ahead);
  }
  return front;
}

/// The outline as a polygon.
std::vector<Vec2> polygon_of(const InsertPart& part) { return insert_points(part, 100); }

/// The most of the front, at places of a straight way, that is in the material there was before.
double deepest_front(const InsertPart& part, const Vec2& from, const Vec2& to,
                     const TurnedProfile& before) {
  constexpr double kAcross_mm = 0.04;
  constexpr int kPlaces = 800;
  const std::vector<Vec2> outline = polygon_of(part);
  const Vec2 way = glm::normalize(to - from), side(-way.y, way.x);
  std::vector<Vec2> front;  // just before it, so that what it is on counts
  for (double across = -15; across < 15; across += kAcross_mm) {
    if (const std::optional<double> ahead = front_at(outline, way, across))
      front.push_back((*ahead + 1e-4) * way + across * side);
  }
  double deepest = 0;
  for (int i = 0; i < kPlaces; ++i) {
    const Vec2 place = from + (i + 0.5) / kPlaces * (to - from);
    const auto in = std::count_if(front.begin(), front.end(),
                                  [&](const Vec2& p) { return is_within(before, place + p); });
    deepest = std::max(deepest, kAcross_mm * static_cast<double>(in));
  }
  return deepest;
}

TEST(TurningOracle, depths_are_how_much_of_the_front_is_in_material) {
  int cuts = 0;
  for (unsigned seed = 300; seed < 315; ++seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> z(-32, 4), x(12, 24);
    TurnedPart part = *TurnedPart::create(bar_profile(-30, 0, 40));
    InsertOutline outline = round_insert(1.5);
    if (seed % 3 == 1) outline = right_hand(0.8);
    if (seed % 3 == 2) outline = *groove_insert({3, 0.4, 12, 6, false, radians(2)});
    const TurningTool tool(outline);
    Vec2 at(2, 24);
    for (int i = 0; i < 6; ++i) {
      const Vec2 to{z(random), x(random)};
      const TurnedProfile before = part.profile();
      const TurnCut cut = part.cut(tool, line(at, to));
      if (cut.depth_mm > 0.2) {
        // Steps across, at both ends of each stretch, and a place between two where it is deepest.
        const double deepest = deepest_front(outline.parts[0], at, to, before);
        EXPECT_NEAR(cut.depth_mm, deepest, 0.1 + 0.03 * deepest) << "seed " << seed << ' ' << i;
        ++cuts;
      }
      at = to;
    }
  }
  EXPECT_GT(cuts, 30);
}

}  // namespace
}  // namespace kerf
