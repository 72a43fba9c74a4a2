#include "tests/viewer/csg/test_outlines.h"

#include <cmath>

#include "base/geometry.h"

namespace kerf {
namespace {

ProfilePoint point(double radius_mm, double height_mm) {
  return {static_cast<float>(radius_mm), static_cast<float>(height_mm)};
}

}  // namespace

Outline flat_outline(double radius_mm, double length_mm) {
  return {point(0, 0), point(radius_mm, 0), point(radius_mm, length_mm)};
}

Outline bull_outline(double radius_mm, double corner_mm, double length_mm, double step_deg) {
  Outline outline{point(0, 0)};
  const int steps = static_cast<int>(std::lround(90.0 / step_deg));
  for (int i = radius_mm > corner_mm ? 0 : 1; i <= steps; ++i) {
    const double angle = 0.5 * kPi * i / steps;
    outline.push_back(point(radius_mm - corner_mm + corner_mm * std::sin(angle),
                            corner_mm * (1.0 - std::cos(angle))));
  }
  outline.push_back(point(radius_mm, length_mm));
  return outline;
}

Outline vee_outline(double radius_mm, double half_angle_deg, double length_mm) {
  return {point(0, 0), point(radius_mm, radius_mm / std::tan(half_angle_deg * kPi / 180.0)),
          point(radius_mm, length_mm)};
}

Outline lollipop_outline(double radius_mm, double shaft_radius_mm, double length_mm) {
  Outline outline{point(0, 0)};
  const double last = kPi - std::asin(shaft_radius_mm / radius_mm);
  constexpr int kSteps = 60;
  for (int i = 1; i <= kSteps; ++i) {
    const double angle = last * i / kSteps;
    outline.push_back(point(radius_mm * std::sin(angle), radius_mm * (1.0 - std::cos(angle))));
  }
  outline.push_back(point(shaft_radius_mm, length_mm));
  return outline;
}

Outline stepped_outline(double radius_mm, double step_mm, int steps) {
  constexpr double kHeight_mm = 5.0;
  Outline outline{point(0, 0)};
  for (int i = 0; i < steps; ++i) {
    outline.push_back(point(radius_mm + i * step_mm, i * kHeight_mm));
    outline.push_back(point(radius_mm + i * step_mm, (i + 1) * kHeight_mm));
  }
  return outline;
}

}  // namespace kerf
