// tests/viewer/csg/test_outlines.h - outlines of common cutters. mm, degrees.
#pragma once

#include <vector>

#include "viewer/scene.h"

namespace kerf {

using Outline = std::vector<ProfilePoint>;

Outline flat_outline(double radius_mm, double length_mm);
/// Rounded by corner_mm; a ball where both are equal. Arcs in steps of `step_deg`.
Outline bull_outline(double radius_mm, double corner_mm, double length_mm, double step_deg = 3.0);
Outline vee_outline(double radius_mm, double half_angle_deg, double length_mm);
/// A ball on a thinner shaft.
Outline lollipop_outline(double radius_mm, double shaft_radius_mm, double length_mm);
/// Each step 5 mm high and step_mm wider than the one below.
Outline stepped_outline(double radius_mm, double step_mm, int steps);

}  // namespace kerf
