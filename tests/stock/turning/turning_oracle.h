// tests/stock/turning/turning_oracle.h - what a tool sweeps, by looking at it at many places.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <random>
#include <vector>

#include "tests/stock/turning/turning_samples.h"

namespace kerf::turning_test {

inline double cross(const Vec2& a, const Vec2& b) { return a.x * b.y - a.y * b.x; }

inline double distance_to_edge(const Vec2& from, const InsertEdge& edge, const Vec2& p) {
  if (edge.center_mm) {
    const Vec2 a = from - *edge.center_mm, b = edge.end_mm - *edge.center_mm,
               d = p - *edge.center_mm;
    const auto angle = [&](const Vec2& v) {
      const double turn = std::atan2(cross(a, v), glm::dot(a, v));
      return turn < 0 ? turn + 2 * kPi : turn;
    };
    const double sweep = angle(b) > 0 ? angle(b) : 2 * kPi;
    if (angle(d) <= sweep) return std::abs(glm::length(d) - glm::length(a));
    return std::min(glm::distance(p, from), glm::distance(p, edge.end_mm));
  }
  const Vec2 way = edge.end_mm - from;
  const double share = std::clamp(glm::dot(p - from, way) / glm::dot(way, way), 0.0, 1.0);
  return glm::distance(p, from + share * way);
}

/// Negative inside. `p` relative to the controlled point.
inline double distance_to_part(const InsertPart& part, const Vec2& p) {
  bool inside = true;
  double least = std::numeric_limits<double>::infinity();
  Vec2 from = part.back().end_mm;
  for (const InsertEdge& edge : part) {
    least = std::min(least, distance_to_edge(from, edge, p));
    const bool left = cross(edge.end_mm - from, p - from) >= 0;
    const bool bulge =
        edge.center_mm && glm::distance(p, *edge.center_mm) <= glm::distance(from, *edge.center_mm);
    inside = inside && (left || bulge);
    from = edge.end_mm;
  }
  return inside ? -least : least;
}

inline double distance_to_tool(const InsertOutline& tool, const Vec2& p) {
  double least = std::numeric_limits<double>::infinity();
  for (const InsertPart& part : tool.parts) least = std::min(least, distance_to_part(part, p));
  return least;
}

inline Vec2 place_at(const TurnMove& move, double t) {
  if (!move.arc) return move.from_mm + t * (move.to_mm - move.from_mm);
  const Vec2 from = move.from_mm - move.arc->center_mm, to = move.to_mm - move.arc->center_mm;
  const double r = glm::length(from) + t * (glm::length(to) - glm::length(from));
  const double angle = std::atan2(from.y, from.x) + t * move.arc->sweep_rad;
  return move.arc->center_mm + r * Vec2(std::cos(angle), std::sin(angle));
}

inline double length_of(const TurnMove& move) {
  if (!move.arc) return glm::distance(move.from_mm, move.to_mm);
  const double r = std::max(glm::distance(move.from_mm, move.arc->center_mm),
                            glm::distance(move.to_mm, move.arc->center_mm));
  return r * std::abs(move.arc->sweep_rad);
}

/// The least distance of the tool's outline from (z, r), above the axis or below, on the way: as
/// good as the last steps are small, which is `step_mm` near the outline. Stops where it is below
/// -step_mm. `t` is where.
inline double least_distance(const InsertOutline& tool, const TurnMove& move, const Vec2& p,
                             double step_mm, double& t) {
  const double length = length_of(move);
  double least = std::numeric_limits<double>::infinity();
  for (double at = 0;;) {
    const Vec2 place = place_at(move, at);
    const double distance = std::min(distance_to_tool(tool, p - place),
                                     distance_to_tool(tool, Vec2(p.x, -p.y) - place));
    if (distance < least) {
      least = distance;
      t = at;
    }
    if (least < -step_mm || at >= 1) return least;
    // The tool comes no nearer than it moves.
    at = std::min(1.0, at + std::max(std::abs(distance), step_mm) / length);
  }
}

inline bool is_within(const TurnedProfile& profile, const Vec2& p) {
  bool inside = false;
  for (const std::vector<Vec2>& ring : profile) {
    for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) {
      const Vec2 &a = ring[i], &b = ring[j];
      if ((a.y > p.y) == (b.y > p.y)) continue;
      if (p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x)) inside = !inside;
    }
  }
  return inside;
}

inline InsertOutline random_tool(std::mt19937& random) {
  const auto pick = [&](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
  std::uniform_real_distribution<double> unit(0, 1);
  const double r = 0.2 * pick(5);
  switch (pick(6)) {
    case 0: {
      const double front = 2 * kPi * unit(random);
      return *nose_insert({r, 1 + pick(8), front, front + radians(20 + 120 * unit(random)), 9});
    }
    case 1: {
      constexpr char kLetters[] = "CDEKMPRSTVW";
      return *iso_insert(
          {kLetters[pick(11)], 9.525, 0.4, 1 + pick(8), radians(15 * pick(24)), pick(2) == 0});
    }
    case 2: {
      const int orientation = 1 + pick(4);
      return *groove_insert(
          {2 + pick(3) * 0.5, 0.2 * pick(3), 12, orientation, pick(2) == 0, radians(pick(3))});
    }
    case 3:
      return *thread_insert({radians(pick(2) == 0 ? 60 : 55), 0.1 * pick(3), 1.5, 6});
    case 4:
      return round_insert(0.5 + 2 * unit(random));
    default:
      return right_hand(r);
  }
}

/// A way of `count` moves about a bar of 40 mm diameter and 30 mm length whose face is at z = 0.
/// Half of them on whole millimetres, so that edges come to lie on edges.
inline std::vector<TurnMove> random_moves(std::mt19937& random, int count) {
  std::uniform_real_distribution<double> z(-32, 4), x(-4, 24), unit(0, 1);
  std::vector<TurnMove> moves;
  Vec2 at(2, 24);
  for (int i = 0; i < count; ++i) {
    Vec2 to{z(random), x(random)};  // braces: in this order by every compiler
    const unsigned kind = random() % 8;
    if (kind < 4) to = glm::round(to);
    if (kind == 1) to.x = at.x;
    if (kind == 2) to.y = at.y;
    const auto id = static_cast<std::uint64_t>(i);
    if (kind >= 6) {
      const Vec2 center = at + Vec2{6 * unit(random) - 3, 6 * unit(random) - 3};
      moves.push_back(arc(at, center, unit(random) - 0.5, id));
    } else {
      moves.push_back(line(at, to, id));
    }
    at = moves.back().to_mm;
  }
  return moves;
}

}  // namespace kerf::turning_test
