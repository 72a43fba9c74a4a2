#include "viewer/window/path_thinning.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>
#include <random>
#include <string>

namespace kerf {
namespace {

/// What double adds up to where places are some hundred mm from zero.
constexpr double kRounding_mm = 1e-9;

double distance_to_segment(const Vec3& at, const Vec3& from, const Vec3& to) {
  const Vec3 along = to - from;
  const double length2 = glm::dot(along, along);
  const double share = length2 > 0 ? glm::dot(at - from, along) / length2 : 0.0;
  return glm::length(at - from - std::clamp(share, 0.0, 1.0) * along);
}

Vec3 place(const PathVertex& vertex) { return Vec3(vertex.position_mm); }

/// The farthest that a vertex is from the chord that replaced it.
double farthest_left_out(const std::vector<PathVertex>& path,
                         const std::vector<std::uint32_t>& kept) {
  double farthest_mm = 0.0;
  for (std::size_t i = 1; i < kept.size(); ++i) {
    for (std::uint32_t v = kept[i - 1]; v <= kept[i]; ++v) {
      farthest_mm = std::max(
          farthest_mm,
          distance_to_segment(place(path[v]), place(path[kept[i - 1]]), place(path[kept[i]])));
    }
  }
  return farthest_mm;
}

/// The farthest that a place of a chord is from the segments that it replaced, by samples of it.
double farthest_chord(const std::vector<PathVertex>& path, const std::vector<std::uint32_t>& kept) {
  constexpr int kSamples = 16;
  double farthest_mm = 0.0;
  for (std::size_t i = 1; i < kept.size(); ++i) {
    for (int sample = 0; sample <= kSamples; ++sample) {
      const double share = static_cast<double>(sample) / kSamples;
      const Vec3 at = glm::mix(place(path[kept[i - 1]]), place(path[kept[i]]), share);
      double nearest_mm = std::numeric_limits<double>::infinity();
      for (std::uint32_t v = kept[i - 1]; v < kept[i]; ++v) {
        nearest_mm =
            std::min(nearest_mm, distance_to_segment(at, place(path[v]), place(path[v + 1])));
      }
      farthest_mm = std::max(farthest_mm, nearest_mm);
    }
  }
  return farthest_mm;
}

void expect_whole(const std::vector<PathVertex>& path, const std::vector<std::uint32_t>& kept) {
  ASSERT_FALSE(kept.empty());
  EXPECT_EQ(kept.front(), 0u);
  EXPECT_EQ(kept.back(), path.size() - 1);
  for (std::size_t i = 1; i < kept.size(); ++i) {
    ASSERT_LT(kept[i - 1], kept[i]);
    for (std::uint32_t v = kept[i - 1] + 1; v <= kept[i]; ++v) {
      ASSERT_EQ(path[v].kind, path[kept[i]].kind) << v;
    }
  }
}

/// Wanders: smooth ways, corners, places that come twice, other kinds.
std::vector<PathVertex> random_path(unsigned seed, std::size_t count) {
  std::mt19937 random(seed);
  const auto share = [&random] { return std::uniform_real_distribution<double>(0, 1)(random); };
  std::vector<PathVertex> path;
  Vec3 at(200.0, -150.0, 10.0), step(0.2, 0.0, 0.0);
  PathKind kind = PathKind::kTraverse;
  while (path.size() < count) {
    if (share() < 0.01) kind = static_cast<PathKind>(path.size() % 3);
    if (share() < 0.02) step = 0.5 * Vec3(share() - 0.5, share() - 0.5, share() - 0.5);
    if (share() < 0.05) step = -step;
    step += 0.02 * Vec3(share() - 0.5, share() - 0.5, share() - 0.5);
    if (share() > 0.03) at += step;
    path.push_back(PathVertex{glm::vec3(at), kind});
  }
  return path;
}

class ThinnedPath : public testing::TestWithParam<unsigned> {};

TEST_P(ThinnedPath, IsNowhereFurtherFromThePathThanTheTolerance) {
  SCOPED_TRACE("seed " + std::to_string(GetParam()));
  const std::vector<PathVertex> path = random_path(GetParam(), 1500);
  std::size_t last = path.size();
  for (const double tolerance_mm : {0.0, 0.003, 0.02, 0.3, 5.0, 1000.0}) {
    const std::vector<std::uint32_t> kept = thinned_path(path, tolerance_mm);
    expect_whole(path, kept);
    EXPECT_LE(farthest_left_out(path, kept), tolerance_mm + kRounding_mm);
    EXPECT_LE(farthest_chord(path, kept), tolerance_mm + kRounding_mm);
    EXPECT_LE(kept.size(), last) << tolerance_mm;
    last = kept.size();
  }
  // Of so large a tolerance only the changes of kind are left.
  std::size_t changes = 0;
  for (std::size_t i = 2; i < path.size(); ++i) changes += path[i].kind != path[i - 1].kind;
  EXPECT_EQ(last, changes + 2);
}

TEST_P(ThinnedPath, HasLevelsWithinTheirTolerancesAndHalfAsManyVerticesEach) {
  SCOPED_TRACE("seed " + std::to_string(GetParam()));
  const std::vector<PathVertex> path = random_path(GetParam(), kPathChunkSegments + 1);
  const std::vector<PathLevel> levels = path_levels(path);
  ASSERT_GE(levels.size(), 3u);
  std::size_t last = path.size();
  double last_mm = 0.0;
  for (const PathLevel& level : levels) {
    expect_whole(path, level.kept);
    EXPECT_LE(farthest_left_out(path, level.kept), level.tolerance_mm + kRounding_mm);
    EXPECT_LE(farthest_chord(path, level.kept), level.tolerance_mm + kRounding_mm);
    EXPECT_LE(2 * level.kept.size(), last);
    EXPECT_GT(level.tolerance_mm, last_mm);
    last = level.kept.size();
    last_mm = level.tolerance_mm;
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, ThinnedPath, testing::Range(1u, 9u));

TEST(ThinnedPathOf, AStraightLineHasChordsOfTheLengthAllowed) {
  constexpr double kEdge_mm = 0.25;
  std::vector<PathVertex> path;
  for (int i = 0; i <= 1000; ++i) {
    path.push_back(PathVertex{{static_cast<float>(kEdge_mm * i), 3.0f, -1.0f}});
  }
  EXPECT_EQ(thinned_path(path, kEdge_mm * 1000 / kLongestChord),
            (std::vector<std::uint32_t>{0, 1000}));
  const std::vector<std::uint32_t> kept = thinned_path(path, kEdge_mm * 10.5 / kLongestChord);
  ASSERT_EQ(kept.size(), 101u);
  for (std::uint32_t i = 0; i < kept.size(); ++i) EXPECT_EQ(kept[i], 10 * i);
}

TEST(ThinnedPathOf, ACircleHasChordsOfTheSagittaAllowed) {
  constexpr double kRadius_mm = 50.0, kTolerance_mm = 0.2;
  std::vector<PathVertex> path;
  for (int i = 0; i <= 20000; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / 20000.0;
    path.push_back(
        PathVertex{glm::vec3(kRadius_mm * std::cos(angle), kRadius_mm * std::sin(angle), 0.0)});
  }
  // A chord over an angle a leaves the circle by r (1 - cos(a / 2)).
  const double chords = std::numbers::pi / std::acos(1.0 - kTolerance_mm / kRadius_mm);
  const double found = static_cast<double>(thinned_path(path, kTolerance_mm).size()) - 1.0;
  EXPECT_GE(found, std::floor(chords));
  EXPECT_LE(found, 1.02 * chords + 1.0);
}

TEST(ThinnedPathOf, AWayThereAndBackKeepsItsTurningPoint) {
  std::vector<PathVertex> path;
  for (int i = 0; i <= 100; ++i) path.push_back(PathVertex{{static_cast<float>(i), 0.0f, 0.0f}});
  for (int i = 99; i >= 0; --i) path.push_back(PathVertex{{static_cast<float>(i), 0.0f, 0.0f}});
  EXPECT_EQ(thinned_path(path, 0.5), (std::vector<std::uint32_t>{0, 100, 200}));
}

TEST(ThinnedPathOf, OneVertexAndOnePlaceStay) {
  const std::vector<PathVertex> one(1);
  EXPECT_EQ(thinned_path(one, 1.0), (std::vector<std::uint32_t>{0}));
  EXPECT_TRUE(path_levels(one).empty());
  EXPECT_TRUE(path_levels({}).empty());
  const std::vector<PathVertex> same(4097);
  EXPECT_EQ(thinned_path(same, 0.0), (std::vector<std::uint32_t>{0, 4096}));
}

}  // namespace
}  // namespace kerf
