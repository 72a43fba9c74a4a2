// Which tool has made which of the moves, and how low they come.
#include "twin/process/milling/past_ways.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "stock/cutter/shape_spec.h"
#include "twin/process/milling/tool_side.h"

namespace kerf {
namespace {

class PastWaysTest : public testing::Test {
 protected:
  void mount(const char* shape, int number) { ways_.mount(parse_shape(shape).value(), number); }
  /// Along X at this Y, 10 mm long, at Z-1.
  void add(std::uint64_t id, double y_mm) {
    CutMove move;
    move.from_mm = {0, y_mm, -1}, move.to_mm = {10, y_mm, -1}, move.id = id;
    ways_.add(move);
  }
  PastWays ways_;
};

TEST_F(PastWaysTest, EachMoveIsOfTheToolThatWasInTheSpindle) {
  mount("ball:6", 1);
  add(1, 0);
  add(2, 20);
  mount("flat:4", 2);
  mount("ball:2", 3);  // without a move of the one before
  add(3, 40);
  mount("flat:4", 2);
  add(4, 60);
  mount("ball:6", 1);
  add(5, 80);
  ASSERT_EQ(ways_.tools(), 3u);
  const auto number = [&](std::uint32_t id) {
    const int tool = ways_.round_tool_of(id);
    return tool < 0 ? tool : ways_.number_of(tool);
  };
  EXPECT_EQ(number(1), 1);
  EXPECT_EQ(number(2), 1);
  EXPECT_EQ(number(3), 3);
  EXPECT_EQ(number(4), -1) << "flat";
  EXPECT_EQ(number(5), 1);
  EXPECT_EQ(number(6), -1) << "not known";
  // 0.8 mm beside its middle a ball of 6 is at -1 + 3 - sqrt(9 - 0.64), one of 2 at -1 + 1 - 0.6.
  EXPECT_NEAR(ways_.height_mm(2, {5, 20.8}), 2 - std::sqrt(9 - 0.64), 1e-4);
  EXPECT_NEAR(ways_.height_mm(3, {5, 40.8}), -0.6, 1e-4);
  EXPECT_NEAR(ways_.height_mm(4, {5, 60.8}), -1, 1e-6);
  EXPECT_NEAR(ways_.height_mm(5, {5, 80.8}), 2 - std::sqrt(9 - 0.64), 1e-4);
  EXPECT_TRUE(ways_.covers(4, {5, 61.9}, -1, 0));
  EXPECT_FALSE(ways_.covers(3, {5, 41.9}, -1, 0));
}

TEST_F(PastWaysTest, MovesOfOneNumberAreAskedWhateverToolMadeThem) {
  mount("ball:6", 1);
  add(7, 0);
  mount("flat:4", 2);
  add(7, 1);
  EXPECT_EQ(ways_.round_tool_of(7), -1) << "the last one counts";
  // At Y-2 only the ball has been: -1 + 3 - sqrt(9 - 4).
  EXPECT_NEAR(ways_.height_mm(7, {5, -2}), 2 - std::sqrt(5.0), 1e-4);
  EXPECT_NEAR(ways_.height_mm(7, {5, 1}), -1, 1e-6);
}

/// Against a hundred thousand places of the way: balls, cones with and without a flat end, gentle
/// and steeper than the cone; and what is no such tool is none.
TEST(ToolSide, IsLowestWhereNoOtherPlaceIsLower) {
  for (const char* const shape : {"ball:6", "vee:6:90", "vee:6:60", "drill:6:118", "vee:6:90:1"}) {
    const Cutter cutter = parse_shape(shape).value();
    const ToolSide side = ToolSide::of(cutter);
    const double radius = cutter.radius_mm();
    for (const double rise : {-2.5, -0.4, -0.01, 0.02, 0.3, 0.9, 3.0}) {
      for (const double beside : {0.0, 0.1, 0.7, 2.2}) {
        const double half = std::sqrt(radius * radius - beside * beside);
        const auto height = [&](double along) {
          const double distance = std::min(std::hypot(along, beside), radius * (1 - 1e-12));
          return rise * along + cutter.height_mm(distance);
        };
        double least = height(-half);
        constexpr int kPlaces = 100'000;
        for (int n = 1; n <= kPlaces; ++n)
          least = std::min(least, height(half * (2.0 * n / kPlaces - 1)));
        const std::optional<double> lowest = side.lowest_mm(rise, beside, half, 0);
        ASSERT_TRUE(lowest) << shape;
        EXPECT_NEAR(height(std::clamp(*lowest, -half, half)), least, 3e-4)
            << shape << ' ' << rise << ' ' << beside;
      }
    }
  }
  for (const char* const shape : {"bull:6:1", "taper:6:10:1", "flat:6"})
    EXPECT_FALSE(ToolSide::of(parse_shape(shape).value()).lowest_mm(0.5, 0, 3, 0)) << shape;
}

}  // namespace
}  // namespace kerf
