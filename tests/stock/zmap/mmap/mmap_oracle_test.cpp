// Columns of the M-map against brute force, for every cutter with a head and kind of move.
#include <gtest/gtest.h>

#include <random>

#include "tests/stock/sweep_oracle.h"
#include "tests/stock/zmap/mmap/mmap_samples.h"

namespace kerf {
namespace {

using test::double_cone;
using test::helix;
using test::line;
using test::make_mmap;
using test::shape;

/// Points this close to the edge of a sweep are left out, mm: there the sides of a ball are so
/// steep that the step of the samples shows.
constexpr double kAmbiguous_mm = 0.1;

struct Interval {
  double low, high;
};

/// What the tool covers over a point while it goes along a path, by dense samples of it: sorted,
/// joined.
std::vector<Interval> swept(const Cutter& tool, const std::vector<CutMove>& moves, double x,
                            double y, int samples, bool& near_edge) {
  std::vector<Interval> all;
  for (const CutMove& move : moves) {
    double nearest = 1e9;
    bool was_over = false;
    Interval last{0, 0};
    for (int n = 0; n <= samples; ++n) {
      const Vec3 tip = test::tip_at(move, static_cast<double>(n) / samples);
      const double d = std::hypot(x - tip.x, y - tip.y);
      nearest = std::min(nearest, d);
      if (d <= *tool.neck_radius_mm()) all.push_back({tip.z + tool.height_mm(d), 1e9});
      if (d > tool.radius_mm()) {
        was_over = false;
        continue;
      }
      const Interval head{tip.z + tool.height_mm(d), tip.z + tool.upper_height_mm(d)};
      all.push_back(head);
      // Between two samples the interval goes on from the one to the other.
      if (was_over) all.push_back({std::min(head.low, last.low), std::max(head.high, last.high)});
      was_over = true;
      last = head;
    }
    for (const double wall : {tool.radius_mm(), *tool.neck_radius_mm()})
      near_edge |= std::abs(nearest - wall) < kAmbiguous_mm;
  }
  std::sort(all.begin(), all.end(), [](auto& a, auto& b) { return a.low < b.low; });
  std::vector<Interval> out;
  for (const Interval& next : all) {
    if (out.empty() || next.low > out.back().high + 1e-4)
      out.push_back(next);
    else
      out.back().high = std::max(out.back().high, next.high);
  }
  return out;
}

/// Solid parts of a column, from the bottom up, those thinner than `least` left out.
std::vector<Interval> solid_of(const MMap& map, int i, int j, double least) {
  std::vector<Gap> gaps = map.gaps(i, j);
  std::vector<Interval> out;
  double bottom = map.bounds_mm().min.z;
  for (auto gap = gaps.rbegin(); gap != gaps.rend(); ++gap) {
    out.push_back({bottom, static_cast<double>(gap->low)});
    bottom = static_cast<double>(gap->high);
  }
  out.push_back({bottom, static_cast<double>(map.height_mm(i, j))});
  std::erase_if(out, [&](const Interval& s) { return s.high - s.low < least; });
  return out;
}

std::vector<Interval> solid_of(const Box& box, const std::vector<Interval>& holes, double least) {
  std::vector<Interval> out;
  double bottom = box.min.z;
  for (const Interval& hole : holes) {
    if (hole.low > bottom) out.push_back({bottom, std::min(hole.low, box.max.z)});
    bottom = std::max(bottom, hole.high);
  }
  if (bottom < box.max.z) out.push_back({bottom, box.max.z});
  std::erase_if(out, [&](const Interval& s) { return s.high - s.low < least; });
  return out;
}

double total(const std::vector<Interval>& parts) {
  double sum = 0;
  for (const Interval& part : parts) sum += part.high - part.low;
  return sum;
}

/// Length of what only one of the two has.
double difference(const std::vector<Interval>& a, const std::vector<Interval>& b) {
  double both = 0;
  for (const Interval& x : a)
    for (const Interval& y : b)
      both += std::max(0.0, std::min(x.high, y.high) - std::max(x.low, y.low));
  return total(a) + total(b) - 2 * both;
}

struct Seen {
  int cells = 0, with_gaps = 0, with_several = 0;
};

Seen compare(const MMap& map, const Cutter& tool, const std::vector<CutMove>& moves, int stride,
             int samples) {
  Seen seen;
  // An end of an interval may be that of a sample, one step away from the true one.
  double tolerance = moves[0].arc ? 3e-3 : 1e-3;  // chords
  for (const CutMove& m : moves) {
    const double rise = std::abs(m.to_mm.z - m.from_mm.z);
    tolerance = std::max(tolerance, 1e-3 + 2 * rise / samples);
  }
  const Box box = map.bounds_mm();
  for (int j = stride / 2; j < map.ny(); j += stride) {
    for (int i = stride / 2; i < map.nx(); i += stride) {
      const double x = box.min.x + (i + 0.5) * box.size().x / map.nx();
      const double y = box.min.y + (j + 0.5) * box.size().y / map.ny();
      bool near_edge = false;
      const std::vector<Interval> holes = swept(tool, moves, x, y, samples, near_edge);
      if (near_edge) continue;
      const std::vector<Interval> expected = solid_of(box, holes, 0);
      const std::vector<Interval> found = solid_of(map, i, j, 0);
      ++seen.cells;
      seen.with_gaps += !map.gaps(i, j).empty();
      seen.with_several += map.gaps(i, j).size() > 1;
      const double ends = 2 * static_cast<double>(std::max(expected.size(), found.size()));
      if (difference(expected, found) <= ends * tolerance) continue;
      ADD_FAILURE() << "cell " << i << "," << j << " at " << x << "," << y << ": solid "
                    << total(found) << " in " << found.size() << ", oracle " << total(expected)
                    << " in " << expected.size();
      return seen;
    }
  }
  return seen;
}

std::vector<Cutter> tools() {
  return {shape("tslot:6:1.5:2.5"), shape("lollipop:5:2"), shape("dovetail:6:55:2"), double_cone()};
}

TEST(MMapOracle, StraightMoves) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> xy(-1, 13), z(-10, 1), unit(0, 1);
  for (const Cutter& tool : tools()) {
    Seen seen;
    for (int round = 0; round < 12; ++round) {
      Vec3 from{xy(random), xy(random), z(random)}, to(xy(random), xy(random), z(random));
      if (round % 6 == 0) to.z = from.z;
      if (round % 6 == 1) to.x = from.x, to.y = from.y;
      if (round % 6 == 2) to = from + Vec3(0.01 * unit(random), 0.02, to.z - from.z);
      SCOPED_TRACE(testing::Message()
                   << tool.spec() << " round " << round << " from " << from.x << "," << from.y
                   << "," << from.z << " to " << to.x << "," << to.y << "," << to.z);
      const auto map = make_mmap("box:0,0,-12:12,12,0", 0.25);
      const std::vector<CutMove> moves{line(from, to)};
      test::removed_mm3(*map, tool, moves);
      const Seen now = compare(*map, tool, moves, 2, 1000);
      seen.with_gaps += now.with_gaps;
      if (HasFailure()) return;
    }
    EXPECT_GT(seen.with_gaps, 100) << tool.spec();
  }
}

TEST(MMapOracle, LevelArcsAndHelices) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(0, 1);
  for (const Cutter& tool : tools()) {
    Seen seen;
    for (int round = 0; round < 8; ++round) {
      const double radius = round % 2 == 0 ? 0.5 + unit(random) : 3.1 + 2 * unit(random);
      double sweep = (unit(random) < 0.5 ? 1 : -1) * 2 * kPi * unit(random);
      if (round % 4 == 1) sweep *= 2.5;
      const double dz = round % 4 == 0 ? 0 : (unit(random) - 0.7) * 9;
      const CutMove move = helix(Vec3{5 + 2 * unit(random), 6, -4 - 3 * unit(random)}, radius,
                                 6 * unit(random), sweep, dz);
      SCOPED_TRACE(testing::Message() << tool.spec() << " round " << round << " radius " << radius
                                      << " sweep " << sweep << " dz " << dz);
      const auto map = make_mmap("box:0,0,-12:12,12,0", 0.25);
      test::removed_mm3(*map, tool, {move});
      const Seen now = compare(*map, tool, {move}, 4, 2000);
      seen.with_gaps += now.with_gaps;
      seen.with_several += now.with_several;
      if (HasFailure()) return;
    }
    EXPECT_GT(seen.with_gaps, 100) << tool.spec();
  }
}

TEST(MMapOracle, PathsThatCrossThemselves) {
  std::mt19937 random(8);
  for (const Cutter& tool : tools()) {
    SCOPED_TRACE(tool.spec());
    std::vector<CutMove> moves = test::random_path(random, {Vec3(0, 0, -11), Vec3(12, 12, -1)}, 16);
    const auto map = make_mmap("box:0,0,-12:12,12,0", 0.25);
    test::removed_mm3(*map, tool, moves);
    const Seen seen = compare(*map, tool, moves, 3, 600);
    EXPECT_GT(seen.with_gaps, 10);
    if (HasFailure()) return;
  }
}

}  // namespace
}  // namespace kerf
