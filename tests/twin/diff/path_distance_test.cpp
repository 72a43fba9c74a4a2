#include "twin/diff/path_distance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <glm/geometric.hpp>
#include <random>

#include "tests/twin/diff/diff_support.h"
#include "twin/motion/motion_geometry.h"

namespace kerf {
namespace {

constexpr double kEnough_mm = 0.001;

double apart(const StepWriter& a, const StepWriter& b) {
  const double there = path_distance(a.steps(), b.steps(), kEnough_mm).mm;
  EXPECT_NEAR(path_distance(b.steps(), a.steps(), kEnough_mm).mm, there, 1e-12);
  return there;
}

TEST(PathDistance, ALineInThreeIsTheLine) {
  const StepWriter whole = StepWriter().feed({30, 40, -5});
  const StepWriter parts = StepWriter().feed({3, 4, -0.5}).feed({21, 28, -3.5}).feed({30, 40, -5});
  EXPECT_LT(apart(whole, parts), 1e-12);
}

/// The middle of a chord of n in a full circle lies r (1 - cos(pi / n)) inside.
TEST(PathDistance, ChordsAreOffByTheirSagitta) {
  for (const int count : {8, 90, 1000}) {
    const StepWriter arc = StepWriter({20, 0, 0}).arc({0, 0, 0}, 2 * kPi);
    const StepWriter chords = StepWriter({20, 0, 0}).chords({0, 0, 0}, 2 * kPi, count);
    EXPECT_NEAR(apart(arc, chords), 20 * (1 - std::cos(kPi / count)), 1e-9) << count;
  }
}

/// Points of both all lie on the circle; only their order tells them apart.
TEST(PathDistance, TwiceRoundIsNotOnceRound) {
  const StepWriter once = StepWriter({20, 0, 0}).arc({0, 0, 0}, 2 * kPi);
  const StepWriter twice = StepWriter({20, 0, 0}).arc({0, 0, 0}, 4 * kPi);
  EXPECT_GT(apart(once, twice), 20);
}

TEST(PathDistance, ThereAndBackIsNotStandingStill) {
  const StepWriter straight = StepWriter().feed({10, 0, 0}).feed({20, 0, 0});
  const StepWriter aside =
      StepWriter().feed({10, 0, 0}).feed({10, 3, 0}).feed({10, 0, 0}).feed({20, 0, 0});
  EXPECT_NEAR(apart(straight, aside), 3, 1e-9);
}

/// A way that crosses itself: what comes by later is not taken for what is near now.
TEST(PathDistance, AZigzagWithCrossingsIsItself) {
  StepWriter one, halves;
  for (int i = 0; i < 40; ++i) {
    const Vec3 to(i % 2 == 0 ? 50 : 0, (i * 7) % 40, 0);
    one.feed(to);
  }
  for (const DiffStep& step : one.steps()) {
    halves.feed((step.from_mm + step.to_mm) / 2.0);
    halves.feed(step.to_mm);
  }
  EXPECT_LT(apart(one, halves), 1e-9);
}

TEST(PathDistance, AnAngleCountsByItsLever) {
  std::vector<DiffStep> a = StepWriter().feed({10, 0, 0}).steps();
  std::vector<DiffStep> b = a;
  b[0].to_abc_deg[0] = 1;
  EXPECT_NEAR(path_distance(a, b, kEnough_mm).mm, kTurnLever_mm * kPi / 180, 0.2);
}

/// Frechet's distance of dense points, by dynamic programming (T. Eiter, H. Mannila, 1994).
double frechet_mm(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  std::vector<std::vector<double>> table(a.size(), std::vector<double>(b.size()));
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t j = 0; j < b.size(); ++j) {
      double before = 0;
      if (i > 0 && j > 0) {
        before = std::min({table[i - 1][j], table[i][j - 1], table[i - 1][j - 1]});
      } else if (i > 0) {
        before = table[i - 1][j];
      } else if (j > 0) {
        before = table[i][j - 1];
      }
      table[i][j] = std::max(before, glm::length(a[i] - b[j]));
    }
  }
  return table.back().back();
}

std::vector<Vec3> dense(const std::vector<DiffStep>& steps, double every_mm) {
  std::vector<Vec3> points{steps.front().from_mm};
  for (const DiffStep& step : steps) {
    const Motion m = motion_of(step);
    const int count = std::max(1, static_cast<int>(path_length_mm(m) / every_mm));
    for (int i = 1; i <= count; ++i) {
      points.push_back(point_at(m, static_cast<double>(i) / count));
    }
  }
  return points;
}

/// Random ways and the same ones with their corners moved a little: never less than what dense
/// points say (up to their spacing), and never more than the corners were moved.
TEST(PathDistance, AgreesWithDensePoints) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> far(0, 40), little(-0.05, 0.05);
  for (int round = 0; round < 30; ++round) {
    StepWriter a, b;
    double moved_mm = 0;
    for (int i = 0; i < 12; ++i) {
      const Vec3 to{far(random), far(random), far(random) / 10};
      const Vec3 off{little(random), little(random), little(random)};
      a.feed(to);
      b.feed(to + off);
      moved_mm = std::max(moved_mm, glm::length(off));
    }
    const double found_mm = apart(a, b);
    EXPECT_LE(found_mm, moved_mm + 1e-9) << round;
    constexpr double kEvery_mm = 0.5;
    const double points_mm = frechet_mm(dense(a.steps(), kEvery_mm), dense(b.steps(), kEvery_mm));
    EXPECT_LE(found_mm, points_mm + 1e-9) << round;
    EXPECT_GT(found_mm, 0.3 * moved_mm) << round;
  }
}

}  // namespace
}  // namespace kerf
