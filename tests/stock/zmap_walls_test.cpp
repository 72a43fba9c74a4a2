// Walls within a cell: where a Z-map has them, in its mesh and its file, against closed forms and
// brute force.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <functional>
#include <glm/geometric.hpp>
#include <iterator>
#include <random>
#include <string>

#include "stock/zmap/state_file.h"
#include "tests/base/temporary_folder.h"
#include "tests/stock/stock_samples.h"
#include "tests/stock/wall_mesh_samples.h"

namespace kerf {
namespace {

using test::enclosed_mm3;
using test::is_closed;
using test::line;
using test::make_map;
using test::tool;
using test::wall_points;
using test::WallPoint;

constexpr double kCell_mm = 0.1;
/// What is promised of walls: a fiftieth of a cell.
constexpr double kPromise_mm = kCell_mm / 50;

void cut(ZMap& map, const Cutter& cutter, const std::vector<CutMove>& moves) {
  std::vector<CutReport> reports;
  map.cut(cutter, moves, reports);
  map.finish(reports);
}

CutMove circle(const Vec3& start, const Vec3& center, double turn_rad = 2 * kPi) {
  CutMove move = line(start, start);
  move.arc = CutArc{center, Vec3(0, 0, turn_rad > 0 ? 1 : -1), std::abs(turn_rad)};
  return move;
}

/// How far from the way between a and b.
double segment_distance(const Vec2& p, const Vec2& a, const Vec2& b) {
  const Vec2 way = b - a;
  const double t = std::clamp(glm::dot(p - a, way) / glm::dot(way, way), 0.0, 1.0);
  return glm::distance(p, a + t * way);
}

struct Deviation {
  double most_mm = 0;
  int points = 0;
};

/// Of the mesh's walls from where they should be; both meshes, which must be closed.
Deviation deviation(const ZMap& map, const std::function<double(const WallPoint&)>& distance_mm) {
  Deviation out;
  for (const double tolerance : {0.0, 0.01}) {
    const TriangleMesh mesh = map.mesh(tolerance);
    EXPECT_TRUE(is_closed(mesh)) << "tolerance " << tolerance;
    for (const WallPoint& p : wall_points(mesh, map.bounds_mm())) {
      ++out.points;
      out.most_mm = std::max(out.most_mm, std::abs(distance_mm(p)));
    }
  }
  return out;
}

/// What is gone of a box, by the mesh of all cells.
double gone_mm3(const ZMap& map) { return map.blank_mm3() - enclosed_mm3(map.mesh(0)); }

/// Heights and walls, as they are saved.
std::string contents(const StockModel& map) {
  const TemporaryFolder folder;
  const std::string path = folder.path() + "/part.state";
  EXPECT_TRUE(map.save(path));
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// How far a chord within a cell is from a circle's arc.
double sagitta_mm(double radius_mm) { return kCell_mm * kCell_mm / (4 * radius_mm); }

TEST(ZMapWalls, ASlotHasItsWidthWhereverItLies) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> place(6, 14), turn(0, 2 * kPi);
  for (int round = 0; round < 24; ++round) {
    const auto map = make_map("box:0,0,-5:20,20,0", kCell_mm);
    const double x = place(random);
    const double y = place(random);
    // The first ones along the lines of cells.
    const double angle = round < 4 ? round * kPi / 2 : turn(random);
    const Vec2 a(x, y), b = a + 3.0 * Vec2(std::cos(angle), std::sin(angle));
    cut(*map, tool("flat:4"), {line(Vec3(a, -2), Vec3(b, -2))});
    const Deviation d =
        deviation(*map, [&](const WallPoint& p) { return segment_distance(Vec2(p.at), a, b) - 2; });
    EXPECT_GT(d.points, 500);
    EXPECT_LT(d.most_mm, kPromise_mm + sagitta_mm(2)) << "round " << round;
    EXPECT_NEAR(gone_mm3(*map), 2 * (4 * kPi + 12), 0.02) << "round " << round;
  }
}

TEST(ZMapWalls, ARoundPocketAndItsIslandAreRound) {
  const auto map = make_map("box:0,0,-5:20,20,0", kCell_mm);
  const Vec2 center(10.013, 9.961);
  // Off the lines of cells; the island has a radius of 1.5, the pocket of 7.5.
  cut(*map, tool("flat:6"), {circle(Vec3(center + Vec2(4.5, 0), -3), Vec3(center, -3))});
  const Deviation d = deviation(*map, [&](const WallPoint& p) {
    const double r = glm::distance(Vec2(p.at), center);
    return std::min(std::abs(r - 1.5), std::abs(r - 7.5));
  });
  EXPECT_GT(d.points, 2000);
  EXPECT_LT(d.most_mm, kPromise_mm + sagitta_mm(1.5));
  EXPECT_NEAR(gone_mm3(*map), 3 * kPi * (7.5 * 7.5 - 1.5 * 1.5), 0.04);
}

TEST(ZMapWalls, HalfAnArcEndsWithTheToolsOwnSide) {
  const auto map = make_map("box:0,0,-5:20,20,0", kCell_mm);
  const Vec3 center(10.037, 8.021, -3);
  CutMove half = circle(center + Vec3(5, 0, 0), center, kPi);
  half.to_mm = center - Vec3(5, 0, 0);
  cut(*map, tool("flat:2"), {half});
  const Deviation d = deviation(*map, [&](const WallPoint& p) {
    const Vec2 at = Vec2(p.at) - Vec2(center);
    if (at.y >= 0) return std::abs(glm::length(at) - 5) - 1;
    return glm::length(at - Vec2(at.x > 0 ? 5 : -5, 0)) - 1;
  });
  EXPECT_GT(d.points, 1000);
  EXPECT_LT(d.most_mm, kPromise_mm + sagitta_mm(1));
  EXPECT_NEAR(gone_mm3(*map), 3 * (5 * kPi * 2 + kPi), 0.04);
}

TEST(ZMapWalls, AnIslandsCornersAreSharp) {
  const auto map = make_map("box:0,0,-5:20,20,0", kCell_mm);
  // Around 8 x 6 mm whose sides lie between middles of cells; the tool leaves the corners sharp.
  const Vec2 low(6.013, 7.037), high(14.021, 13.044);
  const double r = 2;
  const Vec3 a(low.x - r, low.y - r, -2), b(high.x + r, low.y - r, -2),
      c(high.x + r, high.y + r, -2), d(low.x - r, high.y + r, -2);
  cut(*map, tool("flat:4"), {line(a, b), line(b, c), line(c, d), line(d, a)});
  const TriangleMesh mesh = map->mesh(0.01);
  EXPECT_TRUE(is_closed(mesh));
  const double size_x = high.x - low.x, size_y = high.y - low.y;
  double corner_mm = 1, side_mm = 0;
  for (const WallPoint& p : wall_points(mesh, map->bounds_mm())) {
    const Vec2 at = Vec2(p.at) - 0.5 * (low + high);
    const Vec2 out(std::abs(at.x) - 0.5 * size_x, std::abs(at.y) - 0.5 * size_y);
    if (std::max(out.x, out.y) > 1) continue;  // the slot's outer side
    side_mm = std::max(side_mm, std::abs(std::max(out.x, out.y)));
    corner_mm = std::min(corner_mm, glm::length(out));
  }
  EXPECT_LT(side_mm, kPromise_mm);
  EXPECT_LT(corner_mm, 2 * kPromise_mm);
}

TEST(ZMapWalls, AStepOfAPocketStandsAboveItsFloor) {
  const auto map = make_map("box:0,0,-5:20,20,0", kCell_mm);
  const Vec2 a(6.03, 7.01), b(13.07, 9.04);
  cut(*map, tool("flat:3"), {line(Vec3(a, -4), Vec3(b, -4))});
  cut(*map, tool("flat:6"), {line(Vec3(a, -1.5), Vec3(b, -1.5))});
  const Deviation d = deviation(*map, [&](const WallPoint& p) {
    const double off = segment_distance(Vec2(p.at), a, b);
    // Below -1.5 the narrow slot, above it the wide one.
    if (p.at.z < -1.501) return off - 1.5;
    if (p.at.z > -1.499) return off - 3;
    return std::min(std::abs(off - 1.5), std::abs(off - 3));
  });
  EXPECT_LT(d.most_mm, kPromise_mm + sagitta_mm(1.5));
  const double length = glm::distance(a, b);
  const double removed = 1.5 * (9 * kPi + 6 * length) + 2.5 * (2.25 * kPi + 3 * length);
  EXPECT_NEAR(gone_mm3(*map), removed, 0.04);
}

TEST(ZMapWalls, ABallDeeperThanItsRadiusLeavesWallsAboveItsEquator) {
  const auto map = make_map("box:0,0,-8:20,20,0", kCell_mm);
  const Vec2 a(6.03, 7.01), b(13.07, 9.04);
  cut(*map, tool("ball:4"), {line(Vec3(a, -6), Vec3(b, -6))});
  int walls = 0;
  const Deviation d = deviation(*map, [&](const WallPoint& p) {
    ++walls;
    // The mesh's own triangles below the equator are steep, not upright.
    return p.at.z < -3.999 ? 0 : segment_distance(Vec2(p.at), a, b) - 2;
  });
  EXPECT_GT(walls, 500);
  EXPECT_LT(d.most_mm, kPromise_mm + sagitta_mm(2));
  // A ball whose equator stays above the blank leaves none.
  const auto shallow = make_map("box:0,0,-8:20,20,0", kCell_mm);
  cut(*shallow, tool("ball:4"), {line(Vec3(a, -2), Vec3(b, -2))});
  EXPECT_TRUE(wall_points(shallow->mesh(0), shallow->bounds_mm()).empty());
}

TEST(ZMapWalls, TheFarthestOfSeveralPassesMakesTheWall) {
  const auto map = make_map("box:0,0,-5:20,20,0", kCell_mm);
  const auto pass = [](double y, double z) { return line(Vec3(5, y, z), Vec3(15, y, z)); };
  // All within one cell: roughed by levels, finished in one go, and once more for nothing. The
  // finisher stays a little above the floor.
  const std::vector<CutMove> moves{pass(10.01, -1),   pass(10.012, -2), pass(10.011, -3),
                                   pass(10.03, -2.9), pass(10.02, -3),  pass(10.01, -1)};
  cut(*map, tool("flat:4"), moves);
  for (const WallPoint& p : wall_points(map->mesh(0), map->bounds_mm())) {
    if (p.outward.y > -0.999) continue;  // the wall towards high y
    EXPECT_NEAR(p.at.y, 12.03, kPromise_mm);
    if (HasFailure()) break;
  }
}

TEST(ZMapWalls, AWallThatIsCutAwayIsGone) {
  const auto map = make_map("box:0,0,-5:20,20,0", kCell_mm);
  cut(*map, tool("flat:4"), {line(Vec3(5, 10.03, -2), Vec3(15, 10.03, -2))});
  EXPECT_FALSE(wall_points(map->mesh(0), map->bounds_mm()).empty());
  // Faced all over, a little deeper.
  cut(*map, tool("flat:40"), {line(Vec3(-30, 10, -2.1), Vec3(50, 10, -2.1))});
  EXPECT_TRUE(wall_points(map->mesh(0), map->bounds_mm()).empty());
  EXPECT_NEAR(gone_mm3(*map), 400 * 2.1, 0.01);
  const auto faced = make_map("box:0,0,-5:20,20,0", kCell_mm);
  cut(*faced, tool("flat:40"), {line(Vec3(-30, 10, -2.1), Vec3(50, 10, -2.1))});
  EXPECT_EQ(contents(*map), contents(*faced));
}

TEST(ZMapWalls, ASlotRunsOutOfTheBlankAsItCame) {
  const auto map = make_map("box:0,0,-5:20,20,0", kCell_mm);
  const Vec2 a(4.03, -3), b(15.07, 23.04);
  cut(*map, tool("flat:4"), {line(Vec3(a, -2), Vec3(b, -2))});
  // In the outermost half cell a wall may have to end beside its place by less than that.
  double border_mm = 0;
  const Deviation d = deviation(*map, [&](const WallPoint& p) {
    const double off = segment_distance(Vec2(p.at), a, b) - 2;
    if (p.at.y > 0.051 && p.at.y < 19.949) return off;
    border_mm = std::max(border_mm, std::abs(off));
    return 0.0;
  });
  EXPECT_LT(d.most_mm, kPromise_mm);
  EXPECT_LT(border_mm, kCell_mm / 4);
  // A parallelogram of 4 mm across the way.
  const double across = 4 * glm::distance(a, b) / (b.y - a.y);
  EXPECT_NEAR(gone_mm3(*map), 2 * 20 * across, 0.02);
}

TEST(ZMapWalls, ARoundBlankAndABoreAreRound) {
  const auto disc = make_map("cylinder:10.02,9.97,-4:0:15", kCell_mm);
  // Beyond the outermost middles, half a cell from where the box touches the disc, its side runs
  // straight out: at each of the four places a third of 2 sqrt(2 x 7.5 x 0.05) x 0.05 mm2 too much.
  const double beyond = 4 * 4 * 2 * std::sqrt(2 * 7.5 * 0.05) * 0.05 / 3;
  EXPECT_NEAR(enclosed_mm3(disc->mesh(0)), 4 * kPi * 56.25 + beyond, 0.05);
  const Vec2 center(10.02, 9.97);
  const Box inner{disc->bounds_mm().min + 0.051, disc->bounds_mm().max - 0.051};
  cut(*disc, tool("flat:4"), {line(Vec3(center, 5), Vec3(center, -4))});
  const Deviation d = deviation(*disc, [&](const WallPoint& p) {
    const double r = glm::distance(Vec2(p.at), center);
    if (p.at.x < inner.min.x || p.at.y < inner.min.y || p.at.x > inner.max.x ||
        p.at.y > inner.max.y)
      return 0.0;
    return std::min(std::abs(r - 2), std::abs(r - 7.5));
  });
  EXPECT_LT(d.most_mm, kPromise_mm + sagitta_mm(2));
  EXPECT_NEAR(enclosed_mm3(disc->mesh(0)), 4 * kPi * (56.25 - 4) + beyond, 0.05);
}

/// Level moves of flat tools at any place, of which brute force knows where the air is.
struct LevelCut {
  double radius = 0;
  CutMove move;
  /// Below 0 where it covers.
  double side_distance(const Vec2& p) const {
    if (!move.arc) return segment_distance(p, Vec2(move.from_mm), Vec2(move.to_mm)) - radius;
    const Vec2 center(move.arc->center_mm);
    const double path = glm::distance(Vec2(move.from_mm), center);
    return std::abs(glm::distance(p, center) - path) - radius;
  }
  bool covers(const Vec3& p) const { return p.z >= move.from_mm.z && side_distance(Vec2(p)) <= 0; }
};

std::vector<LevelCut> level_cuts(std::mt19937& random, int count) {
  std::uniform_real_distribution<double> place(2, 18), depth(-4, -1), turn(0, 2 * kPi);
  std::vector<LevelCut> out;
  for (int n = 0; n < count; ++n) {
    LevelCut cut{n % 3 == 0 ? 1.5 : n % 3 == 1 ? 2.0 : 0.8, {}};
    const double x = place(random);
    const double y = place(random);
    const double z = depth(random);
    const double angle = turn(random);
    const Vec3 from(x, y, z), way(std::cos(angle), std::sin(angle), 0);
    cut.move = n % 4 == 3 ? circle(from + 2.7 * way, from) : line(from, from + 4.0 * way);
    out.push_back(cut);
  }
  return out;
}

std::unique_ptr<ZMap> cut_map(const std::vector<LevelCut>& cuts, int threads = 1) {
  auto map = make_map("box:0,0,-5:20,20,0", kCell_mm, threads);
  for (const LevelCut& one : cuts)
    cut(*map,
        tool(one.radius == 1.5   ? "flat:3"
             : one.radius == 2.0 ? "flat:4"
                                 : "flat:1.6"),
        {one.move});
  return map;
}

TEST(ZMapWalls, RandomPocketsAreAsBruteForceHasThem) {
  std::vector<double> alone, meeting;  // meeting: another side is within 2.5 cells
  for (unsigned seed = 1; seed <= 6; ++seed) {
    std::mt19937 random(seed);
    const std::vector<LevelCut> cuts = level_cuts(random, 12);
    const auto map = cut_map(cuts);
    const TriangleMesh mesh = map->mesh(0.01);
    EXPECT_TRUE(is_closed(mesh)) << "seed " << seed;
    const auto is_air = [&](const Vec3& p) {
      return std::any_of(cuts.begin(), cuts.end(), [&](const LevelCut& c) { return c.covers(p); });
    };
    const std::vector<WallPoint> points = wall_points(mesh, map->bounds_mm());
    for (std::size_t n = 3; n < points.size(); n += 4) {  // middles of triangles
      const Vec3 at = points[n].at, outward(points[n].outward, 0);
      // Beyond the outermost middles walls run on as they came.
      if (std::max(std::abs(at.x - 10), std::abs(at.y - 10)) > 9.949) continue;
      double nearest = kCell_mm;
      constexpr int kSteps = 200;
      for (int step = -kSteps; step < kSteps; ++step) {
        const double from = kCell_mm * step / kSteps, to = kCell_mm * (step + 1) / kSteps;
        if (!is_air(at + from * outward) && is_air(at + to * outward))
          nearest = std::min(nearest, std::abs(0.5 * (from + to)));
      }
      const auto near = std::count_if(cuts.begin(), cuts.end(), [&](const LevelCut& c) {
        return std::abs(c.side_distance(Vec2(at))) < 2.5 * kCell_mm;
      });
      (near > 1 ? meeting : alone).push_back(nearest);
    }
    // The volume by columns that are a tenth of a cell wide.
    double sum = 0;
    constexpr int kColumns = 800;
    for (int j = 0; j < kColumns; ++j) {
      for (int i = 0; i < kColumns; ++i) {
        const Vec2 xy(20.0 * (i + 0.5) / kColumns, 20.0 * (j + 0.5) / kColumns);
        double z = 0;
        for (const LevelCut& c : cuts)
          if (c.move.from_mm.z < z && c.covers(Vec3(xy, c.move.from_mm.z))) z = c.move.from_mm.z;
        sum -= z;
      }
    }
    const double removed = sum * 400.0 / (kColumns * kColumns);
    EXPECT_NEAR(gone_mm3(*map), removed, 1e-4 * removed + 0.02) << "seed " << seed;
  }
  const auto tell = [](const char* what, std::vector<double>& off) {
    std::sort(off.begin(), off.end());
    const auto part = [&](double p) {
      return off[static_cast<std::size_t>(p * static_cast<double>(off.size() - 1))];
    };
    std::printf("%s: %zu places, off by %.5f (median), %.5f (99 %%), %.5f mm (most)\n", what,
                off.size(), part(0.5), part(0.99), off.back());
    return off.back();
  };
  EXPECT_LT(tell("walls", alone), kPromise_mm + sagitta_mm(0.7));
  EXPECT_LE(tell("where they meet", meeting), kCell_mm);
  EXPECT_GT(alone.size(), 2 * meeting.size());
}

TEST(ZMapWalls, NoOrderNoBatchAndNoThreadChangesThem) {
  std::mt19937 random(11);
  const Box room{Vec3(1, 1, -4), Vec3(19, 19, 1)};
  const std::vector<CutMove> moves = test::random_path(random, room, 400);
  const auto map_of = [&](int threads, std::size_t batch) {
    auto map = make_map("box:0,0,-5:20,20,0", kCell_mm, threads);
    std::vector<CutReport> reports;
    for (std::size_t first = 0; first < moves.size(); first += batch) {
      map->cut(tool("flat:3"),
               std::span(moves).subspan(first, std::min(batch, moves.size() - first)), reports);
      if (batch == 7) (void)map->snapshot();
    }
    map->finish(reports);
    return map;
  };
  const auto whole = map_of(1, moves.size());
  const std::string all_at_once = contents(*whole);
  EXPECT_EQ(contents(*map_of(1, 1)), all_at_once);
  EXPECT_EQ(contents(*map_of(3, 7)), all_at_once);
  EXPECT_EQ(contents(*map_of(2, 61)), all_at_once);
  EXPECT_EQ(contents(*whole->snapshot()), all_at_once);

  std::vector<LevelCut> cuts = level_cuts(random, 20);
  const std::string in_order = contents(*cut_map(cuts));
  std::shuffle(cuts.begin(), cuts.end(), random);
  EXPECT_EQ(contents(*cut_map(cuts)), in_order);
  cuts.push_back(cuts[3]);
  EXPECT_EQ(contents(*cut_map(cuts, 2)), in_order);
  // And where a wall is 0.001 mm off, that is another workpiece.
  LevelCut moved = cuts[0];
  moved.move.from_mm.y += 0.001;
  moved.move.to_mm.y += 0.001;
  if (moved.move.arc) moved.move.arc->center_mm.y += 0.001;
  cuts.push_back(moved);
  EXPECT_NE(contents(*cut_map(cuts)), in_order);
}

TEST(ZMapWalls, ASnapshotKeepsItsWalls) {
  const auto map = make_map("box:0,0,-5:20,20,0", kCell_mm);
  cut(*map, tool("flat:4"), {line(Vec3(5, 10.03, -2), Vec3(15, 10.03, -2))});
  const auto before = map->snapshot();
  const std::string kept = contents(*before);
  cut(*map, tool("flat:4"), {line(Vec3(5, 10.06, -2), Vec3(15, 10.06, -2))});
  EXPECT_EQ(contents(*before), kept);
  EXPECT_NE(contents(*map), kept);
}

TEST(ZMapWalls, AFileHasThemAndOneWithoutThemLoads) {
  const TemporaryFolder folder;
  const std::string path = folder.path() + "/part.state";
  std::mt19937 random(5);
  const auto map = cut_map(level_cuts(random, 12));
  ASSERT_TRUE(map->save(path));
  const auto loaded = ZMap::load(path);
  ASSERT_TRUE(loaded) << loaded.error();
  EXPECT_EQ(contents(**loaded), contents(*map));
  EXPECT_EQ((*loaded)->digest(), map->digest());
  EXPECT_EQ((*loaded)->mesh(0.01).positions_mm, map->mesh(0.01).positions_mm);

  // As versions before walls wrote it: heights only.
  const std::string old = folder.path() + "/old.state";
  const TileGrid grid(map->bounds_mm(), 8, 8);
  ASSERT_TRUE(write_state(old, grid, WallMarks(), 1));
  EXPECT_TRUE(ZMap::load(old));
  // A mark that cannot be is refused.
  TileGrid solid(map->bounds_mm(), 8, 8);
  const std::vector<float> row(8, 0.0f);
  for (int j = 0; j < 8; ++j) solid.set_row(j, row.data());
  WallMarks marks(solid);
  marks.add(0, WallMark::of(TileGrid::offset(7, 3), CellWay::kLeft, 0.5, -2), solid);
  ASSERT_TRUE(write_state(old, solid, marks, 1));
  EXPECT_TRUE(ZMap::load(old));
  EXPECT_FALSE(is_sound(WallMark::of(TileGrid::offset(7, 3), CellWay::kRight, 0.5, -2), 0, solid));
  EXPECT_FALSE(is_sound(WallMark::of(TileGrid::offset(3, 3), CellWay::kUp, 0.5, -6), 0, solid));
  EXPECT_FALSE(is_sound(WallMark::of(TileGrid::offset(9, 3), CellWay::kLeft, 0.5, -2), 0, solid));
}

}  // namespace
}  // namespace kerf
