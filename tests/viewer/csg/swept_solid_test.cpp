#include "viewer/csg/swept_solid.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <random>

#include "tests/viewer/csg/test_outlines.h"

namespace kerf {
namespace {

constexpr double kTop_mm = 0.0;
constexpr double kSolidTop_mm = 2.0;
constexpr double kTolerance_mm = 0.01;

std::vector<ConvexProfile> pieces_of(const Outline& outline) {
  Result<std::vector<ConvexProfile>> pieces = convex_pieces(outline);
  EXPECT_TRUE(pieces) << pieces.error();
  return pieces ? *pieces : std::vector<ConvexProfile>{};
}

SolidMesh solid_of(const Outline& outline, const Vec3& from, const Vec3& to,
                   double tolerance = kTolerance_mm) {
  SweepBuilder builder(tolerance, kTop_mm, kSolidTop_mm);
  return builder.build(pieces_of(outline).at(0), from, to, 0xff123456);
}

Vec3 corner(const SolidMesh& mesh, std::size_t index) {
  return Vec3(mesh.vertices[mesh.indices[index]].position_mm);
}

double volume_mm3(const SolidMesh& mesh) {
  double sum = 0.0;
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    sum += glm::dot(corner(mesh, i), glm::cross(corner(mesh, i + 1), corner(mesh, i + 2))) / 6.0;
  }
  return sum;
}

/// Edges, by the positions of their ends, that are not walked once in each direction.
std::size_t open_edges(const SolidMesh& mesh) {
  std::map<std::array<double, 6>, int> balance;
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 a = corner(mesh, i + k), b = corner(mesh, i + (k + 1) % 3);
      ++balance[{a.x, a.y, a.z, b.x, b.y, b.z}];
      --balance[{b.x, b.y, b.z, a.x, a.y, a.z}];
    }
  }
  std::size_t count = 0;
  for (const auto& [edge, sum] : balance) count += sum != 0 ? 1 : 0;
  return count;
}

/// How far the farthest corner lies outside of the plane of any face.
double worst_dent_mm(const SolidMesh& mesh) {
  double worst = 0.0;
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    const Vec3 area =
        glm::cross(corner(mesh, i + 1) - corner(mesh, i), corner(mesh, i + 2) - corner(mesh, i));
    const double longest = std::max({glm::distance(corner(mesh, i), corner(mesh, i + 1)),
                                     glm::distance(corner(mesh, i + 1), corner(mesh, i + 2)),
                                     glm::distance(corner(mesh, i + 2), corner(mesh, i))});
    if (glm::length(area) < 0.02 * longest) continue;  // too thin to have a direction in float
    const Vec3 normal = glm::normalize(area);
    for (const SolidVertex& v : mesh.vertices) {
      worst = std::max(worst, glm::dot(normal, Vec3(v.position_mm) - corner(mesh, i)));
    }
  }
  return worst;
}

TEST(ConvexPieces, CommonCuttersAreOnePiece) {
  EXPECT_EQ(pieces_of(flat_outline(5, 20)), (std::vector<ConvexProfile>{{Vec2(5, 0)}}));
  EXPECT_EQ(pieces_of(vee_outline(4, 45, 20)).size(), 1u);
  EXPECT_EQ(pieces_of(bull_outline(5, 1, 20)).size(), 1u);
  EXPECT_EQ(pieces_of(bull_outline(4, 4, 20)).size(), 1u);
}

TEST(ConvexPieces, UndercutsCutFromAboveLikeTheirWidestPart) {
  const std::vector<ConvexProfile> pieces = pieces_of(lollipop_outline(4, 1.5, 20));
  ASSERT_EQ(pieces.size(), 1u);
  EXPECT_NEAR(pieces[0].back().x, 4.0, 0.01);
  EXPECT_NEAR(pieces[0].back().y, 4.0, 0.2);  // the equator; nothing of the upper half
}

TEST(ConvexPieces, EveryConcaveCornerBeginsAPieceThatIsFlatInside) {
  const std::vector<ConvexProfile> expected = {{Vec2(3, 0)}, {Vec2(5, 5)}, {Vec2(7, 10)}};
  EXPECT_EQ(pieces_of(stepped_outline(3, 2, 3)), expected);
  // A cone, a flatter cone above it, and a wider disc above an undercut.
  const Outline outline{{0, 0}, {2, 4}, {6, 6}, {3, 8}, {9, 14}, {9, 20}};
  const std::vector<ConvexProfile> mixed = {
      {Vec2(0, 0), Vec2(2, 4)}, {Vec2(2, 4), Vec2(6, 6)}, {Vec2(6, 11), Vec2(9, 14)}};
  EXPECT_EQ(pieces_of(outline), mixed);
}

TEST(ConvexPieces, SimplifyingKeepsTheEndsAndTheTolerance) {
  const ConvexProfile fine = pieces_of(bull_outline(4, 4, 20, 1.0)).at(0);
  const ConvexProfile coarse = simplified(fine, 0.02);
  EXPECT_LT(coarse.size(), fine.size() / 5);
  EXPECT_EQ(coarse.front(), fine.front());
  EXPECT_EQ(coarse.back(), fine.back());
  for (std::size_t i = 0; i + 1 < coarse.size(); ++i) {
    const Vec2 middle = 0.5 * (coarse[i] + coarse[i + 1]);
    const double depth = 4.0 - glm::distance(middle, Vec2(0, 4));
    EXPECT_GE(depth, 0.0);
    EXPECT_LE(depth, 0.021);
  }
  EXPECT_EQ(simplified(pieces_of(vee_outline(4, 45, 20)).at(0), 0.5),
            pieces_of(vee_outline(4, 45, 20)).at(0));
}

TEST(ConvexPieces, RefusesWhatIsNoOutline) {
  EXPECT_EQ(convex_pieces(Outline{{1, 0}}).error(),
            "the outline of the cutter has 1 points; it needs at least two");
  EXPECT_EQ(convex_pieces(Outline{{0, 0}, {5, 2}, {6, 1}}).error(),
            "the outline of the cutter falls from 2 mm to 1 mm at point 3; heights must not fall");
  EXPECT_EQ(convex_pieces(Outline{{0, 0}, {-5, 2}}).error(),
            "point 2 of the outline of the cutter has radius -5 mm and height 2 mm; both must be "
            "finite, the radius not negative");
  EXPECT_TRUE(pieces_of(Outline{{0, 0}, {0, 5}}).empty());
}

TEST(SweptSolid, IsClosedConvexAndNowhereOutsideOfTheTrueSweep) {
  std::mt19937 random(7);
  const auto between = [&random](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  const Outline outlines[] = {flat_outline(5, 20), bull_outline(4, 4, 20), bull_outline(6, 1.5, 20),
                              vee_outline(5, 30, 20)};
  for (int i = 0; i < 200; ++i) {
    SCOPED_TRACE("solid " + std::to_string(i));
    const Vec3 from(between(-20, 20), between(-20, 20), between(-9, -0.5));
    Vec3 to(between(-20, 20), between(-20, 20), between(-9, -0.5));
    if (i % 5 == 1) to = {from.x, from.y, to.z};  // plunge or retract
    if (i % 5 == 2) to.z = from.z;
    if (i % 5 == 3) to = {to.x, from.y, from.z};  // along an axis
    if (i % 50 == 4) to = from;
    const SolidMesh mesh = solid_of(outlines[i % 4], from, to);
    ASSERT_FALSE(mesh.indices.empty());
    EXPECT_EQ(open_edges(mesh), 0u);
    EXPECT_LT(worst_dent_mm(mesh), 2e-3);
    EXPECT_GT(volume_mm3(mesh), 0.0);
    const double reach = outlines[i % 4].back().radius_mm + 1e-5;
    EXPECT_GE(mesh.bounds_mm.min.x, std::min(from.x, to.x) - reach);
    EXPECT_LE(mesh.bounds_mm.max.y, std::max(from.y, to.y) + reach);
    EXPECT_NEAR(mesh.bounds_mm.min.z, std::min(from.z, to.z), 1e-5);
  }
}

TEST(SweptSolid, HasTheVolumeOfTheClosedForm) {
  constexpr double kFine_mm = 1e-3;
  // Slot of length 30: capsule from -4 up to the top of the solid.
  const double capsule = 30.0 * 10.0 + kPi * 25.0;
  EXPECT_NEAR(volume_mm3(solid_of(flat_outline(5, 20), {-15, 0, -4}, {15, 0, -4}, kFine_mm)),
              capsule * 6.0, 0.5);
  const SolidMesh plunge = solid_of(flat_outline(5, 20), {3, 2, -1}, {3, 2, -9}, kFine_mm);
  EXPECT_NEAR(volume_mm3(plunge), kPi * 25.0 * 11.0, 0.5);
  // Cone of 45 degrees, 3 deep, and the wall above it.
  EXPECT_NEAR(volume_mm3(solid_of(vee_outline(5, 45, 20), {0, 0, -3}, {0, 0, -3}, kFine_mm)),
              kPi * 9.0 * (1.0 + 2.0), 0.05);
}

TEST(SweptSolid, LeavesOutWhatHappensAboveTheMaterial) {
  EXPECT_TRUE(solid_of(flat_outline(5, 20), {0, 0, 0}, {10, 0, 0}).indices.empty());
  EXPECT_TRUE(solid_of(bull_outline(4, 4, 20), {0, 0, 5}, {10, 0, 1}).indices.empty());
  // A ramp that dips in for its last half.
  const SolidMesh dip = solid_of(flat_outline(5, 20), {0, 0, 4}, {40, 0, -4});
  EXPECT_NEAR(dip.bounds_mm.min.x, 15.0, kTolerance_mm);
  EXPECT_NEAR(dip.bounds_mm.max.z, kSolidTop_mm, 1e-6);
  // A ball 1 mm deep is sqrt(2 * 4 * 1 - 1) wide at the top.
  const SolidMesh shallow = solid_of(bull_outline(4, 4, 20), {0, 0, -1}, {10, 0, -1});
  EXPECT_NEAR(shallow.bounds_mm.max.y, std::sqrt(7.0), 0.01);
}

TEST(SweptSolid, WallsOfASlotAreExactInEveryDirection) {
  for (int deg = 0; deg < 360; deg += 7) {
    const Vec2 along(std::cos(deg * kPi / 180), std::sin(deg * kPi / 180));
    const SolidMesh mesh = solid_of(flat_outline(5, 20), {0, 0, -1}, Vec3(20.0 * along, -1), 0.5);
    double widest = 0.0;
    for (const SolidVertex& v : mesh.vertices) {
      const Vec2 p(v.position_mm.x, v.position_mm.y);
      widest = std::max(widest, std::abs(p.x * along.y - p.y * along.x));
    }
    EXPECT_NEAR(widest, 5.0, 1e-5) << deg;
  }
}

TEST(Chords, StayWithinTheToleranceAndMeetTheEnds) {
  SweptArc arc{{10, 0, 0}, {0, 10, -3}, {0, 0, 0}, {0, 0, 1}, 1, 3};
  for (const double tolerance : {0.2, 0.01}) {
    const std::vector<SweptMove> moves = chords(arc, tolerance);
    ASSERT_GE(moves.size(), 10u);
    EXPECT_EQ(moves.front().from_mm, arc.from_mm);
    EXPECT_EQ(moves.back().to_mm, arc.to_mm);
    double turned_rad = 0.0;
    for (std::size_t i = 0; i < moves.size(); ++i) {
      const SweptMove& m = moves[i];
      EXPECT_EQ(m.tool, 3u);
      if (i > 0) {
        EXPECT_EQ(m.from_mm, moves[i - 1].to_mm);
      }
      EXPECT_NEAR(glm::length(Vec2(m.to_mm)), 10.0, 1e-9);
      EXPECT_GE(glm::length(0.5 * Vec2(m.from_mm + m.to_mm)), 10.0 - 1.0001 * tolerance);
      const double across = m.from_mm.x * m.to_mm.y - m.from_mm.y * m.to_mm.x;
      turned_rad += std::atan2(across, glm::dot(Vec2(m.from_mm), Vec2(m.to_mm)));
    }
    EXPECT_NEAR(turned_rad, 2.5 * kPi, 1e-9);
  }
}

TEST(Chords, FullCirclesSpiralsAndOtherPlanes) {
  double length = 0.0;
  for (const SweptMove& m : chords({{5, 0, 0}, {5, 0, 0}, {0, 0, 0}}, 1e-4)) {
    length += glm::distance(m.from_mm, m.to_mm);
  }
  EXPECT_NEAR(length, 10.0 * kPi, 0.01);
  // G18: around +Y, from +X towards -Z.
  const std::vector<SweptMove> moves = chords({{5, 1, 0}, {0, 2, -5}, {0, 0, 0}, {0, 1, 0}}, 0.01);
  const Vec3 middle = moves[moves.size() / 2].from_mm;
  EXPECT_NEAR(std::hypot(middle.x, middle.z), 5.0, 1e-9);
  EXPECT_GT(middle.x, 0.0);
  EXPECT_LT(middle.z, 0.0);
  // The radius grows evenly.
  const std::vector<SweptMove> spiral = chords({{2, 0, 0}, {-6, 0, 0}, {0, 0, 0}}, 0.01);
  const double share = 0.5;
  const Vec3 half = spiral[spiral.size() / 2].from_mm;
  EXPECT_NEAR(glm::length(half), 2.0 + share * 4.0, 4.0 / static_cast<double>(spiral.size()));
}

}  // namespace
}  // namespace kerf
