// Which feeds may join a chain, against one point after the other.
#include "interp_bridge/timing/merge.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <random>
#include <vector>

namespace kerf {
namespace {

constexpr double kTolerance_mm = 0.01;

/// Along X, each `off` beside it but the one at `place`, which is `far`.
MergeChain chain_of(int count, int place, double off, double far) {
  MergeChain chain;
  chain.begin({0, 0, 0}, 50, 0, 0);
  for (int i = 0; i < count; ++i) chain.append({i + 1.0, i == place ? far : off, 0});
  return chain;
}

TEST(MergeChain, OnePointTooFarBesideEndsItWhereverItIs) {
  for (int count = 1; count <= 9; ++count) {
    const Vec3 end(count + 1.0, 0, 0);
    for (int place = 0; place < count; ++place) {
      EXPECT_FALSE(chain_of(count, place, 0.0099, 0.0101).links(end, kTolerance_mm))
          << count << " " << place;
      EXPECT_TRUE(chain_of(count, place, -0.0099, 0.0099).links(end, kTolerance_mm))
          << count << " " << place;
    }
  }
}

TEST(MergeChain, BeyondItsEndsTheDistanceIsThatFromThem) {
  // 0.02 behind the start, 0.005 ahead of the end.
  EXPECT_FALSE(chain_of(1, 0, 0, 0).links({0.98, 0, 0}, kTolerance_mm));
  EXPECT_TRUE(chain_of(1, 0, 0, 0).links({0.995, 0, 0}, kTolerance_mm));
  MergeChain back;
  back.begin({0, 0, 0}, 50, 0, 0);
  back.append({-0.02, 0, 0});
  EXPECT_FALSE(back.links({1, 0, 0}, kTolerance_mm));
  EXPECT_FALSE(back.links({0, 0, 0}, kTolerance_mm)) << "back to the start";
}

TEST(MergeChain, FullItTakesNoMore) {
  const int most = static_cast<int>(MergeChain::kMost);
  EXPECT_TRUE(chain_of(most - 1, 0, 0, 0).links({most + 1.0, 0, 0}, kTolerance_mm));
  EXPECT_FALSE(chain_of(most, 0, 0, 0).links({most + 1.0, 0, 0}, kTolerance_mm));
}

TEST(MergeChain, DecidesAsOnePointAfterTheOther) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> place(-1, 1);
  int yes = 0;
  for (int round = 0; round < 20'000; ++round) {
    const Vec3 start(place(random), place(random), place(random));
    MergeChain chain;
    chain.begin(start, 50, 0, 0);
    std::vector<Vec3> points;
    const int count = 1 + round % 7;
    for (int i = 0; i < count; ++i) {
      points.push_back(start + Vec3(0.1 * i + 0.1, 0.001 * place(random), 0.001 * place(random)));
      chain.append(points.back());
    }
    const Vec3 end = start + Vec3(0.1 * count + 0.1, 0.001 * place(random), 0.001 * place(random));
    const Vec3 chord = end - start;
    double most = 0;
    for (const Vec3& point : points) {
      const Vec3 out = point - start;
      const double part = std::clamp(glm::dot(chord, out) / glm::dot(chord, chord), 0.0, 1.0);
      const Vec3 off = out - part * chord;
      most = std::max(most, glm::dot(off, off));
    }
    constexpr double kClose_mm = 0.001;
    const bool links = most <= kClose_mm * kClose_mm;
    ASSERT_EQ(chain.links(end, kClose_mm), links) << round;
    yes += links ? 1 : 0;
  }
  EXPECT_GT(yes, 2000);
  EXPECT_LT(yes, 18'000);
}

}  // namespace
}  // namespace kerf
