// The looks of EngagementScan by each of the kernels that run here: equal bits.
#include "twin/process/milling/front_kernel.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "stock/cutter/shape_spec.h"
#include "stock/zmap/zmap.h"
#include "twin/process/milling/engagement_scan.h"

namespace kerf {
namespace {

std::array<double, 10> numbers_of(const EngagementLook& look) {
  return {look.angle_rad,
          look.wide_mm,
          look.deep_mm,
          look.entry_rad,
          look.exit_rad,
          look.climb,
          look.is_plunge ? 1.0 : 0.0,
          look.effective_mm,
          look.contact_mm,
          look.cuts_centre ? 1.0 : 0.0};
}

/// A block 40 x 30 x 10 mm that moves at random, of one cutter, have gone over.
class FrontKernelTest : public testing::Test {
 protected:
  void cut_at_random(const Cutter& cutter, double cell_mm) {
    ZMapOptions options;
    options.blank = parse_blank("box:0,0,-10:40,30,0").value();
    options.cell_mm = cell_mm;
    stock_ = std::move(ZMap::create(options).value());
    stock_->keep_cut_ids(true);
    ways_.clear();
    ways_.mount(cutter);
    for (std::uint64_t n = 0; n < 30; ++n) {
      CutMove move = any_move();
      move.id = n;
      ways_.add(move);
      std::vector<CutReport> reports;
      stock_->cut(cutter, {&move, 1}, reports);
      stock_->finish(reports);
    }
  }
  CutMove any_move() {
    std::uniform_real_distribution<double> x(-3, 43), y(-3, 33), z(-4, -0.2), sweep(-6, 6);
    CutMove move;
    move.from_mm = {x(random_), y(random_), z(random_)};
    const int kind = static_cast<int>(random_() % 4);
    if (kind == 3) {
      const double angle = sweep(random_), radius = 2 + std::abs(angle);
      const Vec3 center = move.from_mm + Vec3(radius, 0, 0);
      move.arc = CutArc{center, {0, 0, 1}, angle};
      move.to_mm = center + Vec3(-radius * std::cos(angle), -radius * std::sin(angle), 0);
    } else {
      move.to_mm = {x(random_), y(random_), kind == 0 ? z(random_) : move.from_mm.z};
      if (kind == 2) move.to_mm = move.from_mm + 0.02 * (move.to_mm - move.from_mm);
    }
    return move;
  }

  std::mt19937 random_{20261128};
  std::unique_ptr<ZMap> stock_;
  PastWays ways_;
};

TEST_F(FrontKernelTest, LooksAreTheSameBitsByAllKernels) {
  int engaged = 0;
  for (const std::string shape :
       {"ball:6", "bull:6:1", "vee:6:90", "taper:6:10:1", "drill:6:118", "flat:6"}) {
    for (const double cell_mm : {0.1, 0.4}) {
      const Cutter cutter = parse_shape(shape).value();
      cut_at_random(cutter, cell_mm);
      const std::optional<HeightGrid> heights = stock_->present_heights();
      for (int n = 0; n < 60; ++n) {
        const CutMove move = any_move(), other = any_move();
        if (move.to_mm == move.from_mm || !EngagementScan::takes(cutter, move)) continue;
        EngagementScan::Look asked;
        asked.at = n % 3 == 0 ? 0.95 : 0.4;
        asked.held = n % 4 == 1 && !other.arc ? &other : nullptr;
        asked.is_brief = n % 2 == 1;
        if (n % 5 != 0) asked.owners = stock_.get(), asked.ways = &ways_;
        std::optional<EngagementLook> first;
        for (const FrontKernel& kernel : front_kernels()) {
          EngagementScan scan;
          scan.use(kernel);
          const EngagementLook look = scan.look_ahead(*heights, cutter, move, asked);
          if (!first) first = look;
          EXPECT_EQ(numbers_of(look), numbers_of(*first))
              << kernel.name << ", " << shape << " " << n;
        }
        engaged += first->is_engaged() ? 1 : 0;
      }
    }
  }
  EXPECT_GT(engaged, 150);
}

/// A ramp of 8 x 8 cells: a plane, so that its depth is told exactly between cells.
TEST(FrontKernel, APlaceIsAsDeepAsTheSurfaceBetweenFourCells) {
  std::vector<double> flat(1026, 0.0);
  const LiftTable table{flat.data(), 1024 / 4.0, 1024};
  const FrontGrid grid{0, 0, 1, 1, 8, 8};
  const RayLine line{1, 2, 1, 0.25};
  RayGround ground;
  ground.floor = -9, ground.film = 1e-4, ground.wall = 3, ground.twist = 0.05;
  for (const FrontKernel& kernel : front_kernels()) {
    RayPlaces at{};
    for (int k = 0; k < RayPlaces::kMost; ++k) at.radius[k] = 0.37 * k;
    kernel.lay_ray(grid, line, {}, 19, at);
    for (int k = 0; k < 19; ++k) {
      for (int n = 0; n < 4; ++n) {
        const double x = at.i[k] + n % 2 + 0.5, y = at.j[k] + n / 2 + 0.5;
        at.height[n][k] = static_cast<float>(0.5 * x - 0.25 * y);
      }
    }
    kernel.look_along(grid, line, table, ground, 19, at);
    for (int k = 0; k < 19; ++k) {
      const double x = 1 + 0.37 * k, y = 2 + 0.37 * 0.25 * k;
      if (x >= 7.5) {
        EXPECT_EQ(at.state[k], RayPlaces::kAsk) << kernel.name << " " << k;
      } else {
        EXPECT_EQ(at.state[k], RayPlaces::kDone) << kernel.name << " " << k;
        EXPECT_NEAR(at.depth[k], 0.5 * x - 0.25 * y, 1e-12) << kernel.name << " " << k;
      }
    }
  }
}

/// Five cells: over the surface, under it, behind the end of the way, under a held way's floor, and
/// none at all.
TEST(FrontKernel, CellsAreInMaterialThatTheHeldWayAndTheEndHaveLeft) {
  std::vector<double> flat(1026, 0.0);
  const LiftTable table{flat.data(), 1024 / 2.0, 1024};
  CellGround ground;
  ground.tip = -1, ground.film = 0, ground.radius = 2, ground.wall_slope = 4;
  FrontEnd end;
  end.is_near = true, end.x = 1, end.radius2 = 4;
  HeldWay held;
  held.start_x = -5, held.start_y = 1.5, held.length = 10, held.z = -1.5, held.lowest = -1.5;
  for (const FrontKernel& kernel : front_kernels()) {
    CellBatch cells{};
    cells.count = 5;
    const double places[5][3] = {{1, -1, 0}, {1, -1, -1.2}, {3.5, -1, 0}, {1, 1, 0}, {0, -1, -9}};
    for (int n = 0; n < 5; ++n)
      cells.x[n] = places[n][0], cells.y[n] = places[n][1], cells.height[n] = places[n][2];
    kernel.take_cells(ground, end, held, table, cells);
    EXPECT_EQ(cells.depth[0], 1) << kernel.name;
    EXPECT_LT(cells.depth[1], 0) << kernel.name;
    EXPECT_LT(cells.depth[2], 0) << kernel.name;
    EXPECT_EQ(cells.depth[3], -0.5) << kernel.name;
    EXPECT_LT(cells.depth[4], 0) << kernel.name;
  }
}

/// A cell's share is spread evenly over the directions in which it is seen, and what is between two
/// steps is shared by them: as by 100 000 places, one after the other; past the sides nothing is.
/// Directions are told to 2e-5 rad, which is 0.0005 of a step, of a share of 0.1.
TEST(FrontKernel, ACellsShareIsSpreadOverItsDirections) {
  std::vector<double> flat(1026, 0.0), height(1026, 0.25), thick(1026, 0.5), upright(1026, 0.0);
  const LiftTable table{flat.data(), 1024 / 2.0, 1024};
  constexpr int kSteps = 72;
  for (const double wide : {0.3, 1.0, 4.7, 30.0}) {
    std::vector<double> steps(1026, wide);
    const CellWeights weights{height.data(), thick.data(), upright.data(), steps.data(),
                              double{kSteps}};
    for (const double degrees : {-89.5, -31.0, 0.0, 7.5, 88.0, 93.0}) {
      std::vector<double> expected(kSteps + 1, 0.0);
      const double step = (degrees + 90) * kSteps / 180;
      constexpr int kPlaces = 100'000;
      for (int n = 0; n < kPlaces; ++n) {
        const double at = step + wide * ((n + 0.5) / kPlaces - 0.5);
        if (at < 0 || at >= kSteps) continue;
        const auto low = static_cast<std::size_t>(at);
        const double beyond = at - static_cast<double>(low), share = 0.5 * 0.8 * 0.25 / kPlaces;
        expected[low] += share * (1 - beyond), expected[low + 1] += share * beyond;
      }
      for (const FrontKernel& kernel : front_kernels()) {
        CellBatch cells{};
        cells.count = 1;
        cells.x[0] = std::cos(degrees * kPi / 180), cells.y[0] = std::sin(degrees * kPi / 180);
        cells.radius[0] = 1, cells.depth[0] = 0.8;
        kernel.place_cells(CellGround{}, table, weights, 0, kSteps / kPi, cells);
        std::vector<double> rises(kSteps + 3, 0.0);
        for (const CellBatch::End* const end : {&cells.first_end, &cells.last_end}) {
          const auto low = static_cast<std::size_t>(end->low[0]);
          rises[low] += end->first[0], rises[low + 1] += end->second[0];
          rises[low + 2] += end->third[0];
        }
        double sum = rises[kSteps + 2];
        for (std::size_t k = kSteps + 1; k-- > 0;) {
          sum += rises[k + 1];
          EXPECT_NEAR(sum, expected[k], 4e-5) << kernel.name << ", " << wide << ' ' << degrees;
        }
      }
    }
  }
}

/// In a plane that nothing has cut a cone is as deep in all directions: half a turn. It goes 0.6 mm
/// deep, so six cells far, and the cells next to its tip are seen in a wide angle.
TEST(FrontKernel, AConeInAPlaneIsEngagedByHalfATurn) {
  ZMapOptions options;
  options.blank = parse_blank("box:0,0,-5:20,10,0").value();
  options.cell_mm = 0.1;
  const std::unique_ptr<ZMap> stock = std::move(ZMap::create(options).value());
  const Cutter cutter = parse_shape("vee:6:90").value();
  for (const double y : {5.0, 5.03}) {
    CutMove move;
    move.from_mm = {5, y, -0.6}, move.to_mm = {15, y, -0.6};
    EngagementScan::Look asked;
    asked.at = 0.5, asked.is_brief = true;
    EngagementScan scan;
    const EngagementLook look =
        scan.look_ahead(stock->present_heights().value(), cutter, move, asked);
    EXPECT_NEAR(look.angle_rad, kPi, 4 * kPi / 180) << y;
    EXPECT_NEAR(look.entry_rad, 0, 2 * kPi / 180) << y;
    EXPECT_NEAR(look.exit_rad, kPi, 2 * kPi / 180) << y;
  }
}

/// Blocks of 2 x 4 cells of a plain at z = 0 that rises by 1 to the right, a cone of 1 in 1 with
/// its tip at z = -1: what is higher than that, and asked about, is collected, to a bit of slack.
TEST(FrontKernel, BlocksGiveTheCellsThatAreHigherThanTheCutter) {
  constexpr int kBlocks = 5, kCells = CellBlocks::kCells;
  std::vector<float> cone(1026), heights;
  for (std::size_t k = 0; k < cone.size(); ++k)
    cone[k] = static_cast<float>(8 * std::sqrt(static_cast<double>(k) / 1024));
  for (int k = 0; k < kBlocks * kCells; ++k)
    heights.push_back(static_cast<float>(k / kCells * 2 + k % 2) - 2.25F);
  CellBlocks blocks;
  blocks.heights = heights.data(), blocks.count = kBlocks, blocks.i = 10;
  for (int row = 0; row < CellBlocks::kY; ++row)
    blocks.first[row] = row == 2 ? 13 : 10, blocks.last[row] = row == 3 ? 17 : 19;
  blocks.x = -3, blocks.y = -2, blocks.cell_x = blocks.cell_y = 1, blocks.tip = -1;
  blocks.low_lift = cone.data(), blocks.to_part = 1024 / 64.0, blocks.last_part = 1025;
  for (const FrontKernel& kernel : front_kernels()) {
    CellBatch cells{};
    EXPECT_EQ(kernel.collect(blocks, cells), kBlocks);
    int found = 0;
    for (int row = 0; row < CellBlocks::kY; ++row) {
      for (int i = blocks.first[row]; i <= blocks.last[row]; ++i) {
        const double x = -3 + (i - 10), y = -2 + row, height = i - 10 - 2.25;
        const double over = height - (-1 + std::hypot(x, y));
        if (std::abs(over) < 0.1) continue;  // within a step of the table
        bool has = false;
        for (int n = 0; n < cells.count; ++n)
          has = has || (cells.x[n] == x && cells.y[n] == y && cells.height[n] == height);
        EXPECT_EQ(has, over > 0) << kernel.name << " " << i << " " << row;
        found += has ? 1 : 0;
      }
    }
    EXPECT_GT(found, 8) << kernel.name;
    // No room for another block.
    cells.count = CellBatch::kMost - kCells + 1;
    EXPECT_EQ(kernel.collect(blocks, cells), 0) << kernel.name;
  }
}

}  // namespace
}  // namespace kerf
