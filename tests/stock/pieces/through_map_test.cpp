// What comes free of a Z-map, move by move: closed forms, and a flood fill after every move.
#include "stock/pieces/through_map.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <set>

#include "stock/cutter/shape_spec.h"
#include "stock/zmap/zmap.h"
#include "tests/stock/stock_samples.h"

namespace kerf {
namespace {

using test::line;
using test::tool;

CutMove turn(const Vec3& from, const Vec3& center, double sweep_rad) {
  CutMove move;
  move.from_mm = from;
  const Vec3 arm = from - center;
  move.to_mm = center + Vec3(arm.x * std::cos(sweep_rad) - arm.y * std::sin(sweep_rad),
                             arm.x * std::sin(sweep_rad) + arm.y * std::cos(sweep_rad), 0);
  move.arc = CutArc{center, {0, 0, 1}, sweep_rad};
  return move;
}

/// Volume of cells of a model that has cut the moves.
double volume_mm3(const ZMap& map, const CellSet& cells) {
  const Box box = map.bounds_mm();
  const double area = box.size().x / map.nx() * box.size().y / map.ny();
  double sum = 0;
  each_cell(cells, [&](int i, int j) {
    sum += area * (static_cast<double>(map.height_mm(i, j)) - box.min.z);
  });
  return sum;
}

/// The smaller of two bodies as it is after the move: what was parted in it has points yet.
std::size_t smaller(const ThroughMap& through, const ThroughSplit& split) {
  std::size_t least = ~std::size_t{0};
  for (CellSet cells : split.bodies) {
    for (CellWord& c : cells) c.bits &= through.material().at(c.row, c.word);
    least = std::min(least, count_of(cells));
  }
  return least;
}

std::vector<ThroughSplit> cut(ThroughMap& through, const Cutter& cutter, const CutMove& move) {
  std::vector<ThroughSplit> splits;
  through.cut(cutter, move, splits);
  return splits;
}

TEST(ThroughMap, TellsASquareIslandWithTheMoveThatClosesItsSlot) {
  const auto map = test::make_map("box:0,0,-10:60,60,0", 0.25);
  ThroughMap through(*map->height_grid());
  const Cutter cutter = tool("flat:6");
  const Vec3 corners[] = {{10, 10, -10}, {40, 10, -10}, {40, 40, -10}, {10, 40, -10}};
  for (int n = 0; n < 3; ++n)
    EXPECT_TRUE(cut(through, cutter, line(corners[n], corners[n + 1])).empty());
  const auto splits = cut(through, cutter, line(corners[3], corners[0]));
  ASSERT_EQ(splits.size(), 1u);
  ASSERT_EQ(splits[0].bodies.size(), 2u);
  // 24 x 24 mm in cells of 0.25 mm.
  EXPECT_EQ(smaller(through, splits[0]), 96u * 96u);
  // The slot of before reaches to Y13, the tool 3 mm ahead: in steps of the tool's 6 mm.
  EXPECT_LE(splits[0].tip_mm.y, 16);
  EXPECT_GE(splits[0].tip_mm.y, 10);
  EXPECT_EQ(through.bodies().size(), 2u);
}

TEST(ThroughMap, ASkinOrATabOfOneCellHolds) {
  const Vec3 corners[] = {{10, 10, 0}, {40, 10, 0}, {40, 40, 0}, {10, 40, 0}, {10, 10, 0}};
  const Cutter cutter = tool("flat:6");
  const auto map = test::make_map("box:0,0,-10:60,60,0", 0.25);
  ThroughMap skin(*map->height_grid());
  for (int n = 0; n < 4; ++n) {
    const CutMove move = line(corners[n] - Vec3(0, 0, 9.98), corners[n + 1] - Vec3(0, 0, 9.98));
    EXPECT_FALSE(ThroughMap::reaches(move, -10));
    EXPECT_TRUE(cut(skin, cutter, move).empty());
  }
  ThroughMap tab(*map->height_grid());
  std::vector<ThroughSplit> splits;
  const auto go = [&](double x0, double y0, double x1, double y1) {
    for (auto& split : cut(tab, cutter, line({x0, y0, -10}, {x1, y1, -10})))
      splits.push_back(std::move(split));
  };
  go(10, 10, 40, 10);
  go(40, 10, 40, 40);
  go(40, 40, 26.3, 40);  // reaches to X23.3, the other one to X23.0: one row of middles
  go(20, 40, 10, 40);
  go(10, 40, 10, 10);
  EXPECT_TRUE(splits.empty());
  go(20, 40, 20.3, 40);
  EXPECT_EQ(splits.size(), 1u);
}

TEST(ThroughMap, ARoundSlugOfABallHasTheRadiusAtTheFloor) {
  const auto map = test::make_map("box:-30,-30,-4:30,30,0", 0.1);
  ThroughMap through(*map->height_grid());
  // 1 mm below the floor a ball of 6 mm is as wide as 2 sqrt(9 - 2^2) there, and 0.01 mm above.
  const auto splits = cut(through, tool("ball:6"), turn({15, 0, -5}, {0, 0, -5}, 2 * kPi));
  ASSERT_EQ(splits.size(), 1u);
  const double radius = 15 - std::sqrt(9 - 1.99 * 1.99);
  const double area = 0.01 * static_cast<double>(smaller(through, splits[0]));
  EXPECT_NEAR(area, kPi * radius * radius, 0.002 * area);
  EXPECT_GT(splits[0].share, 0.8);
}

TEST(ThroughMap, CuttingOnInWhatIsPartedAlreadyTellsNothing) {
  const auto map = test::make_map("box:0,0,-10:60,60,0", 0.25);
  ThroughMap through(*map->height_grid());
  const Cutter cutter = tool("flat:6");
  EXPECT_EQ(cut(through, cutter, line({30, -5, -11}, {30, 65, -11})).size(), 1u);
  EXPECT_TRUE(cut(through, cutter, line({30, -5, -11}, {30, 65, -11})).empty());
  EXPECT_TRUE(cut(through, cutter, line({31, 65, -11}, {29, -5, -11})).empty());
  EXPECT_EQ(cut(through, cutter, line({-5, 30, -11}, {20, 30, -11})).size(), 0u);
  EXPECT_EQ(cut(through, cutter, line({20, 30, -11}, {30, 30, -11})).size(), 1u);
  EXPECT_EQ(through.bodies().size(), 3u);
}

/// One of them is as large within 2 % and some cells.
bool has_near(const std::vector<double>& volumes, double mm3) {
  return std::ranges::any_of(
      volumes, [&](double other) { return std::abs(other - mm3) < 0.02 * mm3 + 0.3; });
}

using Body = std::vector<std::pair<int, int>>;

/// By brute force: cells higher than a skin, side by side or corner to corner; those with a square.
std::vector<Body> flooded(const ZMap& map) {
  const int nx = map.nx(), ny = map.ny();
  std::vector<int> seen(static_cast<std::size_t>(nx * ny), 0);
  const auto at = [&](int i, int j) -> int& { return seen[static_cast<std::size_t>(j * nx + i)]; };
  const auto solid = [&](int i, int j) {
    return i >= 0 && j >= 0 && i < nx &&
           j<ny&& static_cast<double>(map.height_mm(i, j))> map.bounds_mm().min.z +
               ThroughMap::kThinnest_mm;
  };
  std::vector<Body> out;
  for (int j = 0; j < ny; ++j) {
    for (int i = 0; i < nx; ++i) {
      if (!solid(i, j) || at(i, j)) continue;
      Body body{{i, j}};
      at(i, j) = 1;
      bool square = false;
      for (std::size_t n = 0; n < body.size(); ++n) {
        const auto [x, y] = body[n];
        square = square || (solid(x + 1, y) && solid(x, y + 1) && solid(x + 1, y + 1));
        for (int b = y - 1; b <= y + 1; ++b) {
          for (int a = x - 1; a <= x + 1; ++a) {
            if (!solid(a, b) || at(a, b)) continue;
            at(a, b) = 1;
            body.push_back({a, b});
          }
        }
      }
      std::ranges::sort(body);
      if (square) out.push_back(std::move(body));
    }
  }
  return out;
}

/// Random ways right through a small block: after every move the bodies are those of a flood fill
/// over the model's heights, the move that parts something is the same, and so are the volumes.
TEST(ThroughMap, AgreesWithAFloodFillAfterEveryMove) {
  const char* const shapes[] = {"flat:2", "flat:3.1", "ball:4", "bull:3:0.5", "vee:6:60"};
  int partings = 0, bodies_compared = 0;
  for (unsigned seed = 1; seed <= 40; ++seed) {
    std::mt19937 random(seed);
    const auto uniform = [&](double low, double high) {
      return std::uniform_real_distribution<>(low, high)(random);
    };
    const auto map = test::make_map("box:0,0,-3:24,20,0", 0.2137);
    ThroughMap through(*map->height_grid());
    const Cutter cutter = tool(shapes[seed % std::size(shapes)]);
    Vec3 at(uniform(0, 24), uniform(0, 20), -3.7);
    std::vector<CutReport> reports;
    std::size_t bodies_before = 1;
    for (int n = 0; n < 40; ++n) {
      SCOPED_TRACE(testing::Message() << "seed " << seed << " move " << n);
      CutMove move = line(at, {uniform(-2, 26), uniform(-2, 22), -3.7});
      if (n % 4 == 1) move.to_mm.z = uniform(-3.5, -2);  // climbs out on its way
      if (n % 4 == 2) move.from_mm.z = at.z;
      if (n % 4 == 3 && seed % 2 == 0)
        move = turn(at, at + Vec3(uniform(-5, 5), uniform(-5, 5), 0), uniform(-6, 6));
      map->cut(cutter, std::span(&move, 1), reports);
      map->finish(reports);
      const auto splits = cut(through, cutter, move);
      at = move.to_mm;
      if (n % 4 == 1) at.z = -3.7;
      const std::vector<Body> truth = flooded(*map);
      std::vector<Body> found;
      double volume = 0, true_volume = 0;
      std::vector<double> volumes, true_volumes;
      for (const CellSet& cells : through.bodies()) {
        Body& body = found.emplace_back();
        each_cell(cells, [&](int i, int j) { body.push_back({i, j}); });
        std::ranges::sort(body);
        volumes.push_back(volume_mm3(*map, cells));
        volume += volumes.back();
      }
      for (const Body& body : truth) {
        double sum = 0;
        for (const auto& [i, j] : body) sum += static_cast<double>(map->height_mm(i, j) + 3);
        true_volumes.push_back(sum * 24 / map->nx() * 20 / map->ny());
        true_volume += true_volumes.back();
      }
      std::set<Body> a(truth.begin(), truth.end()), b(found.begin(), found.end());
      // Straight ways of cylinders are exact. Of arcs' chords, and where a ball or a cone is as
      // high as single precision, a few middles at the edge are either's.
      const bool exact = cutter.height_mm(cutter.radius_mm()) == 0 && seed % 2 == 1;
      if (exact) {
        ASSERT_EQ(a, b);
      } else {
        for (const double one : true_volumes) EXPECT_TRUE(one < 1 || has_near(volumes, one)) << one;
        for (const double one : volumes) EXPECT_TRUE(one < 1 || has_near(true_volumes, one)) << one;
        ASSERT_NEAR(volume, true_volume, 0.002 * true_volume);
      }
      bodies_compared += static_cast<int>(truth.size());
      if (truth.size() > bodies_before) {
        EXPECT_TRUE(!exact || !splits.empty());
        ++partings;
      }
      if (exact && !splits.empty()) {
        // What is told has been one body, and is several.
        for (const ThroughSplit& split : splits) EXPECT_GE(split.bodies.size(), 2u);
      }
      bodies_before = truth.size();
    }
  }
  EXPECT_GT(partings, 60);
  EXPECT_GT(bodies_compared, 2000);
}

}  // namespace
}  // namespace kerf
