#include "stock/plane/outline_curves.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "base/portable_math.h"

namespace kerf::plane {
namespace {

constexpr double kMostChords = 100'000;
/// Of half a chord's angle: eight chords a turn at least.
constexpr double kLeastCosine = 0.924;

int chords_for(double wanted) {
  return static_cast<int>(std::clamp(std::ceil(wanted), 1.0, kMostChords));
}

}  // namespace

void append_arc(const Vec2& center, double radius_mm, double from_rad, double sweep_rad,
                double tolerance_mm, std::vector<Vec2>& points, double ratio, double turned_rad) {
  const double step =
      2 * portable::acos(std::max(1 - tolerance_mm / std::abs(radius_mm), kLeastCosine));
  const int chords = chords_for(std::abs(sweep_rad) / std::max(step, 1e-9));
  const double chord_rad = std::abs(sweep_rad) / chords;
  const double corner_mm = radius_mm * std::sqrt(chord_rad / portable::sin(chord_rad));
  const bool is_full = std::abs(sweep_rad) > 2 * kPi * (1 - 1e-12);
  const double cosine = portable::cos(turned_rad), sine = portable::sin(turned_rad);
  for (int i = 1; i <= chords; ++i) {
    const double angle = from_rad + sweep_rad * i / chords;
    const double r = i < chords || is_full ? corner_mm : radius_mm;
    const double x = r * portable::cos(angle), y = ratio * r * portable::sin(angle);
    points.push_back(center + Vec2(cosine * x - sine * y, sine * x + cosine * y));
  }
}

void append_bulge(const Vec2& to, double bulge, double tolerance_mm, std::vector<Vec2>& points) {
  const Vec2 from = points.back(), way = to - from;
  if (bulge != 0 && glm::length(way) > 0) {
    // The centre lies beside the chord's middle, by (1 - bulge^2) / (4 bulge) of its length.
    const Vec2 left(-way.y, way.x);
    const Vec2 center = (from + to) / 2.0 + left * ((1 - bulge * bulge) / (4 * bulge));
    const Vec2 arm = from - center;
    append_arc(center, glm::length(arm), portable::atan2(arm.y, arm.x), 4 * portable::atan(bulge),
               tolerance_mm, points);
    points.pop_back();
  }
  points.push_back(to);
}

void append_bezier(const Vec2& control1, const Vec2& control2, const Vec2& to, double tolerance_mm,
                   std::vector<Vec2>& points) {
  const Vec2 from = points.back();
  // Chords of n equal parts are off by at most the second derivative's maximum / (8 n^2).
  const double bend = 6 * std::max(glm::length(from - 2.0 * control1 + control2),
                                   glm::length(control1 - 2.0 * control2 + to));
  const int chords = chords_for(std::sqrt(bend / (8 * tolerance_mm)));
  for (int i = 1; i <= chords; ++i) {
    const double t = static_cast<double>(i) / chords, u = 1 - t;
    points.push_back(u * u * u * from + 3 * u * u * t * control1 + 3 * u * t * t * control2 +
                     t * t * t * to);
  }
}

}  // namespace kerf::plane
