// Octree::solid_at(): material at points beside edges, where planes meet within a cell.
#include <functional>
#include <random>

#include "tests/stock/octree/octree_samples.h"

namespace kerf::test {
namespace {

constexpr double kCell_mm = 0.5, kWithin_mm = kCell_mm / 40;

/// Asks about points anywhere in `where` that are farther than `margin_mm` from the surface
/// (`depth` is positive in the material, at least as far from 0 as the surface is away).
/// Returns how many of them come out wrong.
int wrong_points(const Octree& tree, const Box& where, double margin_mm,
                 const std::function<double(const Vec3&)>& depth) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> part(0, 1);
  int wrong = 0;
  for (int n = 0; n < 20000; ++n) {
    const Vec3 at = where.min + where.size() * Vec3{part(random), part(random), part(random)};
    const double in = depth(at);
    if (std::abs(in) < margin_mm) continue;
    wrong += tree.solid_at(at, kWithin_mm) != (in > 0);
  }
  return wrong;
}

class SolidPoint : public testing::Test {
 protected:
  SolidPoint() : tree_(make_octree("box:0,0,-20:50,30,0", kCell_mm)) {}
  /// Walls at y = 10.13 and 20.13, the floor at `floor_mm`; out of both sides of the block.
  void cut_slot(double floor_mm) {
    cut(*tree_, make_cutter("flat:10"), {line({-20, 15.13, floor_mm}, {70, 15.13, floor_mm})});
    floor_mm_ = floor_mm;
  }
  double depth_in_slotted(const Vec3& p) const {
    const double in_block = std::min({p.x, 50 - p.x, p.y, 30 - p.y, -p.z, p.z + 20});
    const double in_slot = std::min({p.y - 10.13, 20.13 - p.y, p.z - floor_mm_});
    return std::min(in_block, -in_slot);
  }
  std::unique_ptr<Octree> tree_;
  double floor_mm_ = 0;
};

TEST_F(SolidPoint, TheFootOfAWallIsMaterialUpToBoth) {
  for (const double floor_mm : {-1.0, -1.07, -1.2, -1.35}) {
    cut_slot(floor_mm);
    const Vec3 foot(25, 20.13, floor_mm);
    EXPECT_EQ(wrong_points(*tree_, {foot - Vec3(1), foot + Vec3(1)}, 1.1 * kWithin_mm,
                           [this](const Vec3& p) { return depth_in_slotted(p); }),
              0)
        << floor_mm;
  }
}

TEST_F(SolidPoint, TheRimOfABlockIsMaterialWithinBoth) {
  const Vec3 corner(50, 30, 0);
  EXPECT_EQ(wrong_points(*tree_, {corner - Vec3(1), corner + Vec3(1)}, 1.1 * kWithin_mm,
                         [this](const Vec3& p) { return depth_in_slotted(p); }),
            0);
}

TEST_F(SolidPoint, WhereASlotComesOutOfASideThreePlanesMeet) {
  for (const double floor_mm : {-1.07, -1.2, -1.35}) {
    cut_slot(floor_mm);
    const Vec3 end(50, 20.13, floor_mm);
    EXPECT_EQ(wrong_points(*tree_, {end - Vec3(1), end + Vec3(1)}, 1.1 * kWithin_mm,
                           [this](const Vec3& p) { return depth_in_slotted(p); }),
              0)
        << floor_mm;
  }
}

/// Of a groove of 5 mm radius the tangents of a cell are cell^2 / 8r = 0.006 mm off.
TEST_F(SolidPoint, AGrooveIsHollow) {
  cut(*tree_, make_cutter("ball:10"), {line({-20, 15.13, -2.1}, {70, 15.13, -2.1})});
  const auto depth = [](const Vec3& p) {
    return std::min(-p.z, std::hypot(p.y - 15.13, p.z - 2.9) - 5);
  };
  EXPECT_EQ(
      wrong_points(*tree_, {Vec3(20, 9, -3), Vec3(25, 21, -0.5)}, 1.1 * kWithin_mm + 0.007, depth),
      0);
}

}  // namespace
}  // namespace kerf::test
