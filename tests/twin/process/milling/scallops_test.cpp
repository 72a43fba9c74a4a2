// Crests between passes, against closed forms.
#include "twin/process/milling/scallops.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "stock/cutter/shape_spec.h"
#include "stock/zmap/zmap.h"

namespace kerf {
namespace {

/// A block 30 x 30 x 20 mm with its top at Z0, in cells of 0.1 mm.
class ScallopsTest : public testing::Test {
 protected:
  ScallopsTest() {
    ZMapOptions options;
    options.blank = parse_blank("box:0,0,-20:30,30,0").value();
    options.cell_mm = 0.1;
    stock_ = std::move(ZMap::create(options).value());
    stock_->keep_cut_ids(true);
  }
  void cut(const std::string& shape, const Vec3& from, const Vec3& to) {
    const Cutter cutter = parse_shape(shape).value();
    CutMove move;
    move.from_mm = from, move.to_mm = to, move.id = next_id_++;
    ways_.mount(cutter, 3);
    ways_.add(move);
    std::vector<CutReport> reports;
    stock_->cut(cutter, {&move, 1}, reports);
    stock_->finish(reports);
  }
  std::vector<ScallopsOfTool> scan() {
    const std::optional<HeightGrid> heights = stock_->present_heights();
    return ScallopScan(*heights, *stock_, ways_).run();
  }
  /// Passes of that direction, `ae` apart along a slope that rises across them.
  void plane(const std::string& shape, double turned_rad, double ae, double slope_rad) {
    const Vec2 way(std::cos(turned_rad), std::sin(turned_rad)), side(-way.y, way.x);
    for (int k = -40; k <= 40; ++k) {
      const Vec2 middle = Vec2(15, 15) + ae * k * std::cos(slope_rad) * side;
      const double z = -6 + ae * k * std::sin(slope_rad);
      cut(shape, Vec3(middle - 40.0 * way, z), Vec3(middle + 40.0 * way, z));
    }
  }

  std::unique_ptr<ZMap> stock_;
  PastWays ways_;
  std::uint64_t next_id_ = 0;
};

double crest_mm(double radius, double ae) {
  return radius - std::sqrt(radius * radius - ae * ae / 4);
}

TEST_F(ScallopsTest, ABallLeavesTheClosedForm) {
  for (const double turned_deg : {0.0, 90.0, 30.0, 63.0}) {
    plane("ball:8", turned_deg * kPi / 180, 1.0, 0);
    const std::vector<ScallopsOfTool> found = scan();
    ASSERT_EQ(found.size(), 1u) << turned_deg;
    EXPECT_EQ(found[0].tool, 3);
    EXPECT_EQ(found[0].shape, "ball:8");
    const double expected = crest_mm(4, 1.0);  // 0.0314 mm
    EXPECT_NEAR(found[0].crests.p95_mm, expected, 0.03 * expected) << turned_deg;
    EXPECT_NEAR(found[0].crests.most_mm, expected, 0.05 * expected) << turned_deg;
    stock_ = nullptr;
    ZMapOptions options;
    options.blank = parse_blank("box:0,0,-20:30,30,0").value();
    options.cell_mm = 0.1;
    stock_ = std::move(ZMap::create(options).value());
    stock_->keep_cut_ids(true);
    ways_.clear();
    next_id_ = 0;
  }
}

TEST_F(ScallopsTest, SquareToTheSlope) {
  plane("ball:8", 0, 1.2, 30 * kPi / 180);
  const std::vector<ScallopsOfTool> found = scan();
  ASSERT_EQ(found.size(), 1u);
  EXPECT_NEAR(found[0].crests.p95_mm, crest_mm(4, 1.2), 0.04 * crest_mm(4, 1.2));
}

TEST_F(ScallopsTest, AWiderStepSomewhereIsTheMost) {
  for (int k = 0; k < 20; ++k) {
    const double y = 2 + k + (k >= 10 ? 0.8 : 0.0);
    cut("ball:6", {-5, y, -3}, {35, y, -3});
  }
  const std::vector<ScallopsOfTool> found = scan();
  ASSERT_EQ(found.size(), 1u);
  EXPECT_GT(found[0].crests.most_mm, 1.5 * crest_mm(3, 1.0));
  EXPECT_LT(found[0].crests.most_mm, crest_mm(3, 1.8));
}

TEST_F(ScallopsTest, NoCrestsAreNone) {
  // A flat tool, a single pass of a ball, passes of a bull nose whose flat bottoms overlap.
  plane("flat:8", 0, 4, 0);
  EXPECT_TRUE(scan().empty());
  cut("ball:8", {-5, 15, -8}, {35, 15, -8});
  EXPECT_TRUE(scan().empty());
  for (const double y : {5.0, 9.0, 13.0, 17.0, 21.0}) cut("bull:8:1", {-5, y, -14}, {35, y, -14});
  EXPECT_TRUE(scan().empty());
}

}  // namespace
}  // namespace kerf
