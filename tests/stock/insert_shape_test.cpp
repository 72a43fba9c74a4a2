// Outlines of turning tools: where they lie about the controlled point, angles, sizes, what is
// none.
#include "stock/cutter/insert_shape.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "tests/stock/insert_points.h"

namespace kerf {
namespace {

double radians(double degrees) { return degrees * kPi / 180; }
double cross(const Vec2& a, const Vec2& b) { return a.x * b.y - a.y * b.x; }

/// Points of an outline, arcs in small steps.
std::vector<Vec2> points_of(const InsertPart& part) { return insert_points(part, 400); }

struct Extent {
  Vec2 low{1e300}, high{-1e300};
};

Extent extent_of(const InsertOutline& outline) {
  Extent extent;
  for (const InsertPart& part : outline.parts) {
    for (const Vec2& p : points_of(part)) {
      extent.low = glm::min(extent.low, p);
      extent.high = glm::max(extent.high, p);
    }
  }
  return extent;
}

double area_of(const InsertPart& part) {
  const std::vector<Vec2> points = points_of(part);
  double sum = 0;
  for (std::size_t i = 0; i < points.size(); ++i)
    sum += cross(points[i], points[(i + 1) % points.size()]) / 2;
  return sum;
}

/// Counter-clockwise, turning left all the way, arcs through both of their ends.
void expect_convex(const InsertOutline& outline) {
  for (const InsertPart& part : outline.parts) {
    EXPECT_GT(area_of(part), 0);
    const std::vector<Vec2> points = points_of(part);
    const std::size_t n = points.size();
    for (std::size_t i = 0; i < n; ++i) {
      const Vec2 a = points[i], b = points[(i + 1) % n], c = points[(i + 2) % n];
      EXPECT_GE(cross(b - a, c - b), -1e-9);
      EXPECT_GT(glm::distance(a, b), 1e-9);
    }
    Vec2 at = part.back().end_mm;
    for (const InsertEdge& edge : part) {
      if (edge.center_mm) {
        EXPECT_NEAR(glm::distance(at, *edge.center_mm), glm::distance(edge.end_mm, *edge.center_mm),
                    1e-9);
      }
      at = edge.end_mm;
    }
  }
}

std::optional<InsertEdge> edge_of(const InsertOutline& outline, InsertSide side) {
  for (const InsertEdge& edge : outline.parts[0]) {
    if (edge.side == side) return edge;
  }
  return std::nullopt;
}

TEST(InsertShape, the_nose_lies_where_the_orientation_has_it) {
  // LinuxCNC's table: dx and dz of the nose's centre by orientation.
  constexpr int kDirections[9][2] = {{1, -1}, {1, 1}, {-1, 1}, {-1, -1}, {0, -1},
                                     {1, 0},  {0, 1}, {-1, 0}, {0, 0}};
  for (int orientation = 1; orientation <= 9; ++orientation) {
    const std::optional<InsertOutline> outline =
        nose_insert({0.8, orientation, radians(95), radians(155), 10});
    ASSERT_TRUE(outline) << orientation;
    expect_convex(*outline);
    const std::optional<InsertEdge> nose = edge_of(*outline, InsertSide::kNose);
    ASSERT_TRUE(nose && nose->center_mm);
    EXPECT_NEAR(nose->center_mm->y, 0.8 * kDirections[orientation - 1][0], 1e-12);
    EXPECT_NEAR(nose->center_mm->x, 0.8 * kDirections[orientation - 1][1], 1e-12);
  }
}

TEST(InsertShape, flanks_run_along_the_angles) {
  const InsertOutline outline = *nose_insert({0.4, 2, radians(85), radians(25), 11});
  expect_convex(outline);
  // From the nose outward: the back flank ends outside, the front flank comes in.
  const InsertPart& part = outline.parts[0];
  ASSERT_EQ(part.size(), 4u);
  const Vec2 leave = part[3].end_mm, far_low = part[0].end_mm, far_high = part[1].end_mm,
             enter = part[2].end_mm;
  EXPECT_EQ(part[0].side, InsertSide::kBack);
  EXPECT_EQ(part[2].side, InsertSide::kFront);
  const Vec2 back = far_low - leave, front = far_high - enter;
  // (sin a, cos a) in (X, Z).
  EXPECT_NEAR(back.y, 11 * std::sin(radians(25)), 1e-9);
  EXPECT_NEAR(back.x, 11 * std::cos(radians(25)), 1e-9);
  EXPECT_NEAR(front.y, 11 * std::sin(radians(85)), 1e-9);
  EXPECT_NEAR(front.x, 11 * std::cos(radians(85)), 1e-9);
  // The nose touches both axes through the controlled point.
  EXPECT_NEAR(extent_of(outline).low.x, 0, 1e-4);
  EXPECT_NEAR(extent_of(outline).low.y, 0, 1e-4);
}

TEST(InsertShape, rows_that_have_no_outline) {
  EXPECT_FALSE(nose_insert({0.4, 0, 1, 2, 10}));
  EXPECT_FALSE(nose_insert({0.4, 10, 1, 2, 10}));
  EXPECT_FALSE(nose_insert({-0.1, 2, 1, 2, 10}));
  EXPECT_FALSE(nose_insert({std::nan(""), 2, 1, 2, 10}));
  EXPECT_FALSE(nose_insert({0.4, 2, 0, radians(180), 10}));
  EXPECT_FALSE(nose_insert({0.4, 2, 0, std::nan(""), 10}));
  EXPECT_FALSE(nose_insert({0, 2, 1, 1, 10}));
  EXPECT_FALSE(nose_insert({0, 9, 0, 0, 10}));
  EXPECT_FALSE(nose_insert({0.4, 2, 1, 2, 0}));
  EXPECT_FALSE(nose_insert({200, 2, 1, 2, 200}));  // farther than any tool
  EXPECT_TRUE(nose_insert({0.4, 2, 0, 0, 10}));    // a table without angles: a finger along +z
}

TEST(InsertShape, iso_sizes_are_lengths_of_edges) {
  struct Row {
    char shape;
    int size;
    double circle;
  };
  // As they are ordered.
  for (const Row& row :
       {Row{'C', 12, 12.7},  Row{'C', 9, 9.525}, Row{'C', 6, 6.35},   Row{'C', 16, 15.875},
        Row{'C', 19, 19.05}, Row{'D', 15, 12.7}, Row{'D', 11, 9.525}, Row{'D', 7, 6.35},
        Row{'S', 12, 12.7},  Row{'S', 9, 9.525}, Row{'T', 16, 9.525}, Row{'T', 11, 6.35},
        Row{'T', 22, 12.7},  Row{'T', 9, 5.56},  Row{'V', 16, 9.525}, Row{'V', 11, 6.35},
        Row{'W', 8, 12.7},   Row{'W', 6, 9.525}, Row{'K', 16, 9.525}, Row{'R', 12, 12.7},
        Row{'E', 13, 12.7}}) {
    EXPECT_EQ(iso_circle_mm(row.shape, row.size), row.circle) << row.shape << row.size;
  }
  EXPECT_FALSE(iso_circle_mm('C', 13));
  EXPECT_FALSE(iso_circle_mm('X', 12));
}

TEST(InsertShape, iso_inserts_lie_about_their_circle) {
  for (const IsoShape& shape : iso_shapes()) {
    if (shape.corners == 0) continue;
    for (const bool ahead : {false, true}) {
      const InsertOutline outline = *iso_insert({shape.letter, 12.7, 0.8, 2, radians(85), ahead});
      expect_convex(outline);
      // Straight sides in turn: each a flank or the body, parallel to what the angles say.
      const InsertPart& part = outline.parts[0];
      EXPECT_EQ(part.size(), 2 * static_cast<std::size_t>(shape.corners)) << shape.letter;
      std::vector<Vec2> normals;
      std::vector<double> offsets;
      Vec2 at = part.back().end_mm;
      for (const InsertEdge& edge : part) {
        if (!edge.center_mm) {
          const Vec2 way = glm::normalize(edge.end_mm - at);
          normals.emplace_back(way.y, -way.x);
          offsets.push_back(glm::dot(normals.back(), at));
        }
        at = edge.end_mm;
      }
      if (shape.equal_sides) {
        // A point half a circle from three sides is so from all.
        const Vec2 a = normals[0], b = normals[1];
        const double p = offsets[0] - 6.35, q = offsets[1] - 6.35, d = cross(a, b);
        const Vec2 center((p * b.y - q * a.y) / d, (a.x * q - b.x * p) / d);
        for (std::size_t i = 0; i < normals.size(); ++i)
          EXPECT_NEAR(offsets[i] - glm::dot(normals[i], center), 6.35, 1e-9) << shape.letter;
      }
      // The front flank runs along 85 degrees, the back one the corner's angle from it.
      const std::optional<InsertEdge> nose = edge_of(outline, InsertSide::kNose);
      ASSERT_TRUE(nose && nose->center_mm);
      EXPECT_NEAR(nose->center_mm->x, 0.8, 1e-9);
      EXPECT_NEAR(nose->center_mm->y, 0.8, 1e-9);
      at = part.back().end_mm;
      for (const InsertEdge& edge : part) {
        const bool is_front = edge.side == InsertSide::kFront;
        if (is_front || edge.side == InsertSide::kBack) {
          const double turn = ahead ? shape.nose_rad : -shape.nose_rad;
          const double angle = is_front ? radians(85) : radians(85) + turn;
          const Vec2 way = glm::normalize(edge.end_mm - at);
          EXPECT_NEAR(std::abs(cross(way, {std::cos(angle), std::sin(angle)})), 0, 1e-9)
              << shape.letter;
        }
        at = edge.end_mm;
      }
    }
  }
}

TEST(InsertShape, the_long_side_of_a_parallelogram_is_its_front) {
  for (const bool ahead : {false, true}) {
    const InsertOutline outline = *iso_insert({'K', 9.525, 0, 2, radians(85), ahead});
    Vec2 at = outline.parts[0].back().end_mm;
    for (const InsertEdge& edge : outline.parts[0]) {
      const bool is_front = edge.side == InsertSide::kFront;
      if (is_front || edge.side == InsertSide::kBack) {
        EXPECT_NEAR(glm::distance(at, edge.end_mm),
                    is_front ? 16.15 : 9.525 / std::sin(radians(55)), 1e-9);
      }
      at = edge.end_mm;
    }
  }
}

TEST(InsertShape, a_round_insert_is_a_disc) {
  const InsertOutline outline = *iso_insert({'R', 12, 6, 6, 0});
  const Extent extent = extent_of(outline);
  EXPECT_NEAR(extent.low.y, 0, 1e-4);
  EXPECT_NEAR(extent.high.y, 12, 1e-4);
  EXPECT_NEAR(extent.low.x, -6, 1e-4);
}

TEST(InsertShape, corners_that_do_not_fit) {
  EXPECT_FALSE(iso_insert({'C', 12.7, 7, 2, 1}));
  EXPECT_TRUE(iso_insert({'S', 12.7, 6.35, 2, 1}));  // a disc of four arcs
  EXPECT_FALSE(iso_insert({'C', 12.7, 0.8, 0, 1}));
  EXPECT_FALSE(iso_insert({'Q', 12.7, 0.8, 2, 1}));
  EXPECT_FALSE(iso_insert({'C', 0, 0, 2, 1}));
  EXPECT_FALSE(iso_insert({'C', 1000, 0, 2, 1}));
}

TEST(InsertShape, blades_lie_beside_their_corner) {
  struct Row {
    int orientation;
    bool axial;
    Vec2 low, high;
  };
  for (const Row& row : {Row{2, false, {0, 0}, {3, 15}}, Row{1, false, {-3, 0}, {0, 15}},
                         Row{6, false, {-1.5, 0}, {1.5, 15}}, Row{3, false, {0, -15}, {3, 0}},
                         Row{4, false, {-3, -15}, {0, 0}}, Row{8, false, {-1.5, -15}, {1.5, 0}},
                         Row{5, true, {-15, -1.5}, {0, 1.5}}, Row{7, true, {0, -1.5}, {15, 1.5}},
                         Row{2, true, {0, 0}, {15, 3}}, Row{3, true, {0, -3}, {15, 0}}}) {
    for (const double corner : {0.0, 0.2, 1.5}) {
      GrooveInsert blade;
      blade.corner_mm = corner;
      blade.orientation = row.orientation;
      blade.axial = row.axial;
      const std::optional<InsertOutline> outline = groove_insert(blade);
      ASSERT_TRUE(outline) << row.orientation;
      expect_convex(*outline);
      const Extent extent = extent_of(*outline);
      EXPECT_NEAR(glm::distance(extent.low, row.low), 0, 1e-4) << row.orientation << ' ' << corner;
      EXPECT_NEAR(glm::distance(extent.high, row.high), 0, 1e-4) << row.orientation;
    }
  }
  EXPECT_FALSE(groove_insert({3, 1.6, 15, 2}));
  EXPECT_FALSE(groove_insert({3, 0.2, 15, 9}));
  EXPECT_FALSE(groove_insert({3, 0.2, 15, 5}));                     // neither inward nor outward
  EXPECT_FALSE(groove_insert({3, 0.2, 15, 6, true}));               // neither left nor right
  EXPECT_FALSE(groove_insert({3, 0.2, 15, 2, false, radians(6)}));  // the sides would meet
  expect_convex(*groove_insert({3, 0.2, 15, 2, false, radians(2)}));
}

TEST(InsertShape, threads_have_their_angle) {
  const InsertOutline sharp = *thread_insert({radians(60), 0, 2, 6});
  expect_convex(sharp);
  EXPECT_NEAR(area_of(sharp.parts[0]), 4 * std::tan(radians(30)), 1e-9);
  const InsertOutline flat = *thread_insert({radians(55), 0.25, 2, 8});
  expect_convex(flat);
  EXPECT_NEAR(area_of(flat.parts[0]), 0.5 + 4 * std::tan(radians(27.5)), 1e-9);
  EXPECT_NEAR(extent_of(flat).low.y, -2, 1e-9);
  EXPECT_FALSE(thread_insert({radians(60), 0, 2, 2}));
  EXPECT_FALSE(thread_insert({radians(180), 0, 2, 6}));
  EXPECT_FALSE(thread_insert({radians(60), 0, 0, 6}));
}

TEST(InsertShape, mirrors_keep_sides_and_areas) {
  const InsertOutline outline = *iso_insert({'D', 12.7, 0.4, 2, radians(93)});
  for (const InsertOutline& mirror : {mirrored_in_x(outline), mirrored_in_z(outline)}) {
    expect_convex(mirror);
    EXPECT_NEAR(area_of(mirror.parts[0]), area_of(outline.parts[0]), 1e-9);
    EXPECT_TRUE(edge_of(mirror, InsertSide::kFront));
  }
  EXPECT_NEAR(extent_of(mirrored_in_x(outline)).low.y, -extent_of(outline).high.y, 1e-9);
  EXPECT_NEAR(extent_of(mirrored_in_z(outline)).low.x, -extent_of(outline).high.x, 1e-9);
}

TEST(InsertShape, drills_have_their_point_on_both_sides) {
  const Cutter drill = *Cutter::from_profile("drill", {{ProfilePiece::Kind::kLine, 0, 0, 4, 2.4},
                                                       {ProfilePiece::Kind::kLine, 4, 2.4, 4, 50}});
  const InsertOutline outline = *axial_outline(drill, 80);
  ASSERT_EQ(outline.parts.size(), 1u);
  expect_convex(outline);
  EXPECT_NEAR(area_of(outline.parts[0]), 8 * (80 - 2.4) + 4 * 2.4, 1e-9);
  const Cutter ball =
      *Cutter::from_profile("ball", {{ProfilePiece::Kind::kArc, 0, 0, 3, 3, 0, 3, 3, true}});
  const InsertOutline round = *axial_outline(ball, 20);
  expect_convex(round);
  EXPECT_NEAR(area_of(round.parts[0]), 6 * 17 + kPi * 9 / 2, 1e-4);
  const Cutter hollow =
      *Cutter::from_profile("hollow", {{ProfilePiece::Kind::kLine, 0, 0, 2, 0},
                                       {ProfilePiece::Kind::kArc, 2, 0, 4, 2, 4, 0, 2, false}});
  EXPECT_FALSE(axial_outline(hollow, 20));
  EXPECT_FALSE(axial_outline(drill, 2));  // shorter than its point
}

}  // namespace
}  // namespace kerf
