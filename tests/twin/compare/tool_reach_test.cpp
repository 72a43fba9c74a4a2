#include "twin/compare/tool_reach.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "stock/cutter/shape_spec.h"
#include "twin/compare/design_walls.h"

namespace kerf {
namespace {

constexpr double kCell_mm = 0.1;
constexpr float kNone = -std::numeric_limits<float>::infinity();

struct Field {
  int nx = 0, ny = 0;
  std::vector<float> z;
  std::vector<float> design_mm;
  std::vector<WallPoint> walls;
  Vec2 cell_mm{kCell_mm};
  Field(int nx_cells, int ny_cells, const std::function<double(double, double)>& height)
      : nx(nx_cells), ny(ny_cells) {
    for (int j = 0; j < ny; ++j)
      for (int i = 0; i < nx; ++i)
        z.push_back(static_cast<float>(height((i + 0.5) * kCell_mm, (j + 0.5) * kCell_mm)));
    design_mm = z;
  }
  /// The same with its walls where they are.
  static Field with_walls(int nx_cells, int ny_cells,
                          const std::function<double(double, double)>& height) {
    Field field(nx_cells, ny_cells, height);
    ColumnGrid grid;
    grid.bounds_mm = {{0, 0, -10}, {nx_cells * kCell_mm, ny_cells * kCell_mm, 0}};
    grid.nx = nx_cells, grid.ny = ny_cells;
    std::vector<float> along_x, along_y;
    for (int j = 0; j < field.ny; ++j)
      for (int i = 0; i < field.nx * kFinePerCell; ++i)
        along_x.push_back(
            static_cast<float>(height((i + 0.5) * kCell_mm / kFinePerCell, (j + 0.5) * kCell_mm)));
    for (int j = 0; j < field.ny * kFinePerCell; ++j)
      for (int i = 0; i < field.nx; ++i)
        along_y.push_back(
            static_cast<float>(height((i + 0.5) * kCell_mm, (j + 0.5) * kCell_mm / kFinePerCell)));
    DesignFromAbove above = kerf::with_walls(grid, field.z, along_x, along_y);
    field.design_mm = std::move(above.top_mm);
    field.walls = std::move(above.walls);
    return field;
  }
  std::vector<float> lowest(const std::string& shape, float enough_mm = 0) const {
    const std::vector<std::uint8_t> all(z.size(), 1);
    return ToolReach(nx, ny, cell_mm, design_mm, walls)
        .lowest_mm(parse_shape(shape).value(), all, enough_mm);
  }
  /// What is left above the design, up to `top_mm`.
  double left_mm3(const std::vector<float>& lowest_mm, float top_mm) const {
    double sum = 0;
    for (std::size_t k = 0; k < z.size(); ++k)
      sum += static_cast<double>(std::min(lowest_mm[k], top_mm) - std::min(z[k], top_mm));
    return sum * cell_mm.x * cell_mm.y;
  }
};

/// The formulas of tool_reach.h as they stand there.
std::vector<float> brute_force(const Field& field, const Cutter& cutter) {
  const int reach = static_cast<int>(cutter.radius_mm() / kCell_mm) + 2;
  const double radius = cutter.radius_mm() - 1e-7;
  const auto surface = [&](double x, double y) {
    const double r = std::hypot(x * field.cell_mm.x, y * field.cell_mm.y);
    return r <= radius ? cutter.height_mm(r) : std::numeric_limits<double>::infinity();
  };
  std::vector<float> lowest(field.z.size(), std::numeric_limits<float>::infinity());
  for (int j = -2 * reach; j < 2 * (field.ny + reach); ++j) {
    for (int i = -2 * reach; i < 2 * (field.nx + reach); ++i) {
      const double px = i / 2.0, py = j / 2.0;  // in cells, from the middle of the first one
      const int low_x = std::max(0, static_cast<int>(px) - reach);
      const int low_y = std::max(0, static_cast<int>(py) - reach);
      const int high_x = std::min(field.nx, static_cast<int>(px) + reach + 1);
      const int high_y = std::min(field.ny, static_cast<int>(py) + reach + 1);
      double tip = -1e300;
      for (const WallPoint& wall : field.walls)
        tip = std::max(
            tip, static_cast<double>(wall.z_mm) -
                     surface(wall.x_mm / kCell_mm - 0.5 - px, wall.y_mm / kCell_mm - 0.5 - py));
      for (int y = low_y; y < high_y; ++y)
        for (int x = low_x; x < high_x; ++x)
          tip = std::max(tip, static_cast<double>(
                                  field.design_mm[static_cast<std::size_t>(y * field.nx + x)]) -
                                  surface(x - px, y - py));
      for (int y = low_y; y < high_y; ++y) {
        for (int x = low_x; x < high_x; ++x) {
          const double left = surface(x - px, y - py) + tip;
          float& z = lowest[static_cast<std::size_t>(y * field.nx + x)];
          if (!std::isnan(left)) z = std::min(z, static_cast<float>(left));
        }
      }
    }
  }
  for (float& z : lowest)
    if (z < -1e6f) z = kNone;
  return lowest;
}

TEST(ToolReach, IsWhatAllPlacesOfTheToolLeave) {
  std::mt19937 random(20240917);
  std::uniform_real_distribution<double> unit(0, 1);
  const std::vector<std::string> shapes{"flat:1.2",  "ball:1.5",       "bull:1.7:0.3", "vee:1.3:60",
                                        "flat:0.15", "taper:1:10:0.2", "ball:0.95"};
  for (int round = 0; round < 4; ++round) {
    // Slopes, pits, walls, holes through and single cells that stand up.
    const double slope = unit(random) - 0.5, pit_x = 3 * unit(random), pit_y = 2 * unit(random);
    const auto height = [&](double x, double y) {
      double z = slope * x + 0.3 * std::sin(2 * y);
      if (std::abs(x - pit_x) < 0.6 && std::abs(y - pit_y) < 0.8) z -= 1.5;
      if (unit(random) < 0.02) z += 2 * unit(random) - 1;
      return std::hypot(x - 3, y - 2) < 0.5 * round ? -std::numeric_limits<double>::infinity() : z;
    };
    const Field field = round % 2 == 0 ? Field(37, 27, height) : Field::with_walls(37, 27, height);
    EXPECT_EQ(field.walls.empty(), round % 2 == 0);
    for (const std::string& shape : shapes) {
      const std::vector<float> lowest = field.lowest(shape);
      const std::vector<float> expected = brute_force(field, parse_shape(shape).value());
      for (std::size_t k = 0; k < lowest.size(); ++k) {
        if (expected[k] == kNone) {
          ASSERT_EQ(lowest[k], kNone) << shape << " round " << round << " cell " << k;
        } else {
          ASSERT_NEAR(lowest[k], expected[k], 2e-6) << shape << " round " << round << " cell " << k;
        }
      }
    }
  }
}

TEST(ToolReach, CellsThatAreNotAskedForChangeNothing) {
  const Field field(60, 40, [](double x, double y) { return std::sin(x) + std::cos(2 * y); });
  const std::vector<float> all = field.lowest("ball:2");
  std::vector<std::uint8_t> some(field.z.size(), 0);
  for (std::size_t k = 0; k < some.size(); k += 7) some[k] = 1;
  const std::vector<float> found = ToolReach(field.nx, field.ny, field.cell_mm, field.z)
                                       .lowest_mm(parse_shape("ball:2").value(), some, 0);
  for (std::size_t k = 0; k < some.size(); ++k)
    ASSERT_FLOAT_EQ(found[k], some[k] != 0 ? all[k] : ToolReach::kNotAsked);
}

TEST(ToolReach, IsNeverBelowTheDesignAndWhatIsLeftStaysWhenTheToolComesAgain) {
  const Field field(80, 50, [](double x, double y) { return std::sin(x) * std::cos(2 * y); });
  for (const char* shape : {"ball:2", "flat:1.5", "bull:3:0.5", "vee:2:90"}) {
    const std::vector<float> once = field.lowest(shape);
    for (std::size_t k = 0; k < once.size(); ++k) ASSERT_GE(once[k], field.z[k] - 1e-6f) << shape;
    Field again = field;
    again.z = once;
    const std::vector<float> twice = again.lowest(shape);
    for (std::size_t k = 0; k < once.size(); ++k) ASSERT_NEAR(twice[k], once[k], 2e-6) << shape;
  }
}

/// A pocket of 20 x 16 mm, 5 mm deep.
Field pocket() {
  return Field::with_walls(
      260, 220, [](double x, double y) { return x > 3 && x < 23 && y > 3 && y < 19 ? -5.0 : 0.0; });
}

TEST(ToolReach, CornersOfAPocketKeepWhatTheRoundLeaves) {
  for (const double radius : {3.0, 1.5, 0.95, 4.3}) {
    const Field field = pocket();
    const std::vector<float> lowest = field.lowest("flat:" + std::to_string(2 * radius));
    const double expected = 4 * (1 - kPi / 4) * radius * radius * 5;
    // Walls are known to an eighth of a cell on average: along the arc and both walls of each
    // corner.
    EXPECT_NEAR(field.left_mm3(lowest, 0), expected, 4 * 5 * (kPi / 2 + 2) * radius * kCell_mm / 8)
        << radius;
  }
}

TEST(ToolReach, ABullNoseLeavesItsRoundAlongTheFloor) {
  // Far from the corners: r^2 (1 - pi / 4) for each mm of the wall.
  const Field field =
      Field::with_walls(300, 60, [](double, double y) { return y > 3 ? -5.0 : 0.0; });
  const std::vector<float> lowest = field.lowest("bull:4:1");
  double mm2 = 0;
  for (int j = 0; j < field.ny; ++j)
    mm2 += kCell_mm * static_cast<double>(lowest[static_cast<std::size_t>(j * field.nx + 150)] -
                                          field.z[static_cast<std::size_t>(j * field.nx + 150)]);
  EXPECT_NEAR(mm2, 1 - kPi / 4, 0.02);
  EXPECT_NEAR(lowest[static_cast<std::size_t>(31 * field.nx + 150)],
              -5 + 1 - std::sqrt(1 - 0.85 * 0.85), 0.02);
}

TEST(ToolReach, BallAndConeInAGroove) {
  // A groove of 90 degrees: a ball of radius R rests R (sqrt 2 - 1) above its bottom. The design's
  // lowest middles are half a cell up its flanks.
  const Field field(120, 40, [](double x, double) { return std::abs(x - 6) - 4; });
  for (const double radius : {0.5, 1.0, 2.0}) {
    const std::vector<float> lowest = field.lowest("ball:" + std::to_string(2 * radius));
    EXPECT_NEAR(lowest[static_cast<std::size_t>(20 * field.nx + 60)],
                -4 + radius * (std::sqrt(2.0) - 1), 0.002 + kCell_mm * kCell_mm / (8 * radius));
  }
  // A cone as steep as the groove goes to its bottom, one of 120 degrees touches at its rim: from
  // there it is D/2 (1 - tan 30) above it.
  EXPECT_NEAR(field.lowest("vee:3:90")[static_cast<std::size_t>(20 * field.nx + 60)], -3.95, 1e-5);
  EXPECT_NEAR(field.lowest("vee:3:120")[static_cast<std::size_t>(20 * field.nx + 60)],
              -4 + 1.5 * (1 - std::tan(kPi / 6)), kCell_mm / 2);
}

TEST(ToolReach, ASlotAsWideAsTheToolIsReachedWhereverItLies) {
  for (const double wide : {3.0, 3.05, 3.175, 2.95}) {
    for (const double from : {2.0, 2.03, 2.051, 2.07, 2.099}) {
      const Field field = Field::with_walls(
          80, 30, [&](double x, double) { return x > from && x < from + wide ? -5.0 : 0.0; });
      const std::vector<float> lowest = field.lowest("flat:" + std::to_string(wide));
      for (int i = 0; i < field.nx; ++i) {
        // Right at the walls it may miss a cell's middle by its place on the grid.
        const double x = (i + 0.5) * kCell_mm;
        if (std::min(std::abs(x - from), std::abs(x - from - wide)) < kCell_mm / 4) continue;
        ASSERT_FLOAT_EQ(lowest[static_cast<std::size_t>(15 * field.nx + i)],
                        field.z[static_cast<std::size_t>(15 * field.nx + i)])
            << wide << " from " << from << " cell " << i;
      }
      const std::vector<float> wider = field.lowest("flat:" + std::to_string(wide + 2 * kCell_mm));
      ASSERT_FLOAT_EQ(wider[static_cast<std::size_t>(15 * field.nx + 35)], 0);
    }
  }
}

TEST(ToolReach, ThroughAHoleOnlyWhatFits) {
  const Field field = Field::with_walls(100, 100, [](double x, double y) {
    return std::hypot(x - 5, y - 5) < 2.5 ? -std::numeric_limits<double>::infinity() : 0.0;
  });
  const std::size_t middle = 50 * 100 + 50;
  EXPECT_EQ(field.lowest("flat:4")[middle], kNone);
  EXPECT_FLOAT_EQ(field.lowest("flat:6")[middle], 0);
  // A ball of 6 hangs in it: sqrt(9 - 2.5^2) below its middle is the rim.
  EXPECT_NEAR(field.lowest("ball:6")[middle], std::sqrt(9 - 6.25) - 3, 0.08);
}

}  // namespace
}  // namespace kerf
