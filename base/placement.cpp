#include "base/placement.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "base/portable_math.h"

namespace kerf {
namespace {

/// A turn is one by axes if its numbers are -1, 0 or 1 to so much: over a metre less than a
/// thousandth of a micrometre.
constexpr double kSquare = 1e-9;
/// Of a triangle's height: below it, its points are one line.
constexpr double kThinnest_mm = 1e-3;

/// Columns: along the first side, across it, upright on both.
std::optional<glm::dmat3> frame_of(const std::array<Vec3, 3>& points) {
  const Vec3 along = points[1] - points[0], other = points[2] - points[0];
  const Vec3 up = glm::cross(along, other);
  const double length_mm = glm::length(along);
  if (length_mm < kThinnest_mm || glm::length(up) < kThinnest_mm * length_mm) return std::nullopt;
  const Vec3 x = along / length_mm, z = glm::normalize(up);
  return glm::dmat3(x, glm::cross(z, x), z);
}

}  // namespace

Placement Placement::turned(const Vec3& xyz_deg) {
  Placement out;
  for (int axis = 0; axis < 3; ++axis) {
    if (xyz_deg[axis] == 0) continue;
    const double quarters = xyz_deg[axis] / 90;
    auto [s, c] = portable::sin_cos(xyz_deg[axis] * kPi / 180);
    if (quarters == std::round(quarters)) {
      c = std::round(c);
      s = std::round(s);
    }
    const int first = (axis + 1) % 3, second = (axis + 2) % 3;
    glm::dmat3 one(1.0);  // by columns
    one[first][first] = c;
    one[first][second] = s;
    one[second][first] = -s;
    one[second][second] = c;
    out.turn = one * out.turn;
  }
  return out;
}

Placement Placement::flipped(char axis) {
  return turned(axis == 'y' ? Vec3(0, 180, 0) : Vec3(180, 0, 0));
}

std::optional<Placement> Placement::by_points(const std::array<Vec3, 3>& was,
                                              const std::array<Vec3, 3>& is) {
  const std::optional<glm::dmat3> from = frame_of(was), to = frame_of(is);
  if (!from || !to) return std::nullopt;
  Placement out;
  out.turn = *to * glm::transpose(*from);
  out.at_mm = is[0] - out.turn * was[0];
  return out;
}

Vec3 Placement::before(const Vec3& p) const { return glm::transpose(turn) * (p - at_mm); }

Box Placement::placed(const Box& box) const {
  Box out;
  if (box.empty()) return out;
  for (unsigned corner = 0; corner < 8; ++corner) {
    Vec3 p;
    for (int axis = 0; axis < 3; ++axis)
      p[axis] = (corner >> axis & 1u) != 0 ? box.max[axis] : box.min[axis];
    out.extend(placed(p));
  }
  return out;
}

Placement Placement::then(const Placement& next) const {
  return {next.turn * turn, next.turn * at_mm + next.at_mm};
}

Placement Placement::about(const Vec3& center_mm) const {
  return {turn, center_mm - turn * center_mm + at_mm};
}

std::optional<AxisTurn> Placement::by_axes() const {
  AxisTurn out;
  for (int row = 0; row < 3; ++row) {
    int found = -1;
    for (int column = 0; column < 3; ++column) {
      const double value = turn[column][row];
      if (std::abs(std::abs(value) - 1) < kSquare) {
        found = column;
        out.sign[static_cast<std::size_t>(row)] = value > 0 ? 1 : -1;
      } else if (std::abs(value) > kSquare) {
        return std::nullopt;
      }
    }
    if (found < 0) return std::nullopt;
    out.from[static_cast<std::size_t>(row)] = found;
  }
  return out;
}

}  // namespace kerf
