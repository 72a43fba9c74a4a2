#include "twin/scene/track_path.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/twin/playback/tracks.h"

namespace kerf {
namespace {

std::vector<PathVertex> whole(TrackPath& path) {
  std::vector<PathVertex> all;
  while (true) {
    const auto chunks = path.next_chunks();
    if (chunks.empty()) break;
    for (const auto& chunk : chunks) {
      EXPECT_EQ(all.empty() ? 0u : all.size() - 1, chunk->index * kPathChunkSegments);
      if (!all.empty()) {
        EXPECT_EQ(all.back().position_mm, chunk->vertices.front().position_mm);
        all.pop_back();
      }
      all.insert(all.end(), chunk->vertices.begin(), chunk->vertices.end());
    }
  }
  EXPECT_TRUE(path.complete());
  return all;
}

TEST(TrackPath, HasAVertexForEachEndOfAMove) {
  MotionList program;
  program.at({0, 0, 5}).tool(1).traverse({10, 0, 5}).feed({10, 0, -1}).dwell(1).feed({20, 0, -1});
  TrackPath path(test::track_of(program.list()));
  const auto vertices = whole(path);
  ASSERT_EQ(vertices.size(), 4u);
  EXPECT_EQ(vertices[1].kind, PathKind::kTraverse);
  EXPECT_EQ(vertices[2].kind, PathKind::kFeed);
  EXPECT_EQ(vertices[3].position_mm, glm::vec3(20, 0, -1));
}

TEST(TrackPath, ChordsOfAnArcStayNearIt) {
  MotionList program;
  const double radius_mm = 30;
  program.at({radius_mm, 0, 0}).feed({radius_mm, 0, 0});
  program.arc({-radius_mm, 0, 4}, {0, 0, 0}, {0, 0, 1}, kPi);
  TrackPath path(test::track_of(program.list()));
  const auto vertices = whole(path);
  ASSERT_GT(vertices.size(), 10u);
  for (std::size_t i = 2; i < vertices.size(); ++i) {
    const glm::vec3 a = vertices[i - 1].position_mm, b = vertices[i].position_mm;
    EXPECT_NEAR(std::hypot(b.x, b.y), radius_mm, 1e-4);
    EXPECT_LT(radius_mm - std::hypot((a.x + b.x) / 2, (a.y + b.y) / 2), 0.021);
    EXPECT_GT(b.z, a.z);
  }
}

TEST(TrackPath, LongOnesComeInChunksThatJoin) {
  MotionList program;
  constexpr std::size_t kMoves = 3 * kPathChunkSegments + 17;
  program.at({0, 0, 0});
  for (std::size_t i = 1; i <= kMoves; ++i) program.feed({0.01 * static_cast<double>(i), 0, 0});
  TrackPath path(test::track_of(program.list()));
  EXPECT_EQ(whole(path).size(), kMoves + 1);
}

TEST(TrackPath, WhatIsPastGrowsWithThePlace) {
  MotionList program;
  program.at({0, 0, 0}).feed({10, 0, 0}).dwell(2).feed({20, 0, 0}).feed({30, 0, 0});
  const auto track = test::track_of(program.list());
  TrackPath path(track);
  EXPECT_EQ(path.past_vertices(track->place_before(2)), 0u) << "none is made yet";
  whole(path);
  EXPECT_EQ(path.past_vertices(track->place_before(0)), 1u);
  EXPECT_EQ(path.past_vertices(track->place_before(1)), 2u);
  EXPECT_EQ(path.past_vertices(track->place_before(2)), 2u) << "a dwell has no vertex";
  EXPECT_EQ(path.past_vertices(track->place_before(3)), 3u);
  EXPECT_EQ(path.past_vertices(track->place_before(track->size())), 4u);
}

TEST(TrackPath, OfAnEmptyProgramIsEmpty) {
  TrackPath path(test::track_of({}));
  EXPECT_TRUE(path.complete());
  EXPECT_TRUE(path.next_chunks().empty());
}

}  // namespace
}  // namespace kerf
