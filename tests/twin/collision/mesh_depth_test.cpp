// How deep meshes go into each other: figures by hand, and brute force over all points of a grid.
#include "twin/collision/mesh_depth.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <random>

namespace kerf {
namespace {

TriangleMesh box_mesh(const Vec3& low, const Vec3& high) {
  TriangleMesh mesh;
  for (int i = 0; i < 8; ++i) {
    mesh.positions_mm.emplace_back(i & 4 ? high.x : low.x, i & 2 ? high.y : low.y,
                                   i & 1 ? high.z : low.z);
  }
  constexpr std::uint32_t kSides[6][4] = {{0, 1, 3, 2}, {4, 6, 7, 5}, {0, 4, 5, 1},
                                          {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 5, 7, 3}};
  for (const auto& s : kSides) {
    mesh.triangles.push_back({s[0], s[1], s[2]});
    mesh.triangles.push_back({s[0], s[2], s[3]});
  }
  return mesh;
}

struct BoxBody {
  Vec3 low, high;
  SolidPointer solid = Solid::of_mesh(box_mesh(low, high));
  /// From its surface; below 0: outside.
  double depth_at(const Vec3& p) const {
    const Vec3 room = glm::min(p - low, high - p);
    return std::min({room.x, room.y, room.z});
  }
};

Pose shifted(const Vec3& by) {
  Pose pose;
  pose.origin_mm = by;
  return pose;
}

double depth_of(const BoxBody& a, const Pose& pose, const BoxBody& b) {
  return mesh_depth_at_mm(*a.solid, pose, *b.solid);
}

TEST(MeshDepth, CornersInEachOther) {
  const BoxBody a{{0, 0, 0}, {20, 20, 20}}, b{{0, 0, 0}, {30, 30, 30}};
  EXPECT_NEAR(depth_of(a, shifted({-17, -13, -15}), b), 3, 0.05) << "its corner at 3, 7, 5";
  EXPECT_EQ(depth_of(a, shifted({-21, 5, 5}), b), 0) << "apart by 1 mm";
  EXPECT_NEAR(depth_of(a, shifted({29.5, 5, 5}), b), 0.5, 0.05) << "face upon face";
}

/// A tube counts as a closed mesh: 10 to 15 mm from its axis, its end at Z0.
TEST(MeshDepth, TheEndOfATubeInAPlate) {
  const SolidPointer tube = Solid::of_bodies(parse_blank("tube:0,0,0:40:30:20")->bodies);
  EXPECT_TRUE(tube->encloses({12.5, 0, 1}));
  EXPECT_FALSE(tube->encloses({5, 0, 1})) << "in its bore";
  const BoxBody plate{{-50, -50, -10}, {50, 50, 0}};
  EXPECT_NEAR(mesh_depth_at_mm(*tube, shifted({0, 0, -2}), *plate.solid), 2, 0.1);
  // A wall of 5 mm need not be thinner by more than half of that.
  EXPECT_NEAR(mesh_depth_at_mm(*tube, shifted({0, 0, -4}), *plate.solid), 2.5, 0.1);
  EXPECT_EQ(mesh_depth_at_mm(*tube, shifted({0, 0, 0.5}), *plate.solid), 0);
}

TEST(MeshDepth, OneWithinTheOther) {
  const BoxBody small{{-2, -3, -4}, {2, 3, 4}}, large{{-20, -20, -20}, {20, 20, 20}};
  EXPECT_NEAR(depth_of(small, Pose{}, large), 18, 0.05) << "the middle of its face at X2";
  EXPECT_NEAR(depth_of(small, shifted({10, 0, 0}), large), 12, 0.05);
}

TEST(MeshDepth, BarsThatCrossHaveNoCornerInEachOther) {
  const BoxBody a{{-40, -3, -3}, {40, 3, 3}}, b{{-5, -40, -5}, {5, 40, 5}};
  EXPECT_NEAR(depth_of(a, Pose{}, b), 3, 0.05) << "half of the thin one";
}

TEST(MeshDepth, NothingOfAMeshWithAHole) {
  TriangleMesh open = box_mesh({0, 0, 0}, {9, 9, 9});
  open.triangles.pop_back();
  const BoxBody whole{{0, 0, 0}, {9, 9, 9}};
  EXPECT_EQ(mesh_depth_at_mm(*Solid::of_mesh(open), shifted({5, 5, 5}), *whole.solid), 0);
}

/// Of all points of a fine grid in both: the greatest depth in each, of which the lesser counts.
double brute_depth(const BoxBody& a, const Pose& pose, const BoxBody& b) {
  const Pose a_from_b = pose.inverse();
  double in_a = 0, in_b = 0;
  constexpr int kSteps = 60;
  for (int i = 0; i <= kSteps; ++i) {
    for (int k = 0; k <= kSteps; ++k) {
      for (int l = 0; l <= kSteps; ++l) {
        const Vec3 p = b.low + Vec3(i, k, l) / double{kSteps} * (b.high - b.low);
        const double of_a = a.depth_at(a_from_b.point(p));
        if (of_a <= 0) continue;
        in_a = std::max(in_a, of_a);
        in_b = std::max(in_b, b.depth_at(p));
      }
    }
  }
  return std::min(in_a, in_b);
}

TEST(MeshDepth, AsBruteForceHasIt) {
  std::mt19937 random(20);
  std::uniform_real_distribution<double> draw(-1, 1);
  int touching = 0;
  for (int i = 0; i < 60; ++i) {
    const BoxBody a{{-10, -8, -12}, {10, 8, 12}}, b{{-9, -14, -11}, {9, 14, 11}};
    Pose pose =
        turn(glm::normalize(Vec3{draw(random), draw(random), draw(random)}), 180 * draw(random));
    // They meet by an edge or a corner, and neither swallows the middle of the other.
    pose.origin_mm = 19.0 * glm::normalize(Vec3{draw(random), draw(random), draw(random)});
    const double told = depth_of(a, pose, b), brute = brute_depth(a, pose, b);
    if (brute > 0.5) ++touching;
    // The grid is 0.3 to 0.5 mm; in the inside of both nothing is deeper here than on a surface.
    EXPECT_NEAR(told, brute, 0.45) << "seed 20, " << i;
  }
  EXPECT_GT(touching, 30);
}

struct StraightWay final : RigidWay {
  StraightWay(const Vec3& from, const Vec3& to) : from_mm(from), to_mm(to) {}
  Pose pose(double t) const override { return shifted(from_mm + t * (to_mm - from_mm)); }
  double slack_mm(double, double, double) const override { return 0; }
  double turning_mm(double, double, double) const override { return 0; }
  double travel_mm(double from, double to, double) const override {
    return (to - from) * glm::length(to_mm - from_mm);
  }
  Vec3 from_mm, to_mm;
};

TEST(MeshDepth, TheDeepestOfAWay) {
  const BoxBody a{{0, 0, 0}, {20, 20, 20}}, b{{0, 0, 0}, {30, 30, 30}};
  const auto along = [&](const Vec3& from, const Vec3& to, double known) {
    return mesh_depth_mm(*a.solid, StraightWay(from, to), *b.solid, known);
  };
  EXPECT_NEAR(along({5, 5, 40}, {5, 5, 28}, 0), 2, 0.05) << "at its end";
  EXPECT_NEAR(along({-40, 5, 27}, {60, 5, 27}, 0), 3, 0.06) << "on its way through";
  EXPECT_EQ(along({5, 5, 40}, {5, 5, 28}, 2.5), 2.5) << "known to be deeper";
  EXPECT_EQ(along({5, 5, 40}, {5, 5, 31}, 0), 0);
}

}  // namespace
}  // namespace kerf
