// tests/viewer/csg/cylinder_blank.h - a round blank.
#pragma once

#include "viewer/csg/csg_blank.h"

namespace kerf {

/// Axis 'X', 'Y' or 'Z', from base_mm by height_mm (> 0). Sides leave the true cylinder by no more
/// than tolerance_mm, inwards.
CsgBlank cylinder_blank(const Vec3& base_mm, char axis, double radius_mm, double height_mm,
                        double tolerance_mm);

}  // namespace kerf
