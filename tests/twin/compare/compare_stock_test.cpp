#include "twin/compare/compare_stock.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <memory>
#include <optional>
#include <random>
#include <vector>

#include "stock/cutter/shape_spec.h"
#include "stock/octree/octree.h"
#include "stock/zmap/mmap/mmap.h"
#include "stock/zmap/zmap.h"
#include "tests/twin/compare/meshes.h"
#include "twin/compare/design_columns.h"
#include "twin/compare/design_file.h"
#include "twin/compare/design_fit.h"
#include "twin/compare/deviation_sums.h"
#include "twin/process/kept_moves.h"

namespace kerf {
namespace {

using test::box_mesh;

const Box kBlank{{0, 0, -10}, {40, 30, 0}};
constexpr double kCell_mm = 0.1;

DesignPart design_of(const TriangleMesh& mesh) {
  Diagnostics diagnostics;
  DesignPart part(mesh, "part.stl", diagnostics);
  EXPECT_TRUE(diagnostics.empty());
  return part;
}

TriangleMesh pocketed(const Vec2& low, const Vec2& high, double floor) {
  return test::pocketed_mesh(kBlank, low, high, floor);
}

/// A workpiece, the moves that cut it, and their labels: a line of the program for each.
struct Cut {
  std::unique_ptr<StockModel> stock;
  KeptMoves kept;
  std::vector<CutLabel> labels;

  void along(const char* tool, const std::vector<Vec3>& path) {
    const Cutter cutter = parse_shape(tool).value();
    std::vector<CutReport> reports;
    for (std::size_t n = 0; n + 1 < path.size(); ++n) {
      CutMove move;
      move.from_mm = path[n];
      move.to_mm = path[n + 1];
      move.id = labels.size();
      labels.push_back({7, {0, static_cast<std::uint32_t>(labels.size() + 1)}});
      kept.add(cutter, std::span(&move, 1));
      stock->cut(cutter, std::span(&move, 1), reports);
    }
    stock->finish(reports);
  }
  Comparison with(const DesignPart& design, double tolerance_mm, bool knows_moves = true) const {
    return compare_stock(*stock, design, {tolerance_mm}, {labels, knows_moves ? &kept : nullptr});
  }
};

Blank blank_of_box() {
  BlankBody body;
  body.bounds_mm = kBlank;
  Blank blank;
  blank.bodies.push_back(body);
  return blank;
}

std::unique_ptr<StockModel> zmap_of(double cell_mm) {
  ZMapOptions options;
  options.blank = blank_of_box();
  options.cell_mm = cell_mm;
  return std::move(ZMap::create(options).value());
}

Cut zmap_cut() {
  Cut cut;
  cut.stock = zmap_of(kCell_mm);
  cut.stock->keep_cut_ids(true);
  return cut;
}

/// The pocket of 20.13 x 6 mm that one way of a cutter leaves, but for its round ends, which are
/// beyond the design's: nothing is gouged there.
TriangleMesh slot_design() { return pocketed({8, 7.03}, {28.13, 13.03}, -4); }
const std::vector<Vec3> kSlot{{11, 10.03, 1}, {11, 10.03, -4}, {25.13, 10.03, -4}};

TEST(DesignColumns, BoxWhoseSidesAndDiagonalsLieOnTheLines) {
  const ColumnGrid grid{{{0, 0, -5}, {4, 4, 5}}, 8, 8};
  const std::vector<float> heights(grid.size(), 1.0f);
  // From middle to middle of cells: 8 lines along X (0.25 .. 3.75), of which those on one of two
  // opposite sides count.
  const DesignPart design = design_of(box_mesh({0.25, 0.25, -2}, {3.75, 3.75, 3}));
  const DesignColumns columns(design, grid, heights);
  double below = 0, above = 0;
  std::size_t met = 0;
  for (std::size_t at = 0; at < grid.size(); ++at) {
    below += static_cast<double>(columns.below_mm(at));
    above += static_cast<double>(columns.above_mm(at));
    met += columns.top_mm(at) == DesignColumns::kNone ? 0 : 1;
  }
  EXPECT_EQ(met, 49u);
  EXPECT_EQ(below, 49 * 3.0);  // from -2 to 1
  EXPECT_EQ(above, 49 * 2.0);  // from 1 to 3
}

TEST(DesignColumns, SphereByItsFormula) {
  const ColumnGrid grid{{{-6, -6, -6}, {6, 6, 6}}, 200, 200};
  const std::vector<float> heights(grid.size(), 2.0f);
  const DesignPart design = design_of(test::sphere_mesh(5, 400));
  const DesignColumns columns(design, grid, heights);
  double below = 0, above = 0;
  for (std::size_t at = 0; at < grid.size(); ++at) {
    below += static_cast<double>(columns.below_mm(at));
    above += static_cast<double>(columns.above_mm(at));
  }
  const double cell2 = 0.06 * 0.06, cap = kPi * 3 * 3 * (3 * 5 - 3) / 3;
  EXPECT_NEAR(above * cell2, cap, 0.003 * cap);
  EXPECT_NEAR(below * cell2, 4.0 / 3 * kPi * 125 - cap, 0.002 * 523);
}

TEST(KeptMoves, LowestIsThatOfManyTips) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> place(0, 10), depth(-5, -1);
  KeptMoves kept;
  std::vector<std::pair<Cutter, CutMove>> moves;
  for (const char* shape : {"flat:2", "ball:3", "bull:4:1", "vee:4:90", "drill:3:118"}) {
    const Cutter cutter = parse_shape(shape).value();
    for (int n = 0; n < 40; ++n) {
      CutMove move;
      move.from_mm = {place(random), place(random), depth(random)};
      move.to_mm = {place(random), place(random), n % 2 == 0 ? move.from_mm.z : depth(random)};
      move.id = moves.size();
      kept.add(cutter, std::span(&move, 1));
      moves.emplace_back(cutter, move);
    }
  }
  ASSERT_TRUE(kept.is_exact());
  for (int n = 0; n < 200; ++n) {
    const Vec2 xy{place(random), place(random)};
    double least = 1e9;
    constexpr int kSteps = 4000;
    for (const auto& [cutter, move] : moves) {
      for (int k = 0; k <= kSteps; ++k) {
        const Vec3 tip = move.from_mm + (move.to_mm - move.from_mm) * (1.0 * k / kSteps);
        const double r = glm::length(xy - Vec2(tip));
        if (r <= cutter.radius_mm()) least = std::min(least, tip.z + cutter.height_mm(r));
      }
    }
    const KeptMoves::Lowest found = kept.lowest(xy);
    if (least > 1e8) {
      EXPECT_FALSE(found.z_mm < 5);
      continue;
    }
    EXPECT_LE(found.z_mm, least + 1e-9);
    EXPECT_GT(found.z_mm, least - 0.01);
    EXPECT_TRUE(kept.cut_by(Vec3(xy, found.z_mm + 1e-6)));
    EXPECT_FALSE(kept.cut_by(Vec3(xy, found.z_mm - 0.001)));
  }
}

TEST(KeptMoves, FarthestGoesOnFromMoveToMove) {
  KeptMoves kept;
  const Cutter cutter = parse_shape("flat:2").value();
  // Discs of 1 mm radius about X2, then X0, then X3.2 along Y0: cut from X-1 to X4.2.
  for (const double x : {2.0, 0.0, 3.2}) {
    CutMove move;
    move.from_mm = {x, 0, 1};
    move.to_mm = {x, 0, -1};
    move.id = static_cast<std::uint64_t>(10 * x);
    kept.add(cutter, std::span(&move, 1));
  }
  const KeptMoves::Near near(kept, {{-2, -1, -2}, {6, 1, 2}});
  const KeptMoves::Far far = near.farthest({0, 0}, {6, 0}, -0.5, 1e-4);
  EXPECT_TRUE(far.is_cut);
  EXPECT_NEAR(6 * far.share, 4.2, 1e-3);
  EXPECT_EQ(far.label, 32u);
  EXPECT_FALSE(near.farthest({5, 0}, {6, 0}, -0.5, 1e-4).is_cut);
  EXPECT_FALSE(near.farthest({0, 0}, {6, 0}, -1.5, 1e-4).is_cut);
  const std::optional<KeptMoves::Pass> pass = kept.nearest_pass({5, 0, 0});
  ASSERT_TRUE(pass);
  EXPECT_EQ(pass->label, 32u);
  EXPECT_NEAR(pass->distance_mm, 0.8, 1e-9);
}

TEST(DeviationSums, PlacesApartAreRegionsOfTheirOwn) {
  DeviationSums sums(0.05, 0.1);
  sums.add({{1, 1, 0}, -0.2, 2, 0.5, 3});
  sums.add({{1.2, 1, 0}, -0.3, 2, 0.25, 4});
  sums.add({{9, 1, 0}, -0.4, 2, 1, 5});
  sums.add({{1, 1, 0}, 0.06, 2, 0.1, 6});
  sums.add({{4, 4, 0}, 0.05, 8, 0.1, 6});
  const std::vector<FoundRegion> regions = sums.regions();
  ASSERT_EQ(regions.size(), 3u);
  EXPECT_TRUE(regions[0].is_gouge && regions[1].is_gouge && !regions[2].is_gouge);
  EXPECT_EQ(regions[0].worst_mm, 0.4);
  EXPECT_EQ(regions[1].worst_mm, 0.3);
  EXPECT_EQ(regions[1].cut_by, 4u);
  EXPECT_EQ(regions[1].area_mm2, 4);
  EXPECT_EQ(regions[1].volume_mm3, 0.75);
  EXPECT_EQ(regions[1].box_mm.min.x, 1);
  EXPECT_EQ(regions[1].box_mm.max.x, 1.2);
  EXPECT_EQ(sums.volume_mm3(true), 1.75);
  EXPECT_EQ(sums.area_mm2(), 16);
  EXPECT_EQ(sums.within_mm2(), 8);
  double binned = 0;
  for (const DeviationBin& bin : sums.histogram()) binned += bin.area_mm2;
  EXPECT_EQ(binned, 16);
}

TEST(CompareStock, SlotAsDesignedHasNoGouge) {
  Cut cut = zmap_cut();
  cut.along("flat:6", kSlot);
  const DesignPart design = design_of(slot_design());
  const Comparison c = cut.with(design, 0.01);
  EXPECT_EQ(c.gouges, 0u);
  EXPECT_EQ(c.gouge_mm3, 0);
  EXPECT_EQ(c.walls_mm, 0);
  // What is left over are the four corners: a square of 3 mm less a quarter of a circle, each.
  EXPECT_EQ(c.verdict, CompareVerdict::kExcessLeft);
  EXPECT_EQ(c.excesses, 4u);
  const double corners = 4 * (1 - kPi / 4) * 9 * 4;
  EXPECT_NEAR(c.excess_mm3, corners, 0.02 * corners);
  EXPECT_NEAR(c.excess.mm, 3 * (1 - std::sqrt(0.5)), 0.02);
  EXPECT_LT(c.bound_mm, kCell_mm / 10);
}

TEST(CompareStock, FloorGougeByItsDepthVolumeAndLine) {
  Cut cut = zmap_cut();
  cut.along("flat:6", kSlot);
  cut.along("flat:2", {{15, 10, -4}, {15, 10, -4.3}, {18, 10, -4.3}});
  const Comparison c = cut.with(design_of(slot_design()), 0.01);
  EXPECT_EQ(c.verdict, CompareVerdict::kGouged);
  ASSERT_EQ(c.gouges, 1u);
  EXPECT_NEAR(c.gouge.mm, 0.3, 1e-4);
  EXPECT_NEAR(c.gouge_mm3, 0.3 * (kPi + 3 * 2), 0.3 * 0.1);
  EXPECT_TRUE(c.gouge.by.source.line == 3 || c.gouge.by.source.line == 4);
  EXPECT_EQ(c.gouge.by.tool, 7);
  ASSERT_FALSE(c.regions.empty());
  const DeviationRegion& region = c.regions.front();
  EXPECT_NEAR(region.box_mm.min.x, 14, kCell_mm);
  EXPECT_NEAR(region.box_mm.max.x, 19, kCell_mm);
  EXPECT_NEAR(region.box_mm.min.z, -4.3, 1e-4);
}

/// 0.03 mm: less than a third of a cell. Only the moves know where the wall stands.
TEST(CompareStock, WallGougeFinerThanACellByTheMoves) {
  for (const double gouge : {0.0, 0.03, 0.26}) {
    Cut cut = zmap_cut();
    cut.along("flat:6", {{11, 10.03, 1}, {11, 10.03, -4}, {25.13 + gouge, 10.03, -4}});
    const DesignPart design = design_of(slot_design());
    const Comparison c = cut.with(design, 0.01);
    EXPECT_NEAR(c.gouge.mm, gouge, 0.0005) << gouge;
    EXPECT_EQ(c.gouges, gouge > 0 ? 1u : 0u);
    EXPECT_EQ(c.gouge.by.source.line, gouge > 0 ? 2u : 0u);
    // By the cells alone what is told is sure, and so less.
    const Comparison by_cells = cut.with(design, 0.01, false);
    EXPECT_LE(by_cells.gouge.mm, gouge + 1e-3);
    EXPECT_GE(by_cells.gouge.mm, gouge - 1.5 * kCell_mm);
    EXPECT_EQ(by_cells.walls_mm, kCell_mm / 2);
  }
}

TEST(CompareStock, UncutPocketIsExcessNearItsPass) {
  Cut cut = zmap_cut();
  cut.along("flat:4", {{35, 25, 1}, {35, 25, 0.5}, {20, 25, 0.5}});
  const Comparison c = cut.with(design_of(slot_design()), 0.05);
  EXPECT_EQ(c.gouges, 0u);
  ASSERT_EQ(c.excesses, 1u);
  EXPECT_NEAR(c.excess_mm3, 20.03 * 5.9 * 4, 2);  // what is beyond the tolerance
  EXPECT_NEAR(c.excess.mm, 3, 0.06);              // half of its width
  EXPECT_GT(c.excess.pass_distance_mm, 5);
  EXPECT_EQ(c.excess.by.tool, 7);
  EXPECT_LT(c.within_percent(), 100);
}

/// A point of 0.05 mm, narrower than a cell, between the middles of four.
TEST(CompareStock, PointBetweenTheCells) {
  Cut cut = zmap_cut();
  cut.along("vee:4:60", {{20, 20, 1}, {20, 20, -0.05}, {20, 20, 1}});
  const Comparison c = cut.with(design_of(box_mesh(kBlank.min, kBlank.max)), 0.01);
  ASSERT_EQ(c.gouges, 1u);
  EXPECT_NEAR(c.gouge.mm, 0.05, 1e-3);
  EXPECT_NEAR(c.gouge.at_mm.x, 20, 0.01);
  EXPECT_EQ(c.gouge.by.source.line, 1u);
}

/// What no surface of the workpiece tells: a hollow of the design that heights cannot have.
TEST(CompareStock, HollowThatIsNotCutIsExcess) {
  TriangleMesh mesh = box_mesh(kBlank.min, kBlank.max);
  TriangleMesh hollow = box_mesh({10, 10, -6}, {20, 20, -4});
  for (auto& t : hollow.triangles) std::swap(t[1], t[2]);
  const auto first = static_cast<std::uint32_t>(mesh.positions_mm.size());
  for (const auto& p : hollow.positions_mm) mesh.positions_mm.push_back(p);
  for (const auto& t : hollow.triangles)
    mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  const Comparison c = zmap_cut().with(design_of(mesh), 0.05);
  EXPECT_EQ(c.verdict, CompareVerdict::kExcessLeft);
  EXPECT_NEAR(c.excess_mm3, 9.9 * 9.9 * 2, 1);
  EXPECT_NEAR(c.excess.mm, 1, 0.06);
}

TEST(CompareStock, RoofThatIsGoneIsGouge) {
  Cut cut = zmap_cut();
  cut.along("flat:10", {{5, 15, 1}, {5, 15, -8}, {15, 15, -8}});
  // The design has a tunnel there with a roof of 2 mm over it, from X0 to X10.
  TriangleMesh mesh = box_mesh(kBlank.min, kBlank.max);
  TriangleMesh hollow = box_mesh({2, 11, -8}, {18, 19, -2});
  for (auto& t : hollow.triangles) std::swap(t[1], t[2]);
  const auto first = static_cast<std::uint32_t>(mesh.positions_mm.size());
  for (const auto& p : hollow.positions_mm) mesh.positions_mm.push_back(p);
  for (const auto& t : hollow.triangles)
    mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  const Comparison c = cut.with(design_of(mesh), 0.05);
  EXPECT_EQ(c.verdict, CompareVerdict::kGouged);
  EXPECT_GT(c.gouge.mm, 0.9);
  EXPECT_GT(c.gouge_mm3, 2 * 8 * 10);
}

/// Every cell's middle, against all triangles one by one.
TEST(CompareStock, WorstPlaceIsThatOfBruteForce) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> x(4, 36), y(4, 26), z(-4, -1);
  for (int round = 0; round < 3; ++round) {
    Cut cut = zmap_cut();
    for (int n = 0; n < 12; ++n)
      cut.along("ball:5", {{x(random), y(random), z(random)}, {x(random), y(random), z(random)}});
    // Turned and lifted, so that no triangle lies along the grid.
    TriangleMesh mesh = test::sphere_mesh(17, 60);
    for (glm::vec3& p : mesh.positions_mm)
      p = glm::vec3(p.x * 1.1f + 0.1f * p.y + 20, p.y * 0.8f + 15, p.z * 0.5f - 9.3f);
    const DesignPart design = design_of(mesh);
    const Comparison c = cut.with(design, 0.05, false);
    const std::shared_ptr<const HeightGrid> grid = cut.stock->height_grid();
    double gouge = 0, excess = 0;
    for (int j = 0; j < grid->ny(); j += 1) {
      for (int i = 0; i < grid->nx(); i += 1) {
        const Vec3 p((i + 0.5) * kCell_mm, (j + 0.5) * kCell_mm,
                     static_cast<double>(grid->height(i, j)));
        double nearest = 1e9;
        if (i % 7 == 0 && j % 5 == 0) {
          for (std::uint32_t t = 0; t < design.size(); ++t)
            nearest = std::min(nearest, nearest_on_triangle(design.corners(t), p).distance2_mm2);
          EXPECT_NEAR(std::abs(design.distance_mm(p)), std::sqrt(nearest), 1e-9);
        }
        const double d = design.distance_mm(p);
        gouge = std::max(gouge, -d);
        excess = std::max(excess, d);
      }
    }
    EXPECT_GT(gouge, 0.5);
    EXPECT_NEAR(c.gouge.mm, gouge, 1e-6) << round;
    EXPECT_GE(c.excess.mm, excess - 1e-6);
  }
}

TEST(CompareStock, OctreeAndMMapTellTheSame) {
  for (const bool is_octree : {true, false}) {
    for (const double gouge : {0.0, 0.2}) {
      Cut cut;
      if (is_octree) {
        OctreeOptions options;
        options.blank = blank_of_box();
        options.cell_mm = 0.2;
        cut.stock = std::move(Octree::create(options).value());
      } else {
        ZMapOptions options;
        options.blank = blank_of_box();
        options.cell_mm = 0.2;
        cut.stock = std::move(MMap::create(options).value());
      }
      cut.stock->keep_cut_ids(true);
      if (!is_octree) cut.along("tslot:8:2:4", {{35, 38, -6}, {35, 25, -6}});  // now it has gaps
      cut.along("flat:6", kSlot);
      cut.along("flat:2", {{15, 10, -4}, {15, 10, -4 - gouge}, {18, 10, -4 - gouge}});
      const Comparison c = cut.with(design_of(slot_design()), 0.04);
      if (is_octree) {
        EXPECT_EQ(c.gouges, gouge > 0 ? 1u : 0u);
        EXPECT_NEAR(c.gouge.mm, gouge, 0.02);
        EXPECT_NEAR(c.gouge_mm3, gouge * (kPi + 6), 0.05 * 9);
      } else {
        // The slot under the lip is a gouge, too: its side is 5 mm below the top, less the doubt.
        EXPECT_EQ(c.gouges, gouge > 0 ? 2u : 1u);
        EXPECT_NEAR(c.gouge.mm, 5 - 0.2 * std::sqrt(0.5), 0.01);
      }
    }
  }
}

/// Around an island of 8.13 x 3.98 mm, from whose sides the tool's stay 3 mm.
const std::vector<Vec3> kRing{{11, 10.03, 1},     {11, 10.03, -4}, {25.13, 10.03, -4},
                              {25.13, 20.01, -4}, {11, 20.01, -4}, {11, 10.03, -4}};

TEST(CompareStock, OurOwnMeshesAreGoodAsDesigns) {
  // Cells of the design lie elsewhere than those of the part.
  Cut design;
  design.stock = zmap_of(0.13);
  design.along("flat:6", kRing);
  const DesignPart made = design_of(design.stock->mesh(0.001));
  for (const bool is_wide : {false, true}) {
    Cut cut = zmap_cut();
    cut.along(is_wide ? "flat:6.04" : "flat:6", kRing);
    const Comparison c = cut.with(made, 0.01);
    EXPECT_EQ(c.gouges, is_wide ? 2u : 0u);  // the outer side, the island's
    EXPECT_EQ(c.excesses, 0u);
    EXPECT_NEAR(c.gouge.mm, is_wide ? 0.02 : 0, 0.003);
  }
}

TEST(DesignFit, FindsBackWhatWasMovedAndTurned) {
  Cut cut = zmap_cut();
  cut.along("flat:6", {{11, 10.03, 1}, {11, 10.03, -4}, {25.13, 10.03, -4}, {25.13, 20, -4}});
  cut.along("ball:6", {{33, 8, -3}, {33, 22, -2}});
  cut.along("flat:4", {{6, 25, -2}, {12, 26, -2}});
  const TriangleMesh own = cut.stock->mesh(0.001);
  // The design: the same part elsewhere, so that this brings it back.
  const DesignPlacement moved{{1.3, -0.8, 0.6}, {1, -2, 4}};
  TriangleMesh mesh = own;
  for (glm::vec3& p : mesh.positions_mm) p = glm::vec3(moved.placed(Vec3(p)));
  // A gouge that must not pull.
  cut.along("flat:3", {{18, 10, -4}, {18, 10, -5}, {20, 10, -5}});
  const std::vector<FitPoint> points = fit_points(*cut.stock, 5000);
  EXPECT_NEAR(static_cast<double>(points.size()), 5000, 2);
  const std::optional<DesignFit> fit =
      fit_design_in_blank(design_of(mesh), kBlank, points, DesignPlacement{});
  ASSERT_TRUE(fit);
  EXPECT_LT(fit->residue_mm, 0.03);
  double worst = 0;
  for (const Vec3& corner : {Vec3(0, 0, -10), Vec3(40, 30, 0), Vec3(40, 0, -10), Vec3(0, 30, 0)})
    worst = std::max(worst, glm::distance(fit->placement.placed(moved.placed(corner)), corner));
  EXPECT_LT(worst, 0.05);
}

TEST(DesignFit, FindsWhatLiesOnAnotherSide) {
  Cut cut = zmap_cut();
  cut.along("flat:6", {{11, 10.03, 1}, {11, 10.03, -4}, {25.13, 10.03, -4}, {25.13, 20, -4}});
  cut.along("flat:4", {{6, 25, -2}, {12, 26, -2}});
  const TriangleMesh own = cut.stock->mesh(0.001);
  const std::vector<FitPoint> points = fit_points(*cut.stock, 3000);
  // As CAD programs have it: Y up, or turned round, its zero elsewhere.
  for (const DesignPlacement& moved :
       {DesignPlacement{{3, 40, 7}, {90, 0, 0}}, DesignPlacement{{-5, 2, 0}, {0, 0, 90}},
        DesignPlacement{{0, 0, 30}, {180, 0, 90}}, DesignPlacement{{1, 2, 3}, {0, 90, 180}}}) {
    TriangleMesh mesh = own;
    for (glm::vec3& p : mesh.positions_mm) p = glm::vec3(moved.placed(Vec3(p)));
    const std::optional<DesignFit> fit =
        fit_design_in_blank(design_of(mesh), kBlank, points, DesignPlacement{});
    ASSERT_TRUE(fit);
    double worst = 0;
    for (const Vec3& corner : {Vec3(0, 0, -10), Vec3(40, 30, 0), Vec3(40, 0, -10), Vec3(0, 30, 0)})
      worst = std::max(worst, glm::distance(fit->placement.placed(moved.placed(corner)), corner));
    EXPECT_LT(worst, 0.05) << moved.text();
  }
}

TEST(DesignFit, WhatNothingHoldsStaysWhereItWas) {
  Cut cut = zmap_cut();
  cut.along("flat:10", {{-5, 15, -4}, {45, 15, -4}});
  const DesignPart design = design_of(cut.stock->mesh(0.001));
  const std::optional<DesignFit> fit =
      fit_design(design, fit_points(*cut.stock, 3000), {{0.4, 0.3, 0.2}, {0, 0, 0}});
  ASSERT_TRUE(fit);
  EXPECT_NEAR(fit->placement.shift_mm.x, 0.4, 0.05);
  EXPECT_NEAR(fit->placement.shift_mm.y, 0, 0.01);
  EXPECT_NEAR(fit->placement.shift_mm.z, 0, 0.01);
}

TEST(DesignPlacement, TurnsThenShifts) {
  const DesignPlacement placement{{10, 0, -5}, {0, 0, 90}};
  EXPECT_LT(glm::distance(placement.placed({1, 2, 3}), Vec3(8, 1, -2)), 1e-12);
  EXPECT_EQ(placement.text(), "turned by 0, 0, 90 degrees about X, Y, Z, shifted by X10 Y0 Z-5 mm");
  EXPECT_EQ((DesignPlacement{}.text()), "");
  // About X first.
  EXPECT_LT(glm::distance(DesignPlacement{{}, {90, 0, 90}}.placed({0, 1, 0}), Vec3(0, 0, 1)),
            1e-12);
}

TEST(DesignFile, DoubtsAboutItsPlace) {
  const auto said = [](const Box& part) {
    Diagnostics diagnostics;
    doubt_place(design_of(box_mesh(part.min, part.max)), "part.stl", kBlank, 0.05, diagnostics);
    EXPECT_LE(diagnostics.size(), 1u);
    return diagnostics.empty() ? std::string()
                               : diagnostics[0].message + " | " + diagnostics[0].hint;
  };
  EXPECT_EQ(said(kBlank), "");
  EXPECT_EQ(said({{-20, 0, -10}, {10, 20, 0}}),
            "lies partly outside the blank: X-20..10 Y0..20 Z-10..0 mm; the blank is X0..40 Y0..30 "
            "Z-10..0 mm | --compare-at 20,0,0 puts it inside");
  EXPECT_EQ(said({{50, 0, -10}, {80, 20, 0}}).substr(0, 21), "lies beside the blank");
  EXPECT_EQ(said({{0, 0, -0.4}, {1.5, 1, 0}}).substr(0, 38),
            "is so small that its unit may be the i");
  EXPECT_EQ(said({{0, 0, 0}, {1000, 700, 250}}).substr(0, 30), "is so large that its numbers m");
  EXPECT_EQ(said({{0, 0, -10}, {45, 20, 0}}).substr(0, 25), "is larger than the blank:");
}

}  // namespace
}  // namespace kerf
