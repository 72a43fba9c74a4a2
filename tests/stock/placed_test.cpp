// Workpieces that lie elsewhere: against closed forms, and point by point.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <memory>
#include <random>

#include "base/placement.h"
#include "stock/cutter/shape_spec.h"
#include "stock/octree/octree.h"
#include "stock/zmap/mmap/mmap.h"
#include "stock/zmap/mmap/placed_columns.h"
#include "stock/zmap/zmap.h"
#include "tests/stock/stock_samples.h"

namespace kerf {
namespace {

CutMove straight(const Vec3& from, const Vec3& to) {
  CutMove move;
  move.from_mm = from;
  move.to_mm = to;
  return move;
}

Blank box_blank(const Vec3& low, const Vec3& high) {
  BlankBody body;
  body.bounds_mm = {low, high};
  Blank blank;
  blank.bodies.push_back(body);
  return blank;
}

/// A block of 40 x 30 x 20 mm with a pocket of 12 x 10 mm, 8 mm deep, from a corner on, and a slot
/// of 4 mm along X right through it at Y25.
template <class Model>
void mill(Model& model) {
  std::vector<CutReport> reports;
  const Cutter flat = *parse_shape("flat:4");
  std::vector<CutMove> moves;
  for (double y = 2; y <= 8; y += 2) moves.push_back(straight({2, y, -8}, {10, y, -8}));
  moves.push_back(straight({-5, 25, -21}, {45, 25, -21}));
  model.cut(flat, moves, reports);
  model.finish(reports);
}

std::unique_ptr<ZMap> milled_heights(double cell_mm) {
  auto made = ZMap::create({box_blank({0, 0, -20}, {40, 30, 0}), cell_mm});
  EXPECT_TRUE(made);
  mill(*made.value());
  return std::move(made.value());
}

std::unique_ptr<Octree> milled_octree(double cell_mm) {
  OctreeOptions options;
  options.blank = box_blank({0, 0, -20}, {40, 30, 0});
  options.cell_mm = cell_mm;
  auto made = Octree::create(options);
  EXPECT_TRUE(made);
  mill(*made.value());
  return std::move(made.value());
}

/// What mill() leaves, less where a surface is nearer than `near_mm`: 1 solid, 0 not, -1 too near.
int solid_by_hand(const Vec3& p, double near_mm) {
  const auto box = [&](const Vec3& low, const Vec3& high) {  // < 0 inside
    double f = -1e9;
    for (int a = 0; a < 3; ++a) f = std::max({f, low[a] - p[a], p[a] - high[a]});
    return f;
  };
  double f = box({0, 0, -20}, {40, 30, 0});
  // Between its four passes the pocket's walls have points of 0.27 mm.
  const double x = std::clamp(p.x, 2.0, 10.0);
  double pass = 1e9;
  for (const double y : {2.0, 4.0, 6.0, 8.0})
    pass = std::min(pass, std::hypot(p.x - x, p.y - y) - 2);
  const double pocket = std::max(pass, -8.0 - p.z);
  const double slot = std::abs(p.y - 25) - 2;
  f = std::max({f, -pocket, -slot});
  if (std::abs(f) < near_mm) return -1;
  return f < 0 ? 1 : 0;
}

/// Between two lanes, 2 mm from each other, a cusp is left at either end.
const double kCusp_mm2 = 4 - std::sqrt(3.0) - 4 * kPi / 6;
const double kPocket_mm3 = (12 * 10 - (4 - kPi) * 4 - 6 * kCusp_mm2) * 8;
const double kLeft_mm3 = 40 * 30 * 20 - kPocket_mm3 - 4 * 40 * 20;

TEST(Placement, turns_flips_and_finds_itself_by_three_points) {
  const Placement flip = Placement::flipped('x').about({10, 20, -5});
  EXPECT_EQ(flip.placed({1, 2, 3}), Vec3(1, 38, -13));
  const std::optional<AxisTurn> by_axes = Placement::turned({90, 0, 0}).by_axes();
  ASSERT_TRUE(by_axes);
  EXPECT_EQ(*by_axes, (AxisTurn{{0, 2, 1}, {1, -1, 1}}));
  EXPECT_FALSE(Placement::turned({0, 0, 30}).by_axes());
  const Placement any = Placement::turned({10, -20, 33}).then({glm::dmat3(1.0), {4, 5, 6}});
  const std::array<Vec3, 3> was{Vec3(0, 0, 0), Vec3(50, 3, 0), Vec3(4, 40, 7)};
  std::array<Vec3, 3> is{};
  for (std::size_t n = 0; n < 3; ++n) is[n] = any.placed(was[n]);
  const std::optional<Placement> found = Placement::by_points(was, is);
  ASSERT_TRUE(found);
  const Vec3 p(7, -8, 9);
  for (int a = 0; a < 3; ++a) {
    EXPECT_NEAR(found->placed(p)[a], any.placed(p)[a], 1e-12);
    EXPECT_NEAR(found->before(any.placed(p))[a], p[a], 1e-12);
  }
  EXPECT_FALSE(Placement::by_points({Vec3(0), Vec3(1, 0, 0), Vec3(2, 0, 0)}, is));
}

TEST(PlacedColumns, what_was_cut_from_above_is_a_gap_below) {
  const auto heights = milled_heights(0.25);
  const AxisTurn about_x{{0, 1, 2}, {1, -1, -1}};
  auto placed = placed_columns(*heights, about_x, {0, 30, -20}, 1, ZMapKernel::kScalar);
  ASSERT_TRUE(placed) << placed.error();
  const auto* const columns = dynamic_cast<const MMap*>(placed->stock.get());
  ASSERT_NE(columns, nullptr);
  EXPECT_NEAR(columns->bounds_mm().min.z, -20, 1e-6);
  EXPECT_NEAR(columns->bounds_mm().max.z, 0, 1e-6);
  EXPECT_EQ(placed->bound_mm, 20 * std::numeric_limits<float>::epsilon() / 2);
  for (int j = 0; j < columns->ny(); ++j) {
    for (int i = 0; i < columns->nx(); ++i) {
      const float was = heights->height_mm(i, columns->ny() - 1 - j);
      const std::vector<Gap> gaps = columns->gaps(i, j);
      if (was <= -20) {
        EXPECT_EQ(columns->height_mm(i, j), -20);
      } else {
        EXPECT_EQ(columns->height_mm(i, j), 0);
        ASSERT_EQ(gaps.size(), was < 0 ? 1U : 0U);
        if (was < 0) {
          EXPECT_EQ(gaps[0].low, -20);
          EXPECT_NEAR(gaps[0].high, -20 - was, 2e-6);
        }
      }
    }
  }
  // Walls are known to half a cell from then on.
  EXPECT_NEAR(columns->remaining_mm3(), test::volume_by_cells(*heights), 0.01);
  // And back: the very heights.
  auto back = placed_columns(*columns, about_x, {0, 30, -20}, 1, ZMapKernel::kScalar);
  ASSERT_TRUE(back);
  EXPECT_EQ(back->stock->name(), "zmap");
  EXPECT_EQ(back->stock->digest(), heights->digest());
}

TEST(PlacedColumns, a_quarter_turn_changes_cells_alone) {
  const auto heights = milled_heights(0.25);
  // X becomes Y, Y becomes -X.
  auto placed =
      placed_columns(*heights, {{1, 0, 2}, {-1, 1, 1}}, {30, 0, 0}, 1, ZMapKernel::kScalar);
  ASSERT_TRUE(placed);
  const auto* const turned = dynamic_cast<const ZMap*>(placed->stock.get());
  ASSERT_NE(turned, nullptr);
  EXPECT_EQ(placed->bound_mm, 0);
  EXPECT_EQ(turned->nx(), heights->ny());
  for (int j = 0; j < turned->ny(); ++j)
    for (int i = 0; i < turned->nx(); ++i)
      ASSERT_EQ(turned->height_mm(i, j), heights->height_mm(j, heights->ny() - 1 - i));
}

TEST(PlacedColumns, of_nothing_there_is_no_box) {
  auto made = ZMap::create({box_blank({0, 0, -2}, {4, 4, 0}), 0.5});
  std::vector<CutReport> reports;
  const std::vector<CutMove> away{straight({0, 2, -3}, {4, 2, -3})};
  (*made)->cut(*parse_shape("flat:20"), away, reports);
  (*made)->finish(reports);
  const auto placed =
      placed_columns(**made, {{0, 1, 2}, {1, -1, -1}}, Vec3(0), 1, ZMapKernel::kScalar);
  ASSERT_FALSE(placed);
  EXPECT_EQ(placed.error(), "nothing of the workpiece is left");
}

TEST(PlacedOctree, all_24_turns_move_nodes_alone) {
  const auto tree = milled_octree(0.5);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> x(-1, 41), y(-1, 31), z(-21, 1);
  int turns = 0;
  for (int a = 0; a < 3; ++a) {
    for (int b = 0; b < 3; ++b) {
      if (b == a) continue;
      for (int signs = 0; signs < 4; ++signs) {
        AxisTurn turn{{a, b, 3 - a - b}, {signs & 1 ? -1 : 1, signs & 2 ? -1 : 1, 1}};
        const bool even = (b - a + 3) % 3 == 1;
        turn.sign[2] = turn.sign[0] * turn.sign[1] * (even ? 1 : -1);
        ++turns;
        const Vec3 at(3, -4, 5);
        const std::unique_ptr<Octree> placed = tree->placed(turn, at);
        EXPECT_NEAR(placed->remaining_mm3(), tree->remaining_mm3(), 1e-6);
        for (int n = 0; n < 300; ++n) {
          const Vec3 was{x(random), y(random), z(random)};
          Vec3 p;
          for (int axis = 0; axis < 3; ++axis) {
            const auto i = static_cast<std::size_t>(axis);
            p[axis] = turn.sign[i] * was[turn.from[i]] + at[axis];
          }
          ASSERT_EQ(placed->solid_at(p, 0.01), tree->solid_at(was, 0.01));
        }
      }
    }
  }
  EXPECT_EQ(turns, 24);
  // Half a turn twice is none: the same nodes and volumes; an edge's very end is a part off.
  const AxisTurn about{{0, 1, 2}, {1, -1, -1}};
  const auto twice = tree->placed(about, Vec3(0))->placed(about, Vec3(0));
  EXPECT_EQ(twice->bounds_mm(), tree->bounds_mm());
  EXPECT_EQ(twice->brick_count(), tree->brick_count());
}

TEST(PlacedOctree, it_is_cut_on_as_if_it_had_been_cut_so) {
  // Half of it cut lying as it is, half on its side; and all of it lying as it is.
  OctreeOptions options;
  options.blank = box_blank({0, 0, -20}, {40, 30, 0});
  options.cell_mm = 0.5;
  const auto whole = Octree::create(options);
  ASSERT_TRUE(whole);
  const Cutter flat = *parse_shape("flat:6");
  std::vector<CutReport> reports;
  const std::vector<CutMove> first{straight({10, -5, -4}, {10, 35, -4})};
  (*whole)->cut(flat, first, reports);
  // -Y up: (x, y, z) -> (x, z, -y).
  const AxisTurn turn{{0, 2, 1}, {1, 1, -1}};
  const auto side = (*whole)->placed(turn, Vec3(0));
  const std::vector<CutMove> second{straight({-5, -12, -6}, {45, -12, -6})};
  side->cut(flat, second, reports);
  std::vector<CutMove> tilted = second;
  for (CutMove& move : tilted) {
    move.from_mm = {move.from_mm.x, -move.from_mm.z, move.from_mm.y};
    move.to_mm = {move.to_mm.x, -move.to_mm.z, move.to_mm.y};
    move.axis_from = move.axis_to = {0, -1, 0};
  }
  (*whole)->cut(flat, tilted, reports);
  EXPECT_NEAR(side->remaining_mm3(), (*whole)->remaining_mm3(), 0.05);
  EXPECT_NEAR(reports[1].removed_mm3, reports[2].removed_mm3, 0.05);
}

TEST(SurfaceToOctree, heights_on_their_side_and_in_between_keep_faces_and_edges) {
  const auto heights = milled_heights(0.25);
  const TriangleMesh mesh = heights->mesh(0);
  for (const Vec3& angles : {Vec3(90, 0, 0), Vec3(0, 0, 0), Vec3(30, 0, 0), Vec3(17, -23, 41)}) {
    const Placement placement = Placement::turned(angles);
    const auto made = Octree::of_surface(mesh, placement, 0.25, 2, heights->blank_mm3());
    ASSERT_TRUE(made) << made.error();
    EXPECT_EQ((*made)->blank_mm3(), heights->blank_mm3());
    EXPECT_NEAR((*made)->remaining_mm3(), kLeft_mm3, kLeft_mm3 * 3e-4) << angles.x;
    std::mt19937 random(11);
    std::uniform_real_distribution<double> x(-1, 41), y(-1, 31), z(-21, 1);
    int wrong = 0;
    for (int n = 0; n < 40'000; ++n) {
      const double at_x = x(random), at_y = y(random);  // in an order of our own
      const Vec3 was(at_x, at_y, z(random));
      const int solid = solid_by_hand(was, 0.26);  // half a cell of either model
      if (solid >= 0) wrong += (*made)->solid_at(placement.placed(was), 0) != (solid == 1);
    }
    EXPECT_EQ(wrong, 0) << angles.x << " " << angles.y << " " << angles.z;
  }
}

/// What is off is off at its edges, 180 mm of them, by the square of a cell.
TEST(SurfaceToOctree, edges_of_a_slanting_block_are_sharp) {
  for (const double cell_mm : {0.5, 0.25}) {
    OctreeOptions options;
    options.blank = box_blank({0, 0, -10}, {20, 15, 0});
    options.cell_mm = cell_mm;
    const auto block = Octree::create(options);
    const Placement placement = Placement::turned({25, 35, 10});
    const auto made = Octree::of_surface((*block)->mesh(0), placement, cell_mm, 1, 3000);
    ASSERT_TRUE(made) << made.error();
    EXPECT_NEAR((*made)->remaining_mm3(), 3000, 0.04 * cell_mm * cell_mm * 180);
    // All that is left lies on the block's faces, its edges and corners too.
    double worst = 0, farthest = 0;
    for (const glm::vec3& p : (*made)->mesh(0).positions_mm) {
      const Vec3 was = placement.before(Vec3(p));
      double f = -1e9;
      for (int a = 0; a < 3; ++a)
        f = std::max({f, options.blank.bodies[0].bounds_mm.min[a] - was[a],
                      was[a] - options.blank.bodies[0].bounds_mm.max[a]});
      worst = std::max(worst, std::abs(f));
      farthest = std::max(farthest, glm::length(was - Vec3(10, 7.5, -5)));
    }
    EXPECT_LT(worst, cell_mm / 2);
    EXPECT_NEAR(farthest, glm::length(Vec3(10, 7.5, 5)), cell_mm / 2);
  }
}

TEST(SurfaceToOctree, says_what_does_not_fit) {
  const auto heights = milled_heights(1);
  const auto made = Octree::of_surface(heights->mesh(0), Placement(), 50, 1, 1);
  ASSERT_FALSE(made);
  EXPECT_NE(made.error().find("exceeds the blank"), std::string::npos) << made.error();
}

}  // namespace
}  // namespace kerf
