// tests/stock/stock_samples.h - workpieces and moves for tests of what the Z-map shows and shares,
// and of pieces.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "stock/cutter/shape_spec.h"
#include "stock/zmap/zmap.h"

namespace kerf::test {

inline std::unique_ptr<ZMap> make_map(const std::string& blank, double cell, int threads = 1) {
  ZMapOptions options;
  options.blank = *parse_blank(blank);
  options.cell_mm = cell;
  options.threads = threads;
  auto map = ZMap::create(options);
  EXPECT_TRUE(map) << map.error();
  return std::move(*map);
}

/// As moves count it: each cell as high as its middle.
inline double volume_by_cells(const ZMap& map) {
  const Box box = map.bounds_mm();
  double sum_mm = 0;
  for (const float height : map.heights_mm()) sum_mm += static_cast<double>(height) - box.min.z;
  return sum_mm * box.size().x * box.size().y / static_cast<double>(map.cell_count());
}

inline Cutter tool(const char* shape) { return *parse_shape(shape); }

inline CutMove line(const Vec3& from, const Vec3& to) {
  CutMove move;
  move.from_mm = from;
  move.to_mm = to;
  return move;
}

/// A path of short steps, long ones, plunges and level circles within `box`, from its middle.
inline std::vector<CutMove> random_path(std::mt19937& random, const Box& box, int count) {
  std::uniform_real_distribution<double> unit(-1, 1);
  const Vec3 size = box.size();
  const auto inside = [&](Vec3 p) {
    for (int axis = 0; axis < 3; ++axis)
      p[axis] = std::clamp(p[axis], box.min[axis], box.max[axis]);
    return p;
  };
  std::vector<CutMove> moves;
  Vec3 at = box.min + 0.5 * size;
  for (int i = 0; i < count; ++i) {
    const double reach = i % 13 == 0 ? 0.5 : 0.02;
    Vec3 to = at + reach * Vec3{size.x * unit(random), size.y * unit(random), 0};
    if (i % 7 == 3) to.z += 0.3 * size.z * unit(random);
    CutMove move = line(at, inside(to));
    if (i % 17 == 9) {
      move.to_mm = at;
      move.arc = CutArc{at + Vec3(1 + std::abs(unit(random)), 0, 0), Vec3(0, 0, 1), 2 * kPi};
    }
    move.id = static_cast<std::uint64_t>(i);
    at = move.to_mm;
    moves.push_back(move);
  }
  return moves;
}

inline void cut(StockModel& map, const Cutter& cutter, const std::vector<CutMove>& moves) {
  std::vector<CutReport> reports;
  map.cut(cutter, moves, reports);
}

inline void finish(StockModel& map) {
  std::vector<CutReport> reports;
  map.finish(reports);
}

}  // namespace kerf::test
