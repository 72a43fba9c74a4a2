#include "viewer/csg/convex_profile.h"

#include <fmt/format.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "base/translate.h"

namespace kerf {
namespace {

/// Outlines come in single precision: nearer points are one point, and the sine of an angle below
/// this one between segments is rounding, not a concave corner.
constexpr double kSamePoint_mm = 1e-6;
constexpr double kStraight_rad = 1e-4;

Done check(std::span<const ProfilePoint> outline) {
  if (outline.size() < 2) {
    return Error{
        trf("the outline of the cutter has {} points; it needs at least two", outline.size())};
  }
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const ProfilePoint& p = outline[i];
    if (!std::isfinite(p.radius_mm) || !std::isfinite(p.height_mm) || p.radius_mm < 0.0f) {
      return Error{
          trf("point {} of the outline of the cutter has radius {} mm and height {} mm; "
              "both must be finite, the radius not negative",
              i + 1, p.radius_mm, p.height_mm)};
    }
    if (i > 0 && p.height_mm < outline[i - 1].height_mm) {
      return Error{trf(
          "the outline of the cutter falls from {} mm to {} mm at point {}; heights must not fall",
          outline[i - 1].height_mm, p.height_mm, i + 1)};
    }
  }
  return std::monostate{};
}

/// The outline without what lies inside the largest radius reached further below.
ConvexProfile seen_from_below(std::span<const ProfilePoint> outline) {
  ConvexProfile line;
  const auto add = [&line](const Vec2& p) {
    if (line.empty() || glm::distance(line.back(), p) > kSamePoint_mm) line.push_back(p);
  };
  Vec2 last(outline[0].radius_mm, outline[0].height_mm);
  add(last);
  for (const ProfilePoint& point : outline.subspan(1)) {
    const Vec2 p(point.radius_mm, point.height_mm);
    const double reached = line.back().x;
    if (p.x > reached) {
      if (last.x <= reached) {  // comes out from an undercut, or is the upper end of a step
        add(glm::mix(last, p, (reached - last.x) / (p.x - last.x)));
      }
      // A level start is part of the flat bottom.
      if (line.size() == 1 && p.y - line[0].y < kSamePoint_mm) line.clear();
      add(p);
    }
    last = p;
  }
  return line;
}

bool is_concave(const Vec2& a, const Vec2& b, const Vec2& c) {
  const Vec2 in = glm::normalize(b - a);
  const Vec2 out = glm::normalize(c - b);
  return in.x * out.y - in.y * out.x < -kStraight_rad;
}

}  // namespace

Result<std::vector<ConvexProfile>> convex_pieces(std::span<const ProfilePoint> outline) {
  if (Done done = check(outline); !done) return Error{done.error()};
  const ConvexProfile line = seen_from_below(outline);
  std::vector<ConvexProfile> pieces;
  ConvexProfile piece;
  const auto finish = [&pieces, &piece] {
    // The wall of the solid begins there anyway.
    while (piece.size() >= 2 && piece.back().x - piece[piece.size() - 2].x < kSamePoint_mm) {
      piece.pop_back();
    }
    if (!piece.empty() && piece.back().x > kSamePoint_mm) pieces.push_back(std::move(piece));
    piece.clear();
  };
  for (std::size_t i = 0; i < line.size(); ++i) {
    const bool is_level = piece.size() == 1 && line[i].y - piece[0].y < kSamePoint_mm;
    if (is_level) piece.clear();
    piece.push_back(line[i]);
    const bool has_corner = piece.size() >= 2 && i + 1 < line.size();
    if (has_corner && is_concave(line[i - 1], line[i], line[i + 1])) {
      finish();
      piece.push_back(line[i]);  // flat at this height as far as its radius
    }
  }
  finish();
  return pieces;
}

ConvexProfile below(const ConvexProfile& piece, double height_mm) {
  ConvexProfile kept;
  for (const Vec2& p : piece) {
    if (p.y < height_mm) {
      kept.push_back(p);
      continue;
    }
    if (!kept.empty() && p.y > kept.back().y) {
      kept.push_back(glm::mix(kept.back(), p, (height_mm - kept.back().y) / (p.y - kept.back().y)));
    }
    break;
  }
  if (!kept.empty() && kept.back().x <= kSamePoint_mm) kept.clear();
  return kept;
}

ConvexProfile simplified(const ConvexProfile& piece, double tolerance_mm) {
  const auto is_chord = [&](std::size_t from, std::size_t to) {
    const Vec2 along = glm::normalize(piece[to] - piece[from]);
    for (std::size_t i = from + 1; i < to; ++i) {
      const Vec2 p = piece[i] - piece[from];
      if (std::abs(along.x * p.y - along.y * p.x) > tolerance_mm) return false;
    }
    return true;
  };
  ConvexProfile kept{piece.front()};
  for (std::size_t from = 0; from + 1 < piece.size();) {
    std::size_t to = from + 1;
    while (to + 1 < piece.size() && is_chord(from, to + 1)) ++to;
    kept.push_back(piece[to]);
    from = to;
  }
  return kept;
}

}  // namespace kerf
