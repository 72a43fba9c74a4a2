// Moves with numbers that no machine has, given to every model: the workpiece is what its share of
// the move leaves.
#include "stock/move_reach.h"

#include <gtest/gtest.h>

#include <limits>

#include "stock/cutter/shape_spec.h"
#include "stock/octree/octree.h"
#include "stock/zmap/mmap/mmap.h"
#include "stock/zmap/zmap.h"

namespace kerf {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

CutMove line(const Vec3& from, const Vec3& to) {
  CutMove move;
  move.from_mm = from;
  move.to_mm = to;
  return move;
}

std::unique_ptr<StockModel> make(int model) {
  const Blank blank = *parse_blank("box:-40,-30,-20:40,30,0");
  if (model == 2) {
    OctreeOptions options;
    options.blank = blank;
    options.cell_mm = 2;
    return std::move(*Octree::create(options));
  }
  ZMapOptions options;
  options.blank = blank;
  options.cell_mm = 0.5;
  if (model == 1) return std::move(*MMap::create(options));
  options.kernel = model == 3 ? ZMapKernel::kScalar : ZMapKernel::kAuto;
  return std::move(*ZMap::create(options));
}

double removed(StockModel& stock, const std::vector<CutMove>& moves, const char* tool) {
  std::vector<CutReport> reports;
  stock.cut(*parse_shape(tool), moves, reports);
  stock.finish(reports);
  EXPECT_EQ(reports.size(), moves.size());
  double sum = 0;
  for (std::size_t i = 0; i < reports.size(); ++i) {
    EXPECT_EQ(reports[i].id, moves[i].id);
    sum += reports[i].removed_mm3;
  }
  return sum;
}

class FarMoves : public testing::TestWithParam<int> {};

TEST_P(FarMoves, AreCutWhereTheBlankIs) {
  for (const double far : {1e7, 1e10, 8e14, 1e30, 1e300}) {
    const auto near = make(GetParam()), wild = make(GetParam());
    const double expected = removed(*near, {line({-100, 3, -2}, {100, 3, -2})}, "flat:6");
    ASSERT_GT(expected, 0);
    EXPECT_NEAR(removed(*wild, {line({-far, 3, -2}, {100, 3, -2})}, "flat:6"), expected, 1e-3)
        << far;
    EXPECT_NEAR(removed(*wild, {line({-far, 3, -2}, {far, 3, -2})}, "flat:6"), 0, 1e-3) << far;
  }
}

TEST_P(FarMoves, KeepReportsInOrder) {
  const auto stock = make(GetParam());
  std::vector<CutMove> moves;
  const double numbers[] = {0, 1, -3, 1e9, -1e10, 8e14, -1e300, kInf, -kInf, kNan, 1e-300};
  std::uint64_t id = 0;
  for (const double x : numbers) {
    for (const double y : numbers) {
      for (const double z : {-1.0, 0.5, -1e12, kNan}) {
        moves.push_back(line({x, y, -1}, {y, 2, z}));
        moves.back().id = id++;
        moves.push_back(line({x, 0, z}, {x, 0, z}));
        moves.back().arc = CutArc{{y, 0, z}, {0, 0, 1}, 2 * kPi};
        moves.back().id = id++;
        moves.push_back(line({1, 2, -1}, {4, 2, -1.5}));
        moves.back().id = id++;
      }
    }
  }
  EXPECT_GT(removed(*stock, moves, "ball:6"), 0);
  for (const CutMove& move : moves) {
    if (const auto contact = stock->first_contact(*parse_shape("flat:6"), move, 0.05)) {
      EXPECT_GT(contact->depth_mm, 0);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Models, FarMoves, testing::Values(0, 1, 2, 3));

TEST(MoveReach, LeavesWhatIsWithinAsItIs) {
  const Box blank{{0, 0, 0}, {1, 1, 1}};
  const CutMove move = line({-9e5, 3, 4}, {5, 6, 7});
  const auto same = within_reach(move, blank);
  ASSERT_TRUE(same);
  EXPECT_EQ(same->from_mm, move.from_mm);
  EXPECT_EQ(same->to_mm, move.to_mm);
}

TEST(MoveReach, ClipsStraightMovesAndDropsOthers) {
  const Box blank{{0, 0, 0}, {1, 1, 1}};
  const auto part = within_reach(line({-1e9, 0, 0}, {1e9, 0, 0}), blank);
  ASSERT_TRUE(part);
  EXPECT_NEAR(part->from_mm.x, -1e6, 1e-6);
  EXPECT_NEAR(part->to_mm.x, 1e6 + 1, 1e-6);
  EXPECT_FALSE(within_reach(line({-1e9, 1e9, 0}, {1e9, 1e9, 0}), blank));
  EXPECT_FALSE(within_reach(line({kNan, 0, 0}, {0, 0, 0}), blank));
  CutMove turning = line({-1e9, 0, 0}, {0, 0, 0});
  turning.axis_to = {1, 0, 0};
  EXPECT_FALSE(within_reach(turning, blank));
}

}  // namespace
}  // namespace kerf
