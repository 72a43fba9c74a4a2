#include "stock/turning/bar_flats.h"

#include <algorithm>

#include "base/portable_math.h"

namespace kerf {

double BarFlats::reach_mm(double angle_rad) const {
  const double step = 2 * kPi / count;
  return inner_radius_mm / portable::cos(angle_rad - step * std::round(angle_rad / step));
}

namespace turning {
namespace {

/// Below this, in mm, a mean over radii is taken from two of them: differences of antiderivatives
/// lose digits, and what is left out of the series is below 1e-9 of the area.
constexpr double kNarrow_mm = 1e-3;

/// Area of a circle of this radius beyond the flats, mm2.
double segment_mm2(double r, const BarFlats& flats) {
  const double a = flats.inner_radius_mm;
  if (r <= a) return 0;
  return flats.count * (r * r * portable::acos(a / r) - a * std::sqrt(r * r - a * a));
}

/// Its antiderivative over the radius.
double segment_sum(double r, const BarFlats& flats) {
  const double a = flats.inner_radius_mm;
  if (r <= a) return 0;
  const double s = std::sqrt(r * r - a * a);
  return flats.count * (r * r * r / 3 * portable::acos(a / r) - 2 * a * r * s / 3 +
                        a * a * a / 3 * std::log((r + s) / a));
}

double mean_segment_mm2(double low, double high, const BarFlats& flats) {
  const double width = high - low;
  if (std::abs(width) > kNarrow_mm)
    return (segment_sum(high, flats) - segment_sum(low, flats)) / width;
  // Gauss, two points.
  const double middle = (low + high) / 2, off = width / (2 * std::sqrt(3.0));
  return (segment_mm2(middle - off, flats) + segment_mm2(middle + off, flats)) / 2;
}

}  // namespace

double missing_mm3(const Contour& contour, const BarFlats& flats) {
  const Unit inner = to_units(flats.inner_radius_mm);
  if (contour.box().max_y <= inner) return 0;
  double sum = 0;
  const auto add = [&](const Point& p, const Point& q) {
    if (p.X == q.X || std::max(p.Y, q.Y) <= inner) return;
    // Counter-clockwise round material: the area under an edge counts where it runs to lower z.
    sum += to_mm(p.X - q.X) * mean_segment_mm2(to_mm(p.Y), to_mm(q.Y), flats);
  };
  const std::vector<RunPointer>& runs = contour.runs();
  for (std::size_t r = 0; r < runs.size(); ++r) {
    const std::vector<Point>& points = runs[r]->points;
    if (runs[r]->box.max_y > inner) {
      for (std::size_t i = 1; i < points.size(); ++i) add(points[i - 1], points[i]);
    }
    add(points.back(), runs[r + 1 == runs.size() ? 0 : r + 1]->points.front());
  }
  return sum;
}

double missing_mm3(std::span<const Contour> contours, const BarFlats& flats) {
  double sum = 0;
  for (const Contour& contour : contours) sum += missing_mm3(contour, flats);
  return sum;
}

}  // namespace turning
}  // namespace kerf
