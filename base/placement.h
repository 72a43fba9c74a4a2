// base/placement.h - how a thing lies elsewhere: turned about the origin, then shifted.
#pragma once

#include <array>
#include <glm/mat3x3.hpp>
#include <optional>

#include "base/geometry.h"

namespace kerf {

/// A turn that lays axes on axes: axis a of what is turned is axis from[a] of what was, times
/// sign[a] (1 or -1).
struct AxisTurn {
  std::array<int, 3> from{0, 1, 2};
  std::array<int, 3> sign{1, 1, 1};
  bool operator==(const AxisTurn&) const = default;
  /// Z stays along Z, up or down.
  bool keeps_z() const { return from[2] == 2; }
};

/// A rigid motion: p becomes turn * p + at_mm.
struct Placement {
  glm::dmat3 turn{1.0};
  Vec3 at_mm{0};

  /// About X, then Y, then Z, all of them fixed, by the right-hand rule. Quarter turns are exact.
  static Placement turned(const Vec3& xyz_deg);
  /// Half a turn about X or Y (`axis` 'x' or 'y').
  static Placement flipped(char axis);
  /// Lays three points on three others: the first on the first, the second on the line to the
  /// second, the third into the plane of all. Nothing if three of them lie on a line.
  static std::optional<Placement> by_points(const std::array<Vec3, 3>& was,
                                            const std::array<Vec3, 3>& is);

  Vec3 placed(const Vec3& p) const { return turn * p + at_mm; }
  Vec3 before(const Vec3& p) const;  ///< where a placed point was
  Box placed(const Box& box) const;  ///< of its corners
  /// This, then `next`.
  Placement then(const Placement& next) const;
  /// The same turn, about this point.
  Placement about(const Vec3& center_mm) const;
  bool is_as_is() const { return turn == glm::dmat3(1.0) && at_mm == Vec3(0); }
  /// Where the turn is one, to 1e-9.
  std::optional<AxisTurn> by_axes() const;
};

}  // namespace kerf
