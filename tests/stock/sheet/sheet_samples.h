// tests/stock/sheet/sheet_samples.h - small sheets and moves, and what brute force says of them.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <vector>

#include "stock/cutter/shape_spec.h"
#include "stock/sheet/sheet.h"

namespace kerf::test {

inline Cutter torch(double kerf_mm) { return *parse_shape("flat:" + std::to_string(kerf_mm)); }

inline std::unique_ptr<Sheet> make_sheet(const PlaneOutline& outline, int tiles_each_way = 0) {
  SheetOptions options;
  options.outline = outline;
  options.top_mm = 2;
  options.tiles_each_way = tiles_each_way;
  Result<std::unique_ptr<Sheet>> sheet = Sheet::create(options);
  EXPECT_TRUE(sheet) << (sheet ? "" : sheet.error());
  return std::move(*sheet);
}

inline CutMove line(const Vec2& from, const Vec2& to, std::uint64_t id = 0) {
  CutMove move;
  move.from_mm = Vec3(from, 1.5);
  move.to_mm = Vec3(to, 1.5);
  move.id = id;
  return move;
}

/// Counter-clockwise by `sweep_rad` about z.
inline CutMove arc(const Vec2& center, double radius, double angle, double sweep_rad,
                   std::uint64_t id = 0) {
  const auto at = [&](double a) { return center + radius * Vec2(std::cos(a), std::sin(a)); };
  CutMove move = line(at(angle), at(angle + sweep_rad), id);
  move.arc = CutArc{Vec3(center, 1.5), {0, 0, 1}, sweep_rad};
  return move;
}

inline std::vector<CutReport> cut(Sheet& sheet, double kerf_mm, const std::vector<CutMove>& moves) {
  std::vector<CutReport> reports;
  sheet.cut(torch(kerf_mm), moves, reports);
  sheet.finish(reports);
  return reports;
}

/// Least distance of p from the tip's way: a line, or an arc of one radius about z.
inline double distance_to_way(const CutMove& move, const Vec2& p) {
  const Vec2 from(move.from_mm), to(move.to_mm);
  const auto distance = [&p](const Vec2& q) { return std::hypot(p.x - q.x, p.y - q.y); };
  if (move.arc) {
    const Vec2 center(move.arc->center_mm), arm = from - center, out = p - center;
    const double sweep = move.arc->sweep_rad;
    double turned = std::atan2(out.y, out.x) - std::atan2(arm.y, arm.x);
    turned = sweep < 0 ? -turned : turned;
    turned -= 2 * kPi * std::floor(turned / (2 * kPi));
    if (turned <= std::abs(sweep)) {
      return std::abs(std::hypot(out.x, out.y) - std::hypot(arm.x, arm.y));
    }
    return std::min(distance(from), distance(to));
  }
  const Vec2 way = to - from, out = p - from;
  const double length2 = way.x * way.x + way.y * way.y;
  const double foot =
      length2 == 0 ? 0 : std::clamp((out.x * way.x + out.y * way.y) / length2, 0.0, 1.0);
  return distance(from + foot * way);
}

inline double area_of(const PlaneOutline& outline) {
  double twice = 0;
  for (const std::vector<Vec2>& ring : outline.rings) {
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Vec2 &a = ring[i], &b = ring[(i + 1) % ring.size()];
      twice += a.x * b.y - a.y * b.x;
    }
  }
  return twice / 2;
}

/// Lines and arcs of all kinds over a sheet of 60 x 40 mm and beyond.
inline std::vector<CutMove> random_moves(std::mt19937& random, int count) {
  std::uniform_real_distribution<double> x(-5, 65), y(-5, 45), radius(0.2, 15), angle(-kPi, kPi);
  std::vector<CutMove> moves;
  for (int i = 0; i < count; ++i) {
    const auto id = static_cast<std::uint64_t>(i);
    // Drawn one by one: the same by every compiler.
    const auto kind = random() % 6;
    const Vec2 from{x(random), y(random)};
    if (kind < 2) {
      moves.push_back(line(from, Vec2{x(random), y(random)}, id));
      continue;
    }
    const double far = radius(random), begin = angle(random);
    if (kind == 2) {
      moves.push_back(arc(from, far, begin, 2 * kPi * (random() % 2 ? 1 : -1), id));
    } else {
      moves.push_back(arc(from, kind == 3 ? far / 15 : far, begin, angle(random) * 1.9, id));
    }
  }
  return moves;
}

}  // namespace kerf::test
