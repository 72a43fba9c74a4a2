// Random programs against a tool that is looked at in many places of its way.
#include "tests/stock/turning/turning_oracle.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

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
    for (int k = 0; k < 250; ++k) {
      const Vec2 p(z(random), r(random));
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
  EXPECT_GT(cut, 1000);
  EXPECT_GT(left, 1000);
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
        // Steps of 20 um: beside its least the distance changes with their square, and straight
        // ways and noses are what it is tested with here.
        if (!on_blank) {
          EXPECT_NEAR(least_distance(outline, move, p, 1e-4, t), 0, 3e-4)
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

}  // namespace
}  // namespace kerf
