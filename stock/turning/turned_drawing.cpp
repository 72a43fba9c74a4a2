#include "stock/turning/turned_drawing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "base/portable_math.h"
#include "stock/plane/outline_drawing.h"
#include "stock/turning/contour_arcs.h"

namespace kerf {
namespace {

/// How far the centre line sticks out at either end, mm.
constexpr double kOverhang_mm = 5;
/// What is no farther beyond the flats is rounding.
constexpr double kLevel_mm = 1e-3;

/// Arcs of more than half a turn are two.
plane::Curve drawn_curve(const turning::CurvedContour& contour) {
  plane::Curve curve;
  if (contour.size() == 1 && contour[0].arc) {
    curve.circle = plane::CurveCircle{contour[0].arc->center_mm, contour[0].arc->radius_mm};
    return curve;
  }
  for (const turning::ContourPiece& piece : contour) {
    if (!piece.arc) {
      curve.corners.push_back({piece.from_mm, 0});
      continue;
    }
    const turning::PieceArc& arc = *piece.arc;
    const bool halves = std::abs(arc.sweep_rad) > kPi;
    const double bulge = portable::tan(arc.sweep_rad / (halves ? 8 : 4));
    curve.corners.push_back({piece.from_mm, bulge});
    if (!halves) continue;
    const Vec2 arm = piece.from_mm - arc.center_mm;
    const double angle = portable::atan2(arm.y, arm.x) + arc.sweep_rad / 2;
    curve.corners.push_back(
        {arc.center_mm + arc.radius_mm * Vec2(portable::cos(angle), portable::sin(angle)), bulge});
  }
  return curve;
}

struct TurnedDrawing {
  std::vector<plane::Curve> curves;
  plane::DrawingStyle style;
};

/// Along z where something of the contours is beyond the radius, rising.
std::vector<std::pair<double, double>> stretches_beyond(const TurnedPart& part, double r_mm) {
  std::vector<std::pair<double, double>> found;
  for (const std::vector<Vec2>& ring : part.profile()) {
    for (std::size_t i = 0; i < ring.size(); ++i) {
      Vec2 a = ring[i], b = ring[(i + 1) % ring.size()];
      if (a.x > b.x) std::swap(a, b);
      if (std::max(a.y, b.y) <= r_mm + kLevel_mm || a.x == b.x) continue;
      const double at = a.x + (r_mm - a.y) / (b.y - a.y) * (b.x - a.x);
      if (a.y < r_mm) a.x = at;
      if (b.y < r_mm) b.x = at;
      found.emplace_back(a.x, b.x);
    }
  }
  std::sort(found.begin(), found.end());
  std::vector<std::pair<double, double>> joined;
  for (const auto& next : found) {
    if (!joined.empty() && next.first <= joined.back().second + kLevel_mm) {
      joined.back().second = std::max(joined.back().second, next.second);
    } else {
      joined.push_back(next);
    }
  }
  return joined;
}

void draw_flats(const TurnedPart& part, plane::DrawingStyle& style) {
  if (!part.flats()) return;
  const double r_mm = part.flats()->inner_radius_mm;
  for (const auto& [low, high] : stretches_beyond(part, r_mm))
    style.flats.emplace_back(Vec2(low, r_mm), Vec2(high, r_mm));
  style.flats_note = fmt::format("{} {:.6g}", part.flats()->count == 4 ? "SQ" : "HEX", 2 * r_mm);
}

TurnedDrawing drawing_of(const TurnedPart& part) {
  TurnedDrawing drawing;
  turning::Rect box;
  for (const turning::Contour& contour : part.contours()) {
    box.extend(contour.box());
    drawing.curves.push_back(drawn_curve(turning::with_arcs(contour)));
  }
  if (box.empty()) box = {0, 0, 0, 0};
  const double low = turning::to_mm(box.min_x), high = turning::to_mm(box.max_x);
  plane::DrawingStyle& style = drawing.style;
  style.digits = 5;
  style.layer = "CONTOUR";
  style.centre_line = {Vec2(low - kOverhang_mm, 0), Vec2(high + kOverhang_mm, 0)};
  style.low_mm = {low - kOverhang_mm, 0};
  style.high_mm = {high + kOverhang_mm, turning::to_mm(box.max_y)};
  style.keeps_x = true;
  draw_flats(part, style);
  return drawing;
}

}  // namespace

Done write_turned_dxf(const TurnedPart& part, const std::string& path) {
  const TurnedDrawing drawing = drawing_of(part);
  return plane::write_curves_dxf(drawing.curves, drawing.style, path);
}

Done write_turned_svg(const TurnedPart& part, const std::string& path) {
  const TurnedDrawing drawing = drawing_of(part);
  return plane::write_curves_svg(drawing.curves, drawing.style, path);
}

}  // namespace kerf
