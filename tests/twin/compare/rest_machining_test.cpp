#include "twin/compare/rest_machining.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "stock/cutter/shape_spec.h"
#include "stock/octree/octree.h"
#include "stock/zmap/mmap/mmap.h"
#include "stock/zmap/zmap.h"
#include "tests/twin/compare/meshes.h"

namespace kerf {
namespace {

const Box kBlock{{0, 0, -10}, {40, 30, 0}};
constexpr double kRestCell_mm = 0.1;

DesignPart pocket_design() {
  Diagnostics diagnostics;
  return {test::pocketed_mesh(kBlock, {5, 5}, {35, 25}, -4), "part.stl", diagnostics};
}

std::unique_ptr<StockModel> block(const std::string& model, double cell_mm = kRestCell_mm) {
  BlankBody body;
  body.bounds_mm = kBlock;
  Blank blank;
  blank.bodies.push_back(body);
  if (model == "octree") {
    OctreeOptions options;
    options.blank = blank;
    options.cell_mm = cell_mm;
    return std::move(Octree::create(options).value());
  }
  ZMapOptions options;
  options.blank = blank;
  options.cell_mm = cell_mm;
  if (model == "mmap") return std::move(MMap::create(options).value());
  return std::move(ZMap::create(options).value());
}

void cut(StockModel& stock, const std::string& shape, const std::vector<Vec3>& path) {
  const Cutter cutter = parse_shape(shape).value();
  std::vector<CutMove> moves;
  for (std::size_t n = 0; n + 1 < path.size(); ++n) {
    CutMove move;
    move.from_mm = path[n], move.to_mm = path[n + 1], move.id = n;
    moves.push_back(move);
  }
  std::vector<CutReport> reports;
  stock.cut(cutter, moves, reports);
  stock.finish(reports);
}

/// The pocket from 5, 5 to 35, 25, 4 mm deep, less `allowance_mm` at its walls and its floor.
std::unique_ptr<StockModel> pocketed(const std::string& model, double diameter_mm,
                                     double allowance_mm, double cell_mm = kRestCell_mm) {
  std::unique_ptr<StockModel> stock = block(model, cell_mm);
  const std::string shape = "flat:" + std::to_string(diameter_mm);
  const double z = -4 + allowance_mm;
  const double inset = diameter_mm / 2 + allowance_mm;
  std::vector<Vec3> path{{20, 15, 5}, {20, 15, z}};
  for (double in = inset; in < 10; in += diameter_mm / 3) {
    for (const Vec2& at : {Vec2(5 + in, 5 + in), Vec2(35 - in, 5 + in), Vec2(35 - in, 25 - in),
                           Vec2(5 + in, 25 - in), Vec2(5 + in, 5 + in)})
      path.emplace_back(at, z);
  }
  path.emplace_back(10, 15, z), path.emplace_back(30, 15, z);
  cut(*stock, shape, path);
  return stock;
}

RestTool tool(int number, const std::string& shape) {
  RestTool out;
  out.number = number;
  out.shape = shape;
  return out;
}

TEST(RestMachining, CornersAreLeftByTheWideToolAndTakenByNarrowOnes) {
  const DesignPart design = pocket_design();
  for (const std::string model : {"zmap", "mmap", "octree"}) {
    const auto stock = pocketed(model, 8, 0);
    const Rest rest = find_rest(*stock, design, 0.1,
                                {tool(1, "flat:8"), tool(2, "flat:3"), tool(3, "ball:3"),
                                 tool(4, "drill:5:118"), tool(5, "bull:2:0.5")});
    ASSERT_EQ(rest.regions_in_all, 4u) << model;
    const double each = (1 - kPi / 4) * 16 * 4, of_three = (1 - kPi / 4) * 2.25 * 4;
    // Where it runs out at either end it is thinner than 0.1 mm.
    const double thin = 2 * 0.25;
    for (const RestRegion& region : rest.regions) {
      EXPECT_LT(region.volume_mm3, each + 0.2) << model;
      EXPECT_GT(region.volume_mm3, each - thin) << model;
      // In the corner: R (sqrt 2 - 1) from the arc; from its top as far from the nearer wall.
      EXPECT_NEAR(region.thickness_mm, 4 - 4 / std::sqrt(2.0), 0.1) << model;
      EXPECT_NEAR(region.box_mm.min.z, -4, 0.02) << model;
      EXPECT_NEAR(region.box_mm.max.z, 0, 0.02) << model;
      ASSERT_EQ(region.by_tool.size(), 4u);
      EXPECT_LT(region.by_tool[0].takes_mm3, 0.03 * each) << model;
      EXPECT_NEAR(region.by_tool[0].leaves_mm, region.thickness_mm, 0.12) << model;
      EXPECT_NEAR(region.volume_mm3 - region.by_tool[1].takes_mm3, of_three, 0.25) << model;
      EXPECT_NEAR(region.by_tool[1].leaves_mm, 1.5 - 1.5 / std::sqrt(2.0), 0.1) << model;
      // A ball leaves its round along the floor, besides.
      EXPECT_LT(region.by_tool[2].takes_mm3, region.by_tool[1].takes_mm3 - 0.3) << model;
    }
    EXPECT_EQ(rest.tools[0].clears, 0u);
    EXPECT_FALSE(rest.tools[3].left_out.empty());
    EXPECT_EQ(rest.tools[4].left_out, "");
    EXPECT_NEAR(rest.by_none_mm3, rest.volume_mm3 - rest.tools[4].takes_mm3, 1.5) << model;
  }
}

TEST(RestMachining, AToolAsNarrowAsTheCornersClearsThem) {
  Diagnostics diagnostics;
  const DesignPart design = pocket_design();
  const auto stock = pocketed("zmap", 8, 0);
  const Rest rest = find_rest(*stock, design, 0.25, {tool(1, "flat:1.5"), tool(2, "flat:1")});
  ASSERT_EQ(rest.regions_in_all, 4u);
  // R - R / sqrt 2 of R = 0.75 is 0.22.
  EXPECT_EQ(rest.tools[0].clears, 4u);
  EXPECT_EQ(rest.tools[1].clears, 4u);
  // The widest that clears a place has it; the other one some of the rims.
  EXPECT_LT(std::count(rest.map.cells.begin(), rest.map.cells.end(), RestMap::kByTool + 1), 4 * 10);
  EXPECT_GT(std::count(rest.map.cells.begin(), rest.map.cells.end(), RestMap::kByTool), 4 * 300);
  EXPECT_EQ(std::count(rest.map.cells.begin(), rest.map.cells.end(), RestMap::kByNone), 0);
}

TEST(RestMachining, AnAllowanceIsRestWhereItIsThickerThanAskedFor) {
  const DesignPart design = pocket_design();
  const auto stock = pocketed("zmap", 3, 0.3);
  const Rest thin = find_rest(*stock, design, 0.35, {tool(1, "flat:2")});
  // In the corners alone: 1.8 (1 - 1 / sqrt 2) = 0.53.
  EXPECT_EQ(thin.regions_in_all, 4u);
  const Rest thick = find_rest(*stock, design, 0.2, {tool(1, "flat:2")});
  ASSERT_EQ(thick.regions_in_all, 1u);
  // Floor and walls: 30 x 20 x 4 less what was cut, but for what is within 0.2 mm of the walls'
  // tops.
  EXPECT_NEAR(thick.volume_mm3, 30 * 20 * 4 - 29.4 * 19.4 * 3.7, 0.2 * 100 * 4 + 5);
  EXPECT_LT(thick.tools[0].takes_mm3, thick.volume_mm3);
  EXPECT_GT(thick.tools[0].takes_mm3, thick.volume_mm3 - 4 * (1 - kPi / 4) * 1 * 4 - 2);
}

TEST(RestMachining, AFinishedPartHasNone) {
  const DesignPart design = pocket_design();
  for (const double cell : {0.1, 0.13, 0.2}) {
    const auto stock = pocketed("zmap", 0.4, 0, cell);
    const Rest rest = find_rest(*stock, design, 0.1, {tool(1, "flat:0.4")});
    EXPECT_EQ(rest.regions_in_all, 0u) << cell;
    EXPECT_EQ(rest.volume_mm3, 0) << cell;
    EXPECT_EQ(std::count(rest.map.cells.begin(), rest.map.cells.end(), RestMap::kDone),
              static_cast<std::ptrdiff_t>(rest.map.cells.size()));
  }
}

TEST(RestMachining, ThroughADesignOnlyWhatStandsIsLeft) {
  Diagnostics diagnostics;
  const DesignPart design(test::box_mesh({10, 10, -10}, {30, 20, -2}), "part.stl", diagnostics);
  const auto stock = block("zmap", 0.2);
  const Rest rest = find_rest(*stock, design, 0.5, {tool(1, "flat:6"), tool(2, "ball:6")});
  ASSERT_EQ(rest.regions_in_all, 1u);
  EXPECT_NEAR(rest.regions[0].volume_mm3, 40 * 30 * 10 - 20 * 10 * 8, 1);
  EXPECT_NEAR(rest.regions[0].by_tool[0].takes_mm3, rest.regions[0].volume_mm3, 1e-3);
  EXPECT_EQ(rest.tools[0].clears, 1u);
  // A ball goes through beside the part.
  EXPECT_NEAR(rest.regions[0].by_tool[1].leaves_mm, 0, 0.05);
}

}  // namespace
}  // namespace kerf
