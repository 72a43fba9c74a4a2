// Volumes of a Z-map by its true walls: against closed forms, brute force and its own mesh.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <glm/geometric.hpp>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "tests/base/temporary_folder.h"
#include "tests/stock/stock_samples.h"
#include "tests/stock/wall_mesh_samples.h"

namespace kerf {
namespace {

using test::enclosed_mm3;
using test::line;
using test::make_map;
using test::tool;

constexpr const char* kBlank = "box:0,0,-10:60,50,0";
/// Of walls, in volumes as in meshes.
constexpr double kPromise_cells = 1.0 / 50;
constexpr double kCells_mm[] = {0.1, 0.23, 0.5, 1.0};

void cut(ZMap& map, const char* shape, const std::vector<CutMove>& moves) {
  test::cut(map, tool(shape), moves);
  test::finish(map);
}

double removed_mm3(const ZMap& map) { return map.blank_mm3() - map.remaining_mm3(); }

CutMove circle(const Vec2& start, const Vec2& center, double z, double turn_rad = 2 * kPi) {
  CutMove move = line(Vec3(start, z), Vec3(start, z));
  move.arc = CutArc{Vec3(center, z), Vec3(0, 0, turn_rad > 0 ? 1 : -1), std::abs(turn_rad)};
  return move;
}

std::vector<CutMove> ring(const std::vector<Vec2>& corners, double z) {
  std::vector<CutMove> out;
  for (std::size_t n = 0; n < corners.size(); ++n)
    out.push_back(line(Vec3(corners[n], z), Vec3(corners[(n + 1) % corners.size()], z)));
  return out;
}

struct Case {
  std::string name;
  double exact_mm3 = 0, wall_mm2 = 0;
  std::function<void(ZMap&)> cut;
};

/// Rectangle whose middle of the tool runs from `low` to `high`, turned by `turn` about `at`.
std::vector<Vec2> rectangle(const Vec2& at, const Vec2& half, double turn) {
  const Vec2 x(std::cos(turn), std::sin(turn)), y(-x.y, x.x);
  return {at - half.x * x - half.y * y, at + half.x * x - half.y * y, at + half.x * x + half.y * y,
          at - half.x * x + half.y * y};
}

std::vector<Case> cases_at(const Vec2& at, double turn) {
  std::vector<Case> out;
  const double z = -4;
  {  // 24 x 16 mm with corners of 3 mm, and no island
    const double w = 24, h = 16, r = 3;
    out.push_back(
        {"pocket", 4 * (w * h - (4 - kPi) * r * r), 4 * (2 * (w + h) - (8 - 2 * kPi) * r),
         [=](ZMap& map) {
           for (double in = 0; in < 5; in += 2.5)
             cut(map, "flat:6",
                 ring(rectangle(at, Vec2(w / 2 - r - in, std::max(0.0, h / 2 - r - in)), turn), z));
           cut(map, "flat:6", {line(Vec3(at, z), Vec3(at + 0.01, z))});
         }});
  }
  {
    const Vec2 way = 20.0 * Vec2(std::cos(turn), std::sin(turn));
    out.push_back({"slot", 4 * (20 * 5 + kPi * 6.25), 4 * (40 + kPi * 5), [=](ZMap& map) {
                     cut(map, "flat:5", {line(Vec3(at - 0.5 * way, z), Vec3(at + 0.5 * way, z))});
                   }});
  }
  out.push_back({"round", 4 * kPi * 81, 4 * 2 * kPi * 9, [=](ZMap& map) {
                   for (const double r : {6.0, 2.0})
                     cut(map, "flat:6", {circle(at + Vec2(r, 0), at, z)});
                 }});
  out.push_back({"round island", 4 * kPi * (100 - 16), 4 * 2 * kPi * 14, [=](ZMap& map) {
                   cut(map, "flat:6", {circle(at + Vec2(7, 0), at, z, -2 * kPi)});
                 }});
  {  // an island of 12 x 9 mm with sharp corners
    const double w = 12, h = 9, d = 6;
    const double outside = (w + 2 * d) * (h + 2 * d) - (4 - kPi) * d * d / 4;
    out.push_back({"island", 4 * (outside - w * h),
                   4 * (2 * (w + h) + 2 * (w + h + 4 * d) - (8 - 2 * kPi) * d / 2), [=](ZMap& map) {
                     cut(map, "flat:6",
                         ring(rectangle(at, Vec2((w + d) / 2, (h + d) / 2), turn), z));
                   }});
  }
  {
    const Vec2 way = 20.0 * Vec2(std::cos(turn), std::sin(turn));
    out.push_back({"steps", 2 * (20 * 10 + kPi * 25) + 3 * (20 * 5 + kPi * 6.25),
                   2 * (40 + kPi * 10) + 3 * (40 + kPi * 5), [=](ZMap& map) {
                     const Vec2 a = at - 0.5 * way, b = at + 0.5 * way;
                     cut(map, "flat:5", {line(Vec3(a, -5), Vec3(b, -5))});
                     cut(map, "flat:10", {line(Vec3(a, -2), Vec3(b, -2))});
                   }});
    out.push_back({"through", 10 * (20 * 5 + kPi * 6.25), 10 * (40 + kPi * 5), [=](ZMap& map) {
                     cut(map, "flat:5",
                         {line(Vec3(at - 0.5 * way, -11), Vec3(at + 0.5 * way, -11))});
                   }});
  }
  if (std::abs(std::tan(turn)) < 0.6) {  // out of the blank at x = 0 and 60
    const double length = 60 / std::abs(std::cos(turn));
    const Vec2 way = 60.0 * Vec2(std::cos(turn), std::sin(turn));
    out.push_back({"edges", 4 * length * 6, 4 * 2 * length, [=](ZMap& map) {
                     cut(map, "flat:6", {line(Vec3(at - way, z), Vec3(at + way, z))});
                   }});
  }
  out.push_back({"bore", 10 * kPi * 16, 10 * kPi * 8,
                 [=](ZMap& map) { cut(map, "flat:8", {line(Vec3(at, 1), Vec3(at, -10))}); }});
  return out;
}

/// Upright walls on level floors: what else a mesh of cells is off by, rounded corners and ends of
/// walls aside, are the two corners of the grid that it divides (height_mesh.h).
void expect_as_in_mesh(const ZMap& map, double wall_mm2, const std::string& what) {
  const double volume = map.remaining_mm3(), cell = map.cell_mm();
  const double corners_mm3 = cell * cell * map.bounds_mm().size().z / 3;
  EXPECT_NEAR(enclosed_mm3(map.mesh(0)), volume,
              kPromise_cells * cell * wall_mm2 + corners_mm3 + 1e-6 * volume)
      << what;
}

TEST(WallVolume, IsThatOfClosedForms) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> place(-0.5, 0.5), any(0, 2 * kPi);
  double worst = 0, worst_by_cells = 0;
  for (const double cell : kCells_mm) {
    for (int round = 0; round < 6; ++round) {
      const double turns[] = {0, kPi / 2, kPi / 4, kPi / 6, any(random), any(random)};
      const double x = 30 + place(random), y = 25 + place(random);
      for (const Case& c : cases_at(Vec2(x, y), turns[round])) {
        const std::string what =
            c.name + ", cell " + std::to_string(cell) + ", round " + std::to_string(round);
        const auto map = make_map(kBlank, cell);
        c.cut(*map);
        const double wall_cells_mm3 = c.wall_mm2 * cell;
        const double off = (removed_mm3(*map) - c.exact_mm3) / wall_cells_mm3;
        EXPECT_LT(std::abs(off), kPromise_cells) << what;
        worst = std::max(worst, std::abs(off));
        const double by_cells = map->blank_mm3() - test::volume_by_cells(*map);
        worst_by_cells =
            std::max(worst_by_cells, std::abs(by_cells - c.exact_mm3) / wall_cells_mm3);
        expect_as_in_mesh(*map, c.wall_mm2, what);
      }
    }
  }
  std::printf("off by at most %.5f cells along walls; by middles of cells %.3f\n", worst,
              worst_by_cells);
  EXPECT_GT(worst_by_cells, 0.1);
}

/// Ways of all kinds, across each other: corners, cusps, ramps, floors that rise beside walls.
TEST(WallVolume, IsNearerToThatOfFineCellsThanMiddlesAre) {
  struct Kind {
    const char* shape;
    double most;  ///< of what middles of cells are off
  };
  // A taper has no upright side, a drill a short one.
  for (const Kind& kind : {Kind{"flat:5", 0.4}, Kind{"bull:6:1", 0.4}, Kind{"ball:6", 0.5},
                           Kind{"drill:5:118", 0.6}, Kind{"taper:3:10:1.5", 1}}) {
    double off_mm3 = 0, by_cells_mm3 = 0;
    constexpr unsigned kRounds = 8;
    for (unsigned seed = 1; seed <= kRounds; ++seed) {
      std::mt19937 random(seed);
      const Box room{Vec3(4, 4, -7), Vec3(26, 26, -1)};
      const std::vector<CutMove> moves = test::random_path(random, room, 24);
      const auto coarse = make_map("box:0,0,-8:30,30,0", 0.47),
                 fine = make_map("box:0,0,-8:30,30,0", 0.03);
      cut(*coarse, kind.shape, moves);
      cut(*fine, kind.shape, moves);
      const double exact = fine->remaining_mm3();
      EXPECT_NEAR(exact, test::volume_by_cells(*fine), 0.1) << kind.shape << ", seed " << seed;
      off_mm3 += std::abs(coarse->remaining_mm3() - exact) / kRounds;
      by_cells_mm3 += std::abs(test::volume_by_cells(*coarse) - exact) / kRounds;
    }
    std::printf("%s: off by %.3f mm3, by middles of cells %.3f\n", kind.shape, off_mm3,
                by_cells_mm3);
    EXPECT_LE(off_mm3, kind.most * by_cells_mm3) << kind.shape;
  }
}

TEST(WallVolume, OfAHelixInChordsIsThatOfTheHelix) {
  // Down from Z-2 to Z-4 in one turn and a half: chords leave sides all over the floor behind them.
  const Vec2 center(20.03, 19.97);
  const double turn_rad = 3 * kPi, radius = 10;
  const auto tip = [&](double t) {
    const double a = t * turn_rad;
    return Vec3(center + radius * Vec2(std::cos(a), std::sin(a)), -2 - 2 * t);
  };
  for (const double cell : {0.1, 0.3}) {
    const auto whole = make_map("box:0,0,-10:40,40,0", cell),
               chords = make_map("box:0,0,-10:40,40,0", cell);
    CutMove helix = line(tip(0), tip(1));
    helix.arc = CutArc{Vec3(center, -2), Vec3(0, 0, 1), turn_rad};
    cut(*whole, "flat:4", {helix});
    std::vector<CutMove> moves;
    constexpr int kChords = 1900;  // 0.05 mm
    for (int n = 0; n < kChords; ++n)
      moves.push_back(line(tip(double(n) / kChords), tip(double(n + 1) / kChords)));
    cut(*chords, "flat:4", moves);
    // Walls of 4 mm and less.
    const double wall_mm2 = 4 * 2 * kPi * 20;
    EXPECT_NEAR(whole->remaining_mm3(), chords->remaining_mm3(), kPromise_cells * cell * wall_mm2)
        << cell;
    EXPECT_NEAR(whole->remaining_mm3(), test::volume_by_cells(*whole), 0.1 * cell * wall_mm2);
  }
}

TEST(WallVolume, IsThatOfLowSteps) {
  // As low as a cell is wide, and much lower: no surface shows them.
  for (const double deep : {0.5, 0.05}) {
    const auto map = make_map("box:0,0,-5:20,20,0", 0.5);
    cut(*map, "flat:40", {line(Vec3(-30, -13.36, -deep), Vec3(50, -13.36, -deep))});
    EXPECT_NEAR(removed_mm3(*map), 20 * 6.64 * deep, 20 * deep * 0.5 * kPromise_cells) << deep;
  }
}

/// Where slots part a block, wedges and webs remain that are thinner than a cell somewhere: middles
/// meet some of them.
TEST(WallVolume, HasWedgesAndThinWebs) {
  for (const char* shape : {"flat:4", "ball:4"}) {
    double off_mm3 = 0, lean_mm3 = 0, by_cells_mm3 = 0;
    for (unsigned seed = 1; seed <= 6; ++seed) {
      std::mt19937 random(seed);
      std::uniform_real_distribution<double> place(-6, 32);
      const auto coarse = make_map("box:0,0,0:30,26,24", 0.4),
                 fine = make_map("box:0,0,0:30,26,24", 0.025);
      for (int n = 0; n < 20; ++n) {
        const double from = place(random), to = place(random);
        const CutMove slot = n % 2 == 0 ? line(Vec3(-9, from, -1.5), Vec3(40, to, -1.5))
                                        : line(Vec3(from, -9, -1.5), Vec3(to, 40, -1.5));
        cut(*coarse, shape, {slot});
        cut(*fine, shape, {slot});
        const double exact = fine->remaining_mm3(), off = coarse->remaining_mm3() - exact;
        off_mm3 += std::abs(off) / 120;
        lean_mm3 += off / 120;
        by_cells_mm3 += std::abs(test::volume_by_cells(*coarse) - exact) / 120;
      }
    }
    std::printf("%s: off by %.2f mm3 (%+.2f in the mean), by middles of cells %.2f\n", shape,
                off_mm3, lean_mm3, by_cells_mm3);
    EXPECT_LT(off_mm3, 0.5 * by_cells_mm3) << shape;
    EXPECT_LT(std::abs(lean_mm3), 0.35 * by_cells_mm3) << shape;
  }
}

TEST(WallVolume, IsThatOfRoundBlanks) {
  for (const double cell : {0.1, 0.37}) {
    const auto disc = make_map("cylinder:10.02,9.97,-4:0:15", cell);
    // Beyond the outermost middles, half a cell from where the box touches the disc, its side runs
    // straight out: at each of the four places a third of 2 sqrt(2 r x cell / 2) x cell / 2 is too
    // much.
    const double beyond_mm3 = 4 * 4 * 2 * std::sqrt(7.5 * cell) * cell / 2 / 3;
    EXPECT_NEAR(disc->blank_mm3(), 4 * kPi * 56.25 + beyond_mm3, 0.1 * beyond_mm3) << cell;
    EXPECT_EQ(disc->remaining_mm3(), disc->blank_mm3());
    const Vec2 center(10.02, 9.97);
    cut(*disc, "flat:4", {line(Vec3(center, 5), Vec3(center, -4))});
    EXPECT_NEAR(removed_mm3(*disc), 4 * kPi * 4, 4 * kPi * 4 * cell * kPromise_cells) << cell;

    const auto tube = make_map("tube:10.02,9.97,-4:0:15:6.3", cell);
    const double bore_mm3 = disc->blank_mm3() - tube->blank_mm3();
    EXPECT_NEAR(bore_mm3, kPi * 6.3 * 6.3, 4 * kPi * 6.3 * cell * kPromise_cells) << cell;
  }
}

TEST(WallVolume, IsThatOfTheMiddlesWhereNoWallIsKnown) {
  // Walls that were cut away; sides that lean; half a cell at the edges of the blank.
  const auto faced = make_map("box:0,0,-5:20,20,0", 0.3);
  cut(*faced, "flat:4", {line(Vec3(5, 10.03, -2), Vec3(15, 10.03, -2))});
  EXPECT_GT(std::abs(faced->remaining_mm3() - test::volume_by_cells(*faced)), 0.01);
  cut(*faced, "flat:40", {line(Vec3(-30, 10, -2.1), Vec3(50, 10, -2.1))});
  EXPECT_NEAR(removed_mm3(*faced), 400 * 2.1, 1e-3);

  const auto leaning = make_map("box:0,0,-5:20,20,0", 0.3);
  cut(*leaning, "vee:12:60", {line(Vec3(5, 10.03, -2), Vec3(15, 11.03, -2))});
  EXPECT_NEAR(leaning->remaining_mm3(), test::volume_by_cells(*leaning), 1e-6);

  const auto edge = make_map("box:0,0,-5:20,20,0", 0.4);
  cut(*edge, "flat:4", {line(Vec3(-10, -1.85, -2), Vec3(30, -1.85, -2))});
  EXPECT_EQ(removed_mm3(*edge), 0) << "0.15 of 0.4 mm at y = 0";
  cut(*edge, "flat:4", {line(Vec3(-10, -1.7, -2), Vec3(30, -1.7, -2))});
  EXPECT_NEAR(removed_mm3(*edge), 2 * 20 * 0.3, 2 * 20 * 0.4 * kPromise_cells);
}

TEST(WallVolume, StaysWithTheWorkpiece) {
  const auto map = make_map("cylinder:10.02,9.97,-4:0:15", 0.2);
  cut(*map, "flat:3",
      {line(Vec3(7, 9.3, -2), Vec3(13, 10.1, -3)), circle(Vec2(13, 10.1), Vec2(11, 9.8), -3)});
  const double volume = map->remaining_mm3();
  EXPECT_GT(std::abs(volume - test::volume_by_cells(*map)), 0.01);
  const auto snapshot = map->snapshot();
  EXPECT_EQ(snapshot->remaining_mm3(), volume);
  EXPECT_EQ(snapshot->blank_mm3(), map->blank_mm3());

  const TemporaryFolder folder;
  const std::string path = folder.path() + "/part.state";
  ASSERT_TRUE(map->save(path));
  const auto loaded = ZMap::load(path);
  ASSERT_TRUE(loaded) << loaded.error();
  EXPECT_EQ((*loaded)->remaining_mm3(), volume);
  EXPECT_EQ((*loaded)->blank_mm3(), map->blank_mm3());

  // What is held back counts in a snapshot; the model has it after finish().
  const double before = snapshot->remaining_mm3();
  cut(*map, "flat:3", {line(Vec3(7, 9.3, -3.5), Vec3(13, 10.1, -3.5))});
  EXPECT_LT(map->remaining_mm3(), before);
  EXPECT_EQ(snapshot->remaining_mm3(), before);
}

TEST(WallVolume, OfThinGridsIsThatOfTheMiddles) {
  const auto one = make_map("box:0,0,-5:20,0.5,0", 0.5);
  ASSERT_EQ(one->ny(), 1);
  cut(*one, "flat:4", {line(Vec3(5.1, 0.2, -2), Vec3(9.1, 0.2, -2))});
  EXPECT_NEAR(one->remaining_mm3(), test::volume_by_cells(*one), 1e-6);
  const auto two = make_map("box:0,0,-5:20,1,0", 0.5);
  ASSERT_EQ(two->ny(), 2);
  cut(*two, "flat:4", {line(Vec3(5.1, -20, -2), Vec3(5.1, 20, -2))});
  EXPECT_NEAR(removed_mm3(*two), 2 * 4, 2 * 2 * 0.5 * kPromise_cells);
}

}  // namespace
}  // namespace kerf
