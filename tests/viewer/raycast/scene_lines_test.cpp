#include "viewer/raycast/scene_lines.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <random>

namespace kerf {
namespace {

constexpr int kSide_px = 40;

/// A sheet of paper: x and y of the scene are pixels from the lower left, z 0 .. 1 from far to
/// near.
class SceneLinesTest : public testing::Test {
 protected:
  SceneLinesTest() {
    projection_.size_px = {kSide_px, kSide_px};
    projection_.clip_from_world = glm::mat4(0.0f);
    projection_.clip_from_world[0][0] = projection_.clip_from_world[1][1] = 2.0f / kSide_px;
    projection_.clip_from_world[2][2] = -2.0f;
    projection_.clip_from_world[3] = {-1.0f, -1.0f, 1.0f, 1.0f};
    clear();
  }
  void clear() {
    picture_ = {kSide_px, kSide_px, std::vector<std::uint8_t>(3 * kSide_px * kSide_px, 255)};
    depths_.assign(kSide_px * kSide_px, 1.0f);
  }
  /// A path of feeds that are past.
  static SceneLines path(const std::vector<glm::vec3>& points) {
    auto chunk = std::make_shared<PathChunk>();
    for (const glm::vec3& point : points)
      chunk->vertices.push_back(PathVertex{point, PathKind::kFeed});
    SceneLines lines;
    lines.add(std::move(chunk));
    return lines;
  }
  void draw(const SceneLines& lines, std::uint64_t past = 1000) {
    lines.draw(projection_, {}, past, &picture_, &depths_);
  }
  int red(int x, int y) const {
    return picture_.rgb[static_cast<std::size_t>(3 * (y * kSide_px + x))];
  }
  bool is_marked(int x, int y) const { return red(x, y) < 255; }

  Projection projection_;
  Picture picture_;
  std::vector<float> depths_;
};

TEST_F(SceneLinesTest, ALineThroughTheMiddlesOfPixelsIsOnePixelWide) {
  draw(path({{5, 10.5, 0.5}, {15, 10.5, 0.5}}));
  for (int y = 0; y < kSide_px; ++y) {
    for (int x = 0; x < kSide_px; ++x) {
      const bool is_on = y == kSide_px - 11 && x >= 5 && x < 15;
      ASSERT_EQ(red(x, y), is_on ? std::lround(255 * 0.10) : 255) << x << ' ' << y;
      ASSERT_FLOAT_EQ(depths_[static_cast<std::size_t>(y * kSide_px + x)], is_on ? 0.5f : 1.0f);
    }
  }
}

TEST_F(SceneLinesTest, AWiderLineHasMoreRows) {
  projection_.line_px = 3.0f;
  draw(path({{5, 10.5, 0.5}, {15, 10.5, 0.5}}));
  for (int y = 0; y < kSide_px; ++y) {
    const bool is_on = std::abs(y - (kSide_px - 11)) <= 1;
    ASSERT_EQ(red(8, y), is_on ? std::lround(255 * 0.10) : 255) << y;
  }
}

TEST_F(SceneLinesTest, BetweenTwoRowsItIsHalfInBoth) {
  draw(path({{5, 10, 0.5}, {15, 10, 0.5}}));
  const double half = 0.5 * 255 + 0.5 * 255 * 0.10;
  EXPECT_NEAR(red(8, kSide_px - 10), half, 1);
  EXPECT_NEAR(red(8, kSide_px - 11), half, 1);
  EXPECT_FALSE(is_marked(8, kSide_px - 12));
}

/// By the definition: what is nearer than a pixel to the segment, the less the farther.
TEST_F(SceneLinesTest, CoversWhatLiesBesideTheSegment) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> place(-20, 60);
  for (int i = 0; i < 200; ++i) {
    clear();
    const glm::vec2 a{place(random), place(random)}, b(place(random), place(random));
    draw(path({glm::vec3(a, 0.5), glm::vec3(b, 0.5)}));
    const glm::vec2 way = (b - a) / glm::length(b - a);
    for (int y = 0; y < kSide_px; ++y) {
      for (int x = 0; x < kSide_px; ++x) {
        const glm::vec2 at(static_cast<float>(x) + 0.5f, static_cast<float>(kSide_px - y) - 0.5f);
        const float along = glm::dot(at - a, way), length = glm::length(b - a);
        const float aside = std::abs(way.x * (at - a).y - way.y * (at - a).x);
        const float past = along - std::clamp(along, 0.0f, length);
        if (std::hypot(past, aside) > 2) {
          ASSERT_FALSE(is_marked(x, y)) << i << ": " << x << ' ' << y;
        } else if (along > 2 && along < length - 2) {  // round the ends it is not that exact
          const float cover = std::max(0.0f, 1 - aside);
          ASSERT_NEAR(red(x, y), 255 * (1 - cover * 0.9f), 2) << i << ": " << x << ' ' << y;
        }
      }
    }
  }
}

TEST_F(SceneLinesTest, WhatIsBeforeALineHidesIt) {
  for (int x = 0; x < 20; ++x) depths_[29 * kSide_px + static_cast<std::size_t>(x)] = 0.3f;
  draw(path({{5, 10.5, 0.5}, {35, 10.5, 0.5}}));
  EXPECT_FALSE(is_marked(10, 29));
  EXPECT_TRUE(is_marked(30, 29));
  // Through the depth of that: from 0.1 before it to 0.9 behind.
  draw(path({{5, 10.5, 0.9}, {35, 10.5, 0.1}}));
  EXPECT_TRUE(is_marked(10, 29));
  EXPECT_FALSE(is_marked(19, 29));
}

TEST_F(SceneLinesTest, ShortSegmentsAreDrawnAsLongOnes) {
  std::vector<glm::vec3> points;
  for (int i = 0; i <= 3000; ++i) points.emplace_back(5.0 + 0.01 * i, 10.5, 0.5);
  draw(path(points), 4000);
  // Two lines that share a pixel cover three quarters of it at least.
  for (int x = 5; x < 35; ++x) EXPECT_LT(red(x, 29), 255 * (1 - 0.75 * 0.9) + 1) << x;
}

TEST_F(SceneLinesTest, WhatIsAheadIsPale) {
  draw(path({{5, 10.5, 0.5}, {15, 10.5, 0.5}, {25, 10.5, 0.5}}), 2);
  EXPECT_NEAR(red(8, 29), 255 * 0.10, 1);
  EXPECT_NEAR(red(20, 29), 255 * (0.55 * 0.88 + 0.45 * 0.10), 1);
  clear();
  SceneLines hidden = path({{5, 10.5, 0.5}, {15, 10.5, 0.5}});
  hidden.show_path({true, false, true});
  draw(hidden);
  EXPECT_FALSE(is_marked(8, 29));
}

TEST_F(SceneLinesTest, WhatIsBehindTheEyeIsCutOff) {
  // w = y: the eye at y = 0.
  projection_.clip_from_world = glm::mat4(0.0f);
  projection_.clip_from_world[0][0] = 1.0f;
  projection_.clip_from_world[1][3] = 1.0f;
  draw(path({{-1, -5, 0}, {-2, -9, 0}}));
  for (int y = 0; y < kSide_px; ++y)
    for (int x = 0; x < kSide_px; ++x) ASSERT_FALSE(is_marked(x, y));
  draw(path({{0.5, -10, 0}, {0.5, 1, 0}}));
  EXPECT_TRUE(is_marked(35, 20)) << "from x = 0.5 / 1 to the right";
  EXPECT_FALSE(is_marked(25, 20));
}

TEST_F(SceneLinesTest, OutlineAndFrames) {
  SceneSetup setup;
  setup.bounds_mm = {Vec3(0, 0, 0), Vec3(100, 0, 0)};
  setup.blank_outline = {{{5, 30.5, 0.5}, {15, 30.5, 0.5}}};
  SceneFrame frame;
  frame.origin_mm = {5, 10.5, 0.5};
  setup.frames = {frame};
  SceneLines lines;
  lines.set_setup(setup);
  draw(lines);
  EXPECT_TRUE(is_marked(8, kSide_px - 31));
  EXPECT_TRUE(is_marked(20, 29)) << "an arrow of 22 mm";
  EXPECT_FALSE(is_marked(30, 29));
  EXPECT_NEAR(red(20, 29), 214, 1) << "X is red";
}

TEST_F(SceneLinesTest, MarksOfFindingsAreRoundAndSeenThroughEverything) {
  SceneFinding finding;
  finding.severity = Severity::kError;
  finding.position_mm = Vec3(20, 20, 0.2);
  const std::array<SceneFinding, 2> findings{finding, SceneFinding{}};
  SceneLines lines;
  lines.set_findings(findings);
  depths_.assign(depths_.size(), 0.1f);
  draw(lines);
  double area_px = 0;
  for (int y = 0; y < kSide_px; ++y) {
    for (int x = 0; x < kSide_px; ++x) {
      const double from_middle = std::hypot(x + 0.5 - 20, y + 0.5 - 20);
      EXPECT_EQ(is_marked(x, y), from_middle < 5.9) << x << ' ' << y;
      if (from_middle < 3) {
        EXPECT_EQ(red(x, y), 222);
      }
      if (from_middle > 4.1 && from_middle < 4.9) {
        EXPECT_NEAR(red(x, y), 0.45 * 222, 1) << "the rim";
      }
      area_px += is_marked(x, y) ? 1 : 0;
    }
  }
  EXPECT_GT(area_px, 80);
  EXPECT_EQ(depths_, std::vector<float>(depths_.size(), 0.1f));
  clear();
  lines.set_findings({});
  draw(lines);
  EXPECT_FALSE(is_marked(20, 20));
}

}  // namespace
}  // namespace kerf
