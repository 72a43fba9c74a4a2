// Heights of the Z-map against brute force, for every cutter and kind of move.
#include <gtest/gtest.h>

#include <random>

#include "stock/cutter/shape_spec.h"
#include "stock/zmap/zmap.h"
#include "tests/stock/sweep_oracle.h"

namespace kerf {
namespace {

using test::sweep_height;

/// What kerf promises for heights, mm.
constexpr double kPromise_mm = 1e-4;
/// Points this close to the edge of a sweep may fall to either side in the oracle, whose search
/// ends at about 1e-8.
constexpr double kAmbiguous_mm = 2e-7;

const char* const kShapes[] = {"flat:6",         "ball:6",     "ball:20",      "bull:6:1",
                               "bull:10:0.2",    "vee:6:60",   "vee:8:90:0.4", "taper:2:5",
                               "taper:3:10:1.5", "drill:5:118"};

std::unique_ptr<ZMap> make_map(const char* blank, double cell, int threads = 1,
                               ZMapKernel kernel = ZMapKernel::kAuto) {
  ZMapOptions options;
  options.blank = *parse_blank(blank);
  options.cell_mm = cell;
  options.threads = threads;
  options.kernel = kernel;
  auto map = ZMap::create(options);
  EXPECT_TRUE(map) << map.error();
  return std::move(*map);
}

void cut_all(ZMap& map, const Cutter& cutter, const std::vector<CutMove>& moves) {
  std::vector<CutReport> reports;
  map.cut(cutter, moves, reports);
  map.finish(reports);
  ASSERT_EQ(reports.size(), moves.size());
}

struct Worst {
  double error = 0;
  int cells = 0;
  int cut_cells = 0;
};

/// Greatest difference between the map and the lowest of the moves' envelopes.
Worst compare(const ZMap& map, const Cutter& cutter, const std::vector<CutMove>& moves, int stride,
              int samples) {
  Worst worst;
  const Box box = map.bounds_mm();
  for (int j = 0; j < map.ny(); j += stride) {
    for (int i = 0; i < map.nx(); i += stride) {
      const double x = box.min.x + (i + 0.5) * box.size().x / map.nx();
      const double y = box.min.y + (j + 0.5) * box.size().y / map.ny();
      double z = box.max.z;
      bool ambiguous = false;
      for (const CutMove& move : moves) {
        const test::OracleHeight h = sweep_height(cutter, move, x, y, samples);
        ambiguous |= h.edge_distance < kAmbiguous_mm;
        z = std::min(z, h.z);
      }
      if (ambiguous) continue;
      z = std::max(z, box.min.z);
      const double error = std::abs(static_cast<double>(map.height_mm(i, j)) - z);
      if (error > worst.error) {
        worst.error = error;
        if (error > kPromise_mm)
          ADD_FAILURE() << "cell " << i << "," << j << " at " << x << "," << y << ": map "
                        << map.height_mm(i, j) << ", oracle " << z;
      }
      ++worst.cells;
      worst.cut_cells += z < box.max.z;
      if (testing::Test::HasFailure()) return worst;
    }
  }
  return worst;
}

class EveryShape : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Shapes, EveryShape, testing::ValuesIn(kShapes), [](const auto& param) {
  std::string name = param.param;
  for (char& c : name)
    if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
  return name;
});

CutMove line(const Vec3& from, const Vec3& to) {
  CutMove move;
  move.from_mm = from;
  move.to_mm = to;
  return move;
}

TEST_P(EveryShape, SingleStraightMovesMatchTheOracle) {
  const auto cutter = parse_shape(GetParam());
  ASSERT_TRUE(cutter) << cutter.error();
  std::mt19937 random(20240601);
  std::uniform_real_distribution<double> xy(-1, 13), z(-9, 2), unit(0, 1);
  int cut_cells = 0;
  for (int round = 0; round < 42; ++round) {
    Vec3 from{xy(random), xy(random), z(random)}, to(xy(random), xy(random), z(random));
    switch (round % 6) {
      case 0:
        to.z = from.z;
        break;  // level
      case 1:
        to.x = from.x, to.y = from.y;
        break;  // plunge or retract
      case 2:
        to = from + Vec3(0.01 * unit(random), 0.02, to.z - from.z);
        break;  // nearly vertical
      case 3:
        to.y = from.y;
        break;  // along X
      case 4:
        to.x = from.x, to.z = from.z;
        break;  // level along Y
      default:
        break;
    }
    SCOPED_TRACE(testing::Message()
                 << "round " << round << " from " << from.x << "," << from.y << "," << from.z
                 << " to " << to.x << "," << to.y << "," << to.z);
    const auto map = make_map("box:0,0,-12:12,12,0", 0.25);
    const std::vector<CutMove> moves{line(from, to)};
    cut_all(*map, *cutter, moves);
    cut_cells += compare(*map, *cutter, moves, 2, 40).cut_cells;
    if (HasFailure()) return;
  }
  EXPECT_GT(cut_cells, 500);
}

TEST_P(EveryShape, PathsOfShortSegmentsMatchTheOracle) {
  const auto cutter = parse_shape(GetParam());
  ASSERT_TRUE(cutter);
  std::mt19937 random(77);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (int round = 0; round < 4; ++round) {
    SCOPED_TRACE(testing::Message() << "round " << round);
    std::vector<CutMove> moves;
    Vec3 at{2, 6 + 3 * unit(random), -2 + unit(random)};
    double heading = 0.5 * unit(random);
    for (int i = 0; i < 40; ++i) {
      // Gentle turns, sharp corners now and then, straight runs with changing slope.
      heading += round % 2 == 0 ? 0.1 * unit(random) : (i % 9 == 0 ? 2.0 * unit(random) : 0.0);
      const double step = 0.25 + 0.15 * unit(random);
      const Vec3 to =
          at + Vec3(step * std::cos(heading), step * std::sin(heading), 0.3 * unit(random));
      moves.push_back(line(at, to));
      at = to;
    }
    const auto map = make_map("box:0,0,-12:12,12,0", 0.25);
    cut_all(*map, *cutter, moves);
    compare(*map, *cutter, moves, 3, 6);
    if (HasFailure()) return;
  }
}

CutMove arc(const Vec3& center, double radius, double start, double sweep, double dz) {
  CutMove move;
  move.from_mm = center + Vec3(radius * std::cos(start), radius * std::sin(start), 0);
  move.to_mm =
      center + Vec3(radius * std::cos(start + sweep), radius * std::sin(start + sweep), dz);
  move.arc = CutArc{center, Vec3(0, 0, 1), sweep};
  return move;
}

TEST_P(EveryShape, LevelArcsAndHelicesMatchTheOracle) {
  const auto cutter = parse_shape(GetParam());
  ASSERT_TRUE(cutter);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int round = 0; round < 16; ++round) {
    const double radius = round % 3 == 0 ? 0.5 + unit(random) : 2 + 4 * unit(random);
    double sweep = (unit(random) < 0.5 ? 1 : -1) * 2 * kPi * unit(random);
    if (round % 4 == 1) sweep *= 2.5;
    if (round == 5) sweep = 2 * kPi;
    const double dz = round % 2 == 0 ? 0 : (unit(random) - 0.7) * 6;
    const CutMove move = arc(Vec3{5 + 2 * unit(random), 6, -1 - 3 * unit(random)}, radius,
                             6 * unit(random), sweep, dz);
    SCOPED_TRACE(testing::Message() << "round " << round << " radius " << radius << " sweep "
                                    << sweep << " dz " << dz);
    const auto map = make_map("box:0,0,-12:12,12,0", 0.25);
    cut_all(*map, *cutter, {move});
    compare(*map, *cutter, {move}, 3, 400);
    if (HasFailure()) return;
  }
}

TEST_P(EveryShape, AFineGridMatchesTheOracleNearWalls) {
  const auto cutter = parse_shape(GetParam());
  ASSERT_TRUE(cutter);
  const std::vector<CutMove> moves{line(Vec3(1, 1.7, -1), Vec3(2.9, 2.3, -1.5)),
                                   line(Vec3(2.9, 2.3, -1.5), Vec3(3, 3.4, -1.1))};
  const auto map = make_map("box:0,0,-12:4,4,0", 0.04);
  cut_all(*map, *cutter, moves);
  const Worst worst = compare(*map, *cutter, moves, 1, 12);
  RecordProperty("worst_mm", std::to_string(worst.error));
}

TEST(ZMapOracle, ArcsInOtherPlanesStayWithinTheChordTolerance) {
  const auto cutter = parse_shape("ball:4");
  CutMove move;
  move.from_mm = Vec3(2, 5, -1);
  move.to_mm = Vec3(9, 5, -1);
  // Half circle below the line, about the Y axis.
  move.arc = CutArc{Vec3(5.5, 5, -1), Vec3(0, 1, 0), -kPi};
  const auto map = make_map("box:0,0,-12:12,12,0", 0.25);
  cut_all(*map, *cutter, {move});
  const Box box = map->bounds_mm();
  int checked = 0;
  for (int j = 0; j < map->ny(); ++j) {
    for (int i = 0; i < map->nx(); ++i) {
      const double x = box.min.x + (i + 0.5) * 0.25, y = box.min.y + (j + 0.5) * 0.25;
      const test::OracleHeight h = sweep_height(*cutter, move, x, y, 300);
      if (h.edge_distance < 0.05)
        continue;  // walls: a micrometre sideways is more than one in height
      // 1 um chord error, seen at slopes up to 89 degrees of the ball's flank.
      EXPECT_NEAR(map->height_mm(i, j), std::min(0.0, h.z), 0.01) << x << " " << y;
      ++checked;
    }
  }
  EXPECT_GT(checked, 1000);
}

}  // namespace
}  // namespace kerf
