#include "tests/viewer/csg/cylinder_blank.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace kerf {
namespace {

constexpr double kMinSides = 12.0;
constexpr double kMaxSides = 720.0;

}  // namespace

CsgBlank cylinder_blank(const Vec3& base_mm, char axis, double radius_mm, double height_mm,
                        double tolerance_mm) {
  const int along = axis == 'X' ? 0 : axis == 'Y' ? 1 : 2;
  const double half_rad = std::acos(1.0 - std::min(1.0, tolerance_mm / radius_mm));
  const auto sides =
      static_cast<std::uint32_t>(std::clamp(std::ceil(kPi / half_rad), kMinSides, kMaxSides));
  CsgBlank blank;
  for (std::uint32_t i = 0; i < sides; ++i) {
    const double angle = 2.0 * kPi * i / sides;
    Vec3 p = base_mm;
    p[(along + 1) % 3] += radius_mm * std::cos(angle);
    p[(along + 2) % 3] += radius_mm * std::sin(angle);
    blank.mesh.positions_mm.emplace_back(p);
    p[along] += height_mm;
    blank.mesh.positions_mm.emplace_back(p);
    const std::uint32_t a = 2 * i, b = 2 * ((i + 1) % sides);
    blank.mesh.triangles.insert(blank.mesh.triangles.end(), {{a, b, b + 1}, {a, b + 1, a + 1}});
    if (i >= 2) {
      blank.mesh.triangles.insert(blank.mesh.triangles.end(), {{0, a, a - 2}, {1, a - 1, a + 1}});
    }
  }
  return blank;
}

}  // namespace kerf
